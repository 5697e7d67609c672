//! The check of a BSDF.

use core::fmt;

use glam::{DVec3, DVec4, Vec3, vec3};

use super::findings::{Fault, Findings, write_faults};
use super::histogram::Histogram;
use super::statistics::{normal_quantile, sidak};
use super::variants::disagreement;
use crate::bsdf::{Bsdf, BsdfSample};
use crate::kernel;
use crate::kernel::Kernel;
use crate::machine::Type;
use crate::sampling::{Rng, sample_uniform_sphere};

/// Checks a BSDF as [`BsdfTest::new`] does.
///
/// # Errors
///
/// If something does not hold: all that was found, with place and size.
pub fn bsdf<B: Bsdf + Type>(bsdf: B) -> Result<BsdfReport, BsdfFailure> {
    BsdfTest::new().run(bsdf)
}

/// A check of a BSDF: what is claimed of it, and how thoroughly that is tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfTest {
    /// Samples for each direction of the viewer: 1,000,000 unless set.
    pub samples: u32,
    /// Random directions of the viewer: 5 unless set, on both sides of the surface.
    pub directions: u32,
    /// Least and greatest share of light, of each colour, that may be scattered: 0 and 1.0001 unless
    /// set.
    pub energy: (f64, f64),
    /// Ratio of the index of refraction below the surface to that above where reciprocity is
    /// claimed: 1 unless set. For a BSDF that is not reciprocal it is `None`.
    pub reciprocal: Option<f32>,
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

impl Default for BsdfTest {
    fn default() -> Self {
        Self::new()
    }
}

impl BsdfTest {
    /// Creates the check of a reciprocal BSDF that creates no light.
    pub const fn new() -> Self {
        Self {
            samples: 1_000_000,
            directions: 5,
            energy: (0.0, 1.0001),
            reciprocal: Some(1.0),
            false_alarm: 0.01,
            checks: 1,
            seed: 0,
            variants: true,
            explained: false,
        }
    }

    /// Sets the number of samples for each direction, and of directions.
    #[must_use]
    pub const fn samples(self, samples: u32, directions: u32) -> Self {
        Self { samples, directions, ..self }
    }

    /// Sets the least and the greatest share of light that may be scattered.
    #[must_use]
    pub const fn energy(self, least: f64, greatest: f64) -> Self {
        Self { energy: (least, greatest), ..self }
    }

    /// Claims no reciprocity.
    #[must_use]
    pub const fn not_reciprocal(self) -> Self {
        Self { reciprocal: None, ..self }
    }

