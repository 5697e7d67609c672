//! The check of a light.

use core::fmt;

use glam::{DVec3, Vec2, Vec3, vec2};

use super::findings::{Fault, Findings, write_faults};
use super::histogram::Histogram;
use super::statistics::{normal_quantile, sidak};
use super::variants::disagreement;
use crate::geometry::{Ray, SurfacePoint};
use crate::kernel;
use crate::kernel::Kernel;
use crate::light::{DistantLight, Environment, Light, LightExtent, LightSample};
use crate::machine::Type;
use crate::sampling::{Rng, sample_uniform_sphere};
use crate::shading::Scene;

/// Checks a light as [`LightTest::new`] does. `scene` has the surfaces of the light and nothing else:
/// an empty slice for a light without surfaces.
///
/// ```
/// use raydsl::light::{AreaLight, LightShape};
/// use raydsl::prelude::*;
/// use raydsl::testing::check;
///
/// let (v0, v1, v2) = (vec3(0.0, 2.0, 0.0), vec3(1.0, 2.0, 0.0), vec3(0.0, 2.0, 1.0));
/// let shape = Triangle { v0, v1, v2 };
/// let lamp = AreaLight::<Triangle> { shape, radiance: Vec3::ONE, is_two_sided: true };
/// check::LightTest::new().samples(20_000, 2).run(lamp, &[shape][..])?;
/// # Ok::<(), check::LightFailure>(())
/// ```
///
/// # Errors
///
/// If something does not hold: all that was found, with place and size.
pub fn light<L: Light + Type, S: Scene + ?Sized>(light: L, scene: &S) -> Result<(), LightFailure> {
    LightTest::new().run(light, scene)
}

/// Checks an environment as [`light()`] does a light.
///
/// # Errors
///
/// If something does not hold: all that was found, with place and size.
pub fn environment(environment: &Environment) -> Result<(), LightFailure> {
    LightTest::new().run_environment(environment)
}

/// A check of a light, and how thorough it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightTest {
    /// Samples from each point: 1,000,000 unless set.
    pub samples: u32,
    /// Points from which the light is seen: 5 unless set.
    pub points: u32,
    /// Probability of a false alarm, of all tests together: 0.01 unless set.
    pub false_alarm: f64,
    /// Number of checks that this probability is for: 1 unless set.
    pub checks: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Whether every variant is run: true unless set.
    pub variants: bool,
    /// Whether rounding must account for every difference of WGSL, with at most 2 % of the inputs
    /// left open by it: false unless set. Otherwise it is enough that 98 % of the results are within
    /// 1e-3, where rounding leaves more decisions open.
    pub explained: bool,
}

impl Default for LightTest {
    fn default() -> Self {
        Self::new()
    }
}

/// What is compared: how directions are sampled from a point, and what is there.
struct Subject<'a> {
    from: Vec3,
    sample: &'a dyn Fn(Vec2) -> LightSample,
    /// Density and radiance of a direction.
    seen: &'a dyn Fn(Vec3) -> (f32, Vec3),
}

impl LightTest {
    /// Creates the check with its defaults.
    pub const fn new() -> Self {
        Self {
            samples: 1_000_000,
            points: 5,
            false_alarm: 0.01,
            checks: 1,
            seed: 0,
            variants: true,
            explained: false,
        }
    }

    /// Sets the number of samples from each point, and of points.
    #[must_use]
    pub const fn samples(self, samples: u32, points: u32) -> Self {
        Self { samples, points, ..self }
    }

    /// Sets the number of checks that share the probability of a false alarm.
    #[must_use]
    pub const fn of(self, checks: u32) -> Self {
        Self { checks, ..self }
    }

    /// Demands that rounding accounts for every difference of WGSL.
    #[must_use]
    pub const fn explained(self) -> Self {
        Self { explained: true, ..self }
    }

