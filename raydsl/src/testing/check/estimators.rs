//! The check that estimators have one mean.

use core::fmt;

use glam::{DVec3, Vec3, vec3};

use super::light::seen_of;
use super::statistics::{normal_quantile, sidak};
use crate::bsdf::Bsdf;
use crate::light::{Light, LightSample};
use crate::sampling::{Rng, power_heuristic, sample_uniform_sphere};
use crate::shading::Scene;

/// Checks a BSDF under a light as [`EstimatorsTest::new`] does. `scene` has the surfaces of the light
/// and nothing else: an empty slice for a light without surfaces.
///
/// # Errors
///
/// If the means differ.
pub fn estimators<B: Bsdf, L: Light, S: Scene + ?Sized>(
    bsdf: B,
    light: L,
    scene: &S,
) -> Result<EstimatorsReport, EstimatorsFailure> {
    EstimatorsTest::new().run(bsdf, light, scene)
}

/// A check whether light samples, samples of the BSDF, and both of them weighted by the power
/// heuristic estimate the same light. The surface is at the origin, with its normal along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimatorsTest {
    /// Samples of each estimator: 1,000,000 unless set.
    pub samples: u32,
    /// Directions of the viewer: 3 unless set.
    pub directions: u32,
    /// Probability of a false alarm: 0.001 unless set.
    pub false_alarm: f64,
    /// Seed of the random numbers.
    pub seed: u32,
}

impl Default for EstimatorsTest {
    fn default() -> Self {
        Self::new()
    }
}

/// A mean and its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Mean: red, green, blue.
    pub mean: DVec3,
    /// Standard error.
    pub error: DVec3,
}

#[derive(Clone, Copy, Default)]
struct Sums {
    sum: DVec3,
    squares: DVec3,
}

impl Sums {
    fn add(&mut self, v: Vec3) {
        let v = v.as_dvec3();
        (self.sum, self.squares) = (self.sum + v, self.squares + v * v);
    }

    fn estimate(&self, n: f64) -> Estimate {
        let mean = self.sum / n;
        let error = ((self.squares / n - mean * mean).max(DVec3::ZERO) / n).map(f64::sqrt);
        Estimate { mean, error }
    }
}

/// What the estimators found for one direction of the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimatorsRow {
    /// Direction of the viewer.
    pub wo: Vec3,
    /// By light samples alone.
    pub by_light: Estimate,
    /// By samples of the BSDF alone.
    pub by_bsdf: Estimate,
    /// By both, weighted.
    pub by_both: Estimate,
}

/// What was found for each direction of the viewer; printed, it is a table.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimatorsReport {
    /// The directions.
    pub rows: Vec<EstimatorsRow>,
}

/// Means that differ.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimatorsFailure {
    /// What was found.
    pub report: EstimatorsReport,
}

impl EstimatorsTest {
    /// Creates the check with its defaults.
    pub const fn new() -> Self {
        Self { samples: 1_000_000, directions: 3, false_alarm: 1e-3, seed: 0 }
    }

    /// Compares the means.
    ///
    /// # Errors
    ///
    /// If they differ by more than their errors explain, or are not finite. A light or a lobe that is a
    /// delta is not met by samples of the other, whose mean is not compared then.
    pub fn run<B: Bsdf, L: Light, S: Scene + ?Sized>(
        &self,
        bsdf: B,
        light: L,
        scene: &S,
    ) -> Result<EstimatorsReport, EstimatorsFailure> {
        let limit = normal_quantile(sidak(self.false_alarm / 2.0, 9 * self.directions as usize));
        let (mut rows, mut is_one) = (Vec::new(), true);
        for i in 0..self.directions.max(1) {
            let mut rng = Rng::new(glam::uvec2(i, 5), 0, self.seed);
            let w = sample_uniform_sphere(rng.next_2d());
            let wo = vec3(w.x, w.y, w.z.abs().max(0.05)).normalize();
            let (row, [delta_light, delta_bsdf]) =
                self.estimate(&bsdf, &light, scene, wo, &mut rng);
            let all = [row.by_light, row.by_bsdf, row.by_both];
            // What samples of one alone can meet.
            let pairs = match (delta_light, delta_bsdf) {
                (false, false) => &[(0, 1), (0, 2), (1, 2)][..],
                (true, _) => &[(0, 2)],
                (false, true) => &[(1, 2)],
            };
            is_one &= all.iter().all(|e| e.mean.is_finite());
            for (a, b) in pairs.iter().map(|(a, b)| (all[*a], all[*b])) {
                let allowed = (a.error * a.error + b.error * b.error).map(f64::sqrt) * limit;
                let slack = 1e-4 * a.mean.max(b.mean) + DVec3::splat(1e-9);
                is_one &= (a.mean - b.mean).abs().cmple(allowed + slack).all();
            }
            rows.push(row);
        }
        let report = EstimatorsReport { rows };
        if is_one { Ok(report) } else { Err(EstimatorsFailure { report }) }
    }

    fn estimate<B: Bsdf, L: Light, S: Scene + ?Sized>(
        &self,
        bsdf: &B,
        light: &L,
        scene: &S,
        wo: Vec3,
        rng: &mut Rng,
    ) -> (EstimatorsRow, [bool; 2]) {
        let from = Vec3::ZERO;
        let (mut by_light, mut by_bsdf, mut by_both) = <(Sums, Sums, Sums)>::default();
        let mut has_delta = [false; 2];
        for _ in 0..self.samples {
            let l: LightSample = light.sample(from, rng.next_2d());
            let mut both = Vec3::ZERO;
            if l.pdf > 0.0 {
                let value = bsdf.eval(wo, l.wi) * l.light / l.pdf;
                let rival = if l.is_delta { 0.0 } else { bsdf.pdf(wo, l.wi) };
                by_light.add(value);
                both += value * power_heuristic(1.0, l.pdf, 1.0, rival);
            }
            let u = rng.next_2d();
            let s = bsdf.sample(wo, vec3(u.x, u.y, rng.next_f32()));
            has_delta = [has_delta[0] || l.is_delta, has_delta[1] || s.is_delta];
            if s.pdf > 0.0 {
                let (pdf, radiance) = seen_of(light, scene, from, s.wi);
                let rival = if s.is_delta { 0.0 } else { pdf };
                by_bsdf.add(s.weight * radiance);
                both += s.weight * radiance * power_heuristic(1.0, s.pdf, 1.0, rival);
            }
            by_both.add(both);
        }
        let n = f64::from(self.samples);
        let [by_light, by_bsdf, by_both] = [by_light, by_bsdf, by_both].map(|s| s.estimate(n));
        (EstimatorsRow { wo, by_light, by_bsdf, by_both }, has_delta)
    }
}

impl fmt::Display for EstimatorsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let three = |v: DVec3| format!("{:9.5} {:9.5} {:9.5}", v.x, v.y, v.z);
        for row in &self.rows {
            writeln!(f, "wo {}", row.wo)?;
            let all = [("light", row.by_light), ("BSDF", row.by_bsdf), ("both", row.by_both)];
            for (name, e) in all {
                writeln!(f, "  {name:5}  {}  +- {}", three(e.mean), three(e.error))?;
            }
        }
        Ok(())
    }
}

impl core::error::Error for EstimatorsFailure {}

impl fmt::Display for EstimatorsFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "estimators of the same light have different means")?;
        write!(f, "{}", self.report)
    }
}