    /// Claims reciprocity of a surface that refracts, between these relative indices: `f(wo, wi)`
    /// over the square of the index on the side of `wi`.
    #[must_use]
    pub const fn refracting(self, ior: f32) -> Self {
        Self { reciprocal: Some(ior), ..self }
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

    /// Checks a BSDF.
    ///
    /// # Errors
    ///
    /// If something does not hold: all that was found, with place and size.
    pub fn run<B: Bsdf + Type>(&self, bsdf: B) -> Result<BsdfReport, BsdfFailure> {
        let mut found = Findings::default();
        let mut rows = Vec::new();
        for i in 0..self.directions.max(1) {
            rows.push(self.histogram(&bsdf, self.direction(i), &mut found));
        }
        self.reciprocity(&bsdf, &mut found);
        extremes(&bsdf, &mut found);
        if self.variants {
            self.variants(bsdf, &mut found);
        }
        let report = BsdfReport { rows };
        match found.faults.is_empty() {
            true => Ok(report),
            false => Err(BsdfFailure { faults: found.faults, report }),
        }
    }

    /// Returns a direction of the viewer: every third one below the surface.
    fn direction(&self, i: u32) -> Vec3 {
        let mut rng = self.rng(1, i);
        let w = sample_uniform_sphere(rng.next_2d());
        let z = if i % 3 == 2 { -w.z.abs() } else { w.z.abs() };
        vec3(w.x, w.y, z)
    }

    fn rng(&self, purpose: u32, i: u32) -> Rng {
        Rng::new(glam::uvec2(i, purpose), 0, self.seed)
    }

    /// Compares samples with their densities, and with the integrals of density and value.
    fn histogram<B: Bsdf>(&self, bsdf: &B, wo: Vec3, found: &mut Findings) -> BsdfRow {
        let samples = self.samples.max(1000);
        let mut rng = self.rng(2, wo.x.to_bits() ^ wo.z.to_bits());
        let mut draw = || {
            let u = rng.next_2d();
            bsdf.sample(wo, vec3(u.x, u.y, rng.next_f32()))
        };
        let pilot = (0..(samples / 50).max(200)).map(|_| draw());
        let mut histogram = Histogram::new(pilot.filter(|s| !s.is_delta).map(|s| (s.wi, s.pdf)));
        let mut sums = Sums::default();
        for _ in 0..samples {
            let sample = draw();
            if sums.add(bsdf, wo, &sample, found) {
                histogram.add(sample.wi);
            }
        }
        let n = f64::from(samples);
        let of = |wi: Vec3| bsdf.eval(wo, wi).as_dvec3().extend(f64::from(bsdf.pdf(wo, wi)));
        let tests = 2 * self.directions.max(1) as usize * self.checks.max(1) as usize;
        let limit = normal_quantile(sidak(self.false_alarm, tests));
        let total = histogram.compare(&format!("wo {wo}"), (n, limit, 1e-3), &of, found);
        sums.judge_spread(wo, (n, limit), total.w, found);
        sums.judge_deltas(wo, (n, limit), found);
        self.judge_means(wo, (n, &sums, limit), total, found)
    }

    fn judge_means(
        &self,
        wo: Vec3,
        (n, sums, limit): (f64, &Sums, f64),
        total: DVec4,
        found: &mut Findings,
    ) -> BsdfRow {
        let mean = sums.weight / n;
        let error = ((sums.squares / n - mean * mean).max(DVec3::ZERO) / n).map(f64::sqrt);
        let delta = sums.delta_weight / n;
        let integral = total.truncate() + delta;
        for (i, color) in ["red", "green", "blue"].into_iter().enumerate() {
            let (mean, error, integral) = (mean[i], error[i], integral[i]);
            if (mean - integral).abs() > (limit + 1.0) * error + 2e-3 * integral + 1e-6 {
                found.add(
                    "weights and eval differ",
                    format!(
                        "wo {wo}: the mean weight is {mean:.5} in {color}, the integral of eval \
                         {integral:.5}"
                    ),
                );
            }
            let (least, greatest) = self.energy;
            if mean - (limit + 1.0) * error > greatest {
                found.add(
                    "light is created",
                    format!("wo {wo}: {mean:.5} in {color}, {greatest} allowed"),
                );
            }
            if mean + (limit + 1.0) * error < least {
                found.add("light is lost", format!("wo {wo}: {mean:.5} in {color}, {least} asked"));
            }
        }
        BsdfRow { wo, albedo: mean, error, integral, spread: sums.spread / n }
    }

    fn reciprocity<B: Bsdf>(&self, bsdf: &B, found: &mut Findings) {
        let Some(ior) = self.reciprocal else { return };
        let mut rng = self.rng(3, 0);
        let index = |w: Vec3| if w.z < 0.0 { ior } else { 1.0 };
        let brdf = |wo: Vec3, wi: Vec3| {
            bsdf.eval(wo, wi).as_dvec3() / f64::from(wi.z.abs() * index(wi) * index(wi))
        };
        let (mut worst, mut at) = (0.0, [Vec3::Z; 2]);
        for _ in 0..20_000 {
            let [wo, mut wi] = [(); 2].map(|()| sample_uniform_sphere(rng.next_2d()));
            // Half of the pairs are those of samples, so that narrow lobes are met.
            if rng.next_f32() < 0.5 {
                let u = rng.next_2d();
                wi = bsdf.sample(wo, vec3(u.x, u.y, rng.next_f32())).wi;
            }
            if wo.z.abs() < 0.01 || wi.z.abs() < 0.01 {
                continue;
            }
            let (there, back) = (brdf(wo, wi), brdf(wi, wo));
            let off = ((there - back).abs() / (there.max(back) + 1e-3)).max_element();
            if off > worst {
                (worst, at) = (off, [wo, wi]);
            }
        }
        if worst > RECIPROCITY {
            let [wo, wi] = at;
            let text = format!("wo {wo}, wi {wi}: {} there, {} back", brdf(wo, wi), brdf(wi, wo));
            found.add("not reciprocal", text);
        }
    }

    fn variants<B: Bsdf + Type>(&self, bsdf: B, found: &mut Findings) {
        let mut rng = self.rng(4, 0);
        let (mut values, mut draws) = (Vec::new(), Vec::new());
        for _ in 0..200 {
            let u = rng.next_2d();
            let u = vec3(u.x, u.y, rng.next_f32());
            let [wo, wi] = [(); 2].map(|()| sample_uniform_sphere(rng.next_2d()));
            let wi = if rng.next_f32() < 0.5 { wi } else { bsdf.sample(wo, u).wi };
            values.push((bsdf, wo, wi));
            draws.push((bsdf, wo, u));
        }
        let values = disagreement(&Kernel::of::<values_of<B>>(), &values, self.explained);
        let draws = disagreement(&Kernel::of::<sample_of<B>>(), &draws, self.explained);
        values.into_iter().chain(draws).for_each(|text| found.add("variants differ", text));
    }
}

/// Greatest difference of a value and its reverse, relative to the greater.
const RECIPROCITY: f64 = 2e-3;

/// Greatest difference of a sample's density and weight to those of its direction: that of rounding
/// the direction, for all but one in a thousand samples.
const REPEATED: f64 = 0.02;

#[kernel]
fn values_of<B: Bsdf + Type>(bsdf: B, wo: Vec3, wi: Vec3) -> (Vec3, f32, Vec3) {
    (bsdf.eval(wo, wi), bsdf.pdf(wo, wi), bsdf.albedo(wo))
}

#[kernel]
fn sample_of<B: Bsdf + Type>(bsdf: B, wo: Vec3, u: Vec3) -> BsdfSample {
    bsdf.sample(wo, u)
}

/// Asks at directions where formulas break: along the normal and the surface, at the other side,
/// and with the least and the greatest numbers.
fn extremes<B: Bsdf>(bsdf: &B, found: &mut Findings) {
    let heights =
        [1.0, 0.999_999_94, 0.5, 1e-2, 1.745e-5, 1e-6, 1e-20, 0.0, -1e-20, -1e-6, -0.5, -1.0];
    let directions = heights.map(|z: f32| {
        let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        [vec3(r, 0.0, z), vec3(-0.6 * r, 0.8 * r, z)]
    });
    let numbers = [0.0, 1e-7, 0.5, 0.999_999_94];
    for wo in directions.into_iter().flatten() {
        for wi in directions.into_iter().flatten() {
            let (eval, pdf) = (bsdf.eval(wo, wi), bsdf.pdf(wo, wi));
            let is_sound =
                eval.is_finite() && eval.min_element() >= 0.0 && (0.0..f32::MAX).contains(&pdf);
            if !is_sound {
                found.add(
                    "a value is negative or not finite",
                    format!("wo {wo}, wi {wi}: eval {eval}, pdf {pdf}"),
                );
            }
        }
        for i in 0..64 {
            let u = vec3(numbers[i % 4], numbers[i / 4 % 4], numbers[i / 16]);
            let sample = bsdf.sample(wo, u);
            if !is_sound(&sample) {
                let text = format!("wo {wo}, u {u}: {sample:?}");
                found.add("a sample is negative, not finite or not of unit length", text);
            }
        }
    }
}

fn is_sound(sample: &BsdfSample) -> bool {
    let length = sample.wi.length();
    sample.weight.is_finite()
        && sample.weight.min_element() >= 0.0
        && sample.pdf >= 0.0
        && sample.pdf < f32::MAX
        && (length - 1.0).abs() < 1e-4
}

/// Length of the difference of two directions of one delta lobe.
const SAME_DIRECTION: f32 = 1e-3;

/// Greatest number of delta lobes that one direction of the viewer has.
const MOST_DELTAS: usize = 16;

/// A direction to which a delta lobe scatters.
struct DeltaLobe {
    first: BsdfSample,
    count: f64,
}

/// Sums over the samples of one direction.
#[derive(Default)]
struct Sums {
    weight: DVec3,
    squares: DVec3,
    delta_weight: DVec3,
    deltas: Vec<DeltaLobe>,
    /// Samples that are no delta and not absorbed.
    spread: f64,
    /// Those whose direction has no density.
    misplaced: f64,
    /// Those whose density or weight is not that of their direction.
    unlike: f64,
}

impl Sums {
    /// Adds a sample, and returns whether it is spread.
    fn add<B: Bsdf>(&mut self, bsdf: &B, wo: Vec3, s: &BsdfSample, found: &mut Findings) -> bool {
        if !is_sound(s) {
            let text = format!("wo {wo}: {s:?}");
            found.add("a sample is negative, not finite or not of unit length", text);
            return false;
        }
        let weight = s.weight.as_dvec3();
        self.weight += weight;
        self.squares += weight * weight;
        if s.is_delta {
            self.delta_weight += weight;
            self.add_delta(wo, s, found);
        }
        if s.is_delta || s.pdf == 0.0 {
            return false;
        }
        self.spread += 1.0;
        let (pdf, eval) = (f64::from(bsdf.pdf(wo, s.wi)), bsdf.eval(wo, s.wi).as_dvec3());
        let drawn = f64::from(s.pdf);
        self.misplaced += f64::from(u8::from(pdf == 0.0));
        let value = weight * drawn;
        let off = ((eval - value).abs() / (eval.abs().max(value) + 1e-6)).max_element();
        let is_unlike = (pdf - drawn).abs() > REPEATED * pdf.max(drawn) || off > REPEATED;
        self.unlike += f64::from(u8::from(is_unlike));
        if is_unlike && self.unlike > 10.0 && self.unlike > 1e-3 * self.spread {
            found.add(
                "a sample's pdf or weight is not that of its direction",
                format!(
                    "wo {wo}, wi {}: pdf {drawn:.5e} sampled, {pdf:.5e} asked; value {value} \
                     sampled, {eval} asked",
                    s.wi
                ),
            );
        }
        true
    }
}

impl Sums {
    /// Counts a sample of a delta lobe, which has one direction, density and weight.
    fn add_delta(&mut self, wo: Vec3, s: &BsdfSample, found: &mut Findings) {
        // Several lobes may have one direction, as a mirror and its coat do.
        let limit = REPEATED as f32;
        let is_like = |a: f32, b: f32| (a - b).abs() <= limit * a.abs().max(b.abs());
        let is_same = |d: &&mut DeltaLobe| {
            let DeltaLobe { first, .. } = d;
            let weights = s.weight.to_array().into_iter().zip(first.weight.to_array());
            first.wi.abs_diff_eq(s.wi, SAME_DIRECTION)
                && is_like(s.pdf, first.pdf)
                && weights.into_iter().all(|(a, b)| is_like(a, b))
        };
        if let Some(lobe) = self.deltas.iter_mut().find(is_same) {
            lobe.count += 1.0;
        } else if self.deltas.len() < MOST_DELTAS {
            self.deltas.push(DeltaLobe { first: *s, count: 1.0 });
        } else {
            found.add("delta samples are of many kinds", format!("wo {wo}: {s:?}"));
        }
    }