    /// Checks a light, whose surfaces are the scene.
    ///
    /// # Errors
    ///
    /// If something does not hold: all that was found, with place and size.
    pub fn run<L: Light + Type, S: Scene + ?Sized>(
        &self,
        light: L,
        scene: &S,
    ) -> Result<(), LightFailure> {
        let mut found = Findings::default();
        for i in 0..self.points.max(1) {
            let from = self.point(&light.extent(), i);
            let seen = |wi: Vec3| seen_of(&light, scene, from, wi);
            self.compare(
                &Subject { from, sample: &|u| light.sample(from, u), seen: &seen },
                &mut found,
            );
        }
        extremes(&light, &mut found);
        let power = light.power(1.0);
        if !(power >= 0.0 && power.is_finite()) {
            found.add("the power is negative or not finite", format!("{power}"));
        }
        if self.variants {
            self.variants(light, &mut found);
        }
        found.into_result()
    }

    /// Checks an environment.
    ///
    /// # Errors
    ///
    /// If something does not hold: all that was found, with place and size.
    pub fn run_environment(&self, environment: &Environment) -> Result<(), LightFailure> {
        let mut found = Findings::default();
        let seen = |wi: Vec3| (environment.pdf(wi), environment.radiance(wi));
        let sample = |u| environment.sample(u);
        self.compare(&Subject { from: Vec3::ZERO, sample: &sample, seen: &seen }, &mut found);
        found.into_result()
    }

    /// Returns a point around a light.
    fn point(&self, extent: &LightExtent, i: u32) -> Vec3 {
        let mut rng = Rng::new(glam::uvec2(i, 1), 0, self.seed);
        let center = (extent.min + extent.max) * 0.5;
        let size = (extent.max - extent.min).length().max(1e-3);
        center + sample_uniform_sphere(rng.next_2d()) * size * (0.6 + 2.0 * rng.next_f32())
    }

    fn compare(&self, subject: &Subject<'_>, found: &mut Findings) {
        let from = subject.from;
        let samples = self.samples.max(1000);
        let n = f64::from(samples);
        let mut rng = Rng::new(glam::uvec2(from.x.to_bits(), 2), 0, self.seed);
        let mut draw = || (subject.sample)(rng.next_2d());
        let pilot: Vec<LightSample> = (0..(samples / 50).max(200)).map(|_| draw()).collect();
        if pilot.iter().any(|s| s.is_delta) {
            return delta(from, &pilot, found);
        }
        let mut histogram = Histogram::new(pilot.iter().map(|s| (s.wi, s.pdf)));
        let (mut sum, mut squares, mut unlike) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for _ in 0..samples {
            let s = draw();
            if !is_sound(&s) {
                found.add(
                    "a sample is negative, not finite or not of unit length",
                    format!("from {from}: {s:?}"),
                );
                continue;
            }
            if s.pdf == 0.0 {
                continue;
            }
            histogram.add(s.wi);
            let value = s.light.as_dvec3() / f64::from(s.pdf);
            (sum, squares) = (sum + value, squares + value * value);
            let (pdf, radiance) = (subject.seen)(s.wi);
            let off = (pdf - s.pdf).abs() > 0.01 * s.pdf
                || (radiance - s.light).abs().max_element() > 0.01 * s.light.max_element();
            unlike += f64::from(u8::from(off));
            // Next to a silhouette a ray may miss.
            if off && unlike > 10.0 && unlike > 2e-3 * n {
                found.add(
                    "a sample's pdf or radiance is not that of its direction",
                    format!(
                        "from {from}, wi {}: pdf {:.5e} sampled, {pdf:.5e} asked; radiance {} sampled, \
                         {radiance} asked",
                        s.wi, s.pdf, s.light
                    ),
                );
            }
        }
        let of = |wi: Vec3| {
            let (pdf, radiance) = (subject.seen)(wi);
            radiance.as_dvec3().extend(f64::from(pdf))
        };
        let tests = 2 * self.points.max(1) as usize * self.checks.max(1) as usize;
        let limit = normal_quantile(sidak(self.false_alarm, tests));
        // The integral over the bins at a silhouette is less exact.
        let total = histogram.compare(&format!("from {from}"), (n, limit, 3e-3), &of, found);
        let mean = sum / n;
        let error = ((squares / n - mean * mean).max(DVec3::ZERO) / n).map(f64::sqrt);
        let integral = total.truncate();
        for (i, color) in ["red", "green", "blue"].into_iter().enumerate() {
            if (mean[i] - integral[i]).abs() > (limit + 1.0) * error[i] + 3e-3 * integral[i] + 1e-6
            {
                found.add(
                    "the mean of samples is not the integral of the radiance that rays meet",
                    format!("from {from}: {:.5} for {:.5} in {color}", mean[i], integral[i]),
                );
            }
        }
    }