    /// Compares how often each delta lobe was sampled with its density.
    fn judge_deltas(&self, wo: Vec3, (n, limit): (f64, f64), found: &mut Findings) {
        for DeltaLobe { first, count } in &self.deltas {
            let (share, pdf) = (count / n, f64::from(first.pdf));
            let error = (pdf * (1.0 - pdf).max(0.0) / n).sqrt();
            if (share - pdf).abs() > (limit + 1.0) * error + 3.0 / n + 1e-5 {
                let wi = first.wi;
                let text = format!("wo {wo}, wi {wi}: a share of {share:.5}, pdf {pdf:.5}");
                found.add("delta samples are not as frequent as their pdf says", text);
            }
        }
    }

    /// Compares the share of samples that are spread with the integral of their density.
    fn judge_spread(&self, wo: Vec3, (n, limit): (f64, f64), mass: f64, found: &mut Findings) {
        let share = self.misplaced / n;
        if share > 1e-5 {
            found.add("samples where pdf is 0", format!("wo {wo}: a share of {share:.2e}"));
        }
        // What a delta lobe has, and what is absorbed, is the rest.
        let share = self.spread / n;
        let error = (share * (1.0 - share) / n).sqrt();
        if (mass - share).abs() > limit * error + 2e-3 {
            found.add(
                "pdf has another integral than the share of samples that it is for",
                format!("wo {wo}: {mass:.5} for {share:.5}"),
            );
        }
    }
}

/// What a check found for each direction of the viewer; printed, it is a table.
#[derive(Clone, Debug, PartialEq)]
pub struct BsdfReport {
    /// The directions.
    pub rows: Vec<BsdfRow>,
}

/// What a check found for one direction of the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfRow {
    /// Direction of the viewer.
    pub wo: Vec3,
    /// Share of light from everywhere that is scattered to the viewer, by samples: red, green, blue.
    pub albedo: DVec3,
    /// Its standard error.
    pub error: DVec3,
    /// The same as the integral of `eval`, and what delta lobes have.
    pub integral: DVec3,
    /// Share of samples that are no delta and not absorbed.
    pub spread: f64,
}

impl fmt::Display for BsdfReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:>24}  {:>26}  {:>26}  {:>6}",
            "wo", "albedo by samples", "by eval", "spread"
        )?;
        for row in &self.rows {
            let three = |v: [f64; 3]| format!("{:8.5} {:8.5} {:8.5}", v[0], v[1], v[2]);
            let wo = three(row.wo.as_dvec3().to_array());
            let (a, b) = (three(row.albedo.to_array()), three(row.integral.to_array()));
            writeln!(f, "{wo:>24}  {a:>26}  {b:>26}  {:6.4}", row.spread)?;
        }
        Ok(())
    }
}

/// What does not hold of a BSDF.
#[derive(Clone, Debug, PartialEq)]
pub struct BsdfFailure {
    faults: Vec<Fault>,
    /// What was found for each direction.
    pub report: BsdfReport,
}

impl BsdfFailure {
    /// Returns what is wrong, a sentence each.
    pub fn faults(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.faults.iter().map(|f| f.what)
    }
}

impl core::error::Error for BsdfFailure {}

impl fmt::Display for BsdfFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "the BSDF does not hold together")?;
        write_faults(f, &self.faults)?;
        write!(f, "{}", self.report)
    }
}