    fn variants<L: Light + Type>(&self, light: L, found: &mut Findings) {
        let extent = light.extent();
        let inputs: Vec<(L, Vec3, Vec2)> = (0..300)
            .map(|i| {
                let mut rng = Rng::new(glam::uvec2(i, 3), 0, self.seed);
                (light, self.point(&extent, i), rng.next_2d())
            })
            .collect();
        if let Some(text) = disagreement(&Kernel::of::<all_of<L>>(), &inputs, self.explained) {
            found.add("variants differ", text);
        }
    }
}

/// Returns the density and the radiance of a direction: of the surface that a ray meets, or from
/// infinitely far away.
pub(super) fn seen_of<L: Light, S: Scene + ?Sized>(
    light: &L,
    scene: &S,
    from: Vec3,
    wi: Vec3,
) -> (f32, Vec3) {
    let ray = Ray::new(from, wi);
    let hit = scene.closest_hit(ray);
    if hit.is_hit {
        let at = scene.surface(ray, hit);
        return (light.pdf(from, at), light.emitted(at, -wi));
    }
    let DistantLight { radiance, pdf } = light.distant(wi);
    (pdf, radiance)
}

/// Checks the samples of a delta light: all are the same.
fn delta(from: Vec3, samples: &[LightSample], found: &mut Findings) {
    let first = samples[0];
    for s in samples {
        if *s != first || !is_sound(s) || s.pdf > 1.0 {
            found.add(
                "samples of a delta light differ, or are not finite",
                format!("from {from}: {s:?}"),
            );
        }
    }
}

fn is_sound(s: &LightSample) -> bool {
    s.light.is_finite()
        && s.light.min_element() >= 0.0
        && s.pdf >= 0.0
        && s.pdf < f32::MAX
        && (s.wi.length() - 1.0).abs() < 1e-4
        && s.end.position.is_finite()
}

/// Looks at a light from where formulas break: from itself, from its edge, and from far away.
fn extremes<L: Light>(light: &L, found: &mut Findings) {
    let extent = light.extent();
    let center = (extent.min + extent.max) * 0.5;
    let size = (extent.max - extent.min).max_element().max(1e-3);
    let mut points = vec![center, extent.min, extent.max];
    for k in [1e-7, 1e-3, 1e3, 1e6f32] {
        points.extend([center + extent.axis * (size * k), center + Vec3::X * (size * k)]);
    }
    let numbers = [0.0, 1e-7, 0.5, 0.999_999_94];
    for from in points {
        for i in 0..16 {
            let s = light.sample(from, vec2(numbers[i % 4], numbers[i / 4]));
            let pdf = light.pdf(from, s.end);
            if !is_sound(&s) || pdf < 0.0 || pdf.is_nan() {
                found.add(
                    "a sample is negative, not finite or not of unit length",
                    format!("from {from}: {s:?}, pdf {pdf}"),
                );
            }
        }
    }
}

#[kernel]
fn all_of<L: Light + Type>(
    light: L,
    from: Vec3,
    u: Vec2,
) -> (LightSample, f32, Vec3, DistantLight, f32) {
    let sample: LightSample = light.sample(from, u);
    let end: SurfacePoint = sample.end;
    let pdf = light.pdf(from, end);
    (sample, pdf, light.emitted(end, -sample.wi), light.distant(sample.wi), light.power(2.0))
}

impl Findings {
    fn into_result(self) -> Result<(), LightFailure> {
        if self.faults.is_empty() { Ok(()) } else { Err(LightFailure { faults: self.faults }) }
    }
}

/// What does not hold of a light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightFailure {
    faults: Vec<Fault>,
}

impl LightFailure {
    /// Returns what is wrong, a sentence each.
    pub fn faults(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.faults.iter().map(|f| f.what)
    }
}

impl core::error::Error for LightFailure {}

impl fmt::Display for LightFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "the light does not hold together")?;
        write_faults(f, &self.faults)
    }
}
