//! How often a claimed bound holds, over many seeds.

use std::sync::Mutex;

use raydsl::prelude::*;
use raydsl::render::{Budget, Metric, Outcome, Target, Until};
use raydsl_tests::{in_parallel, scaled};

/// The kernel of a film of grey.
pub(crate) type Estimator<'a> = Kernel<'a, (Ray, Sampler), f32>;

/// What the claimed 95 % may be.
pub(crate) const CLAIMED: (f64, f64) = (0.93, 0.99);

/// A film whose pixels are known.
pub(crate) struct Known<C> {
    pub(crate) camera: C,
    pub(crate) pixels: PixelSampler,
    /// Columns and rows.
    pub(crate) film: (u32, u32),
    pub(crate) metric: Metric,
    /// Exact values of the pixels, row by row from the bottom.
    pub(crate) truth: Vec<f64>,
}

impl<C> Known<C> {
    /// The true error of a film, in the metric's unit.
    pub(crate) fn error(&self, film: &Film) -> f64 {
        let image = film.image();
        let off = |(p, truth): (&Vec4, &f64)| (f64::from(p.x) - truth, f64::from(p.x));
        let pixels = image.pixels().iter().zip(&self.truth).map(off);
        let n = self.truth.len() as f64;
        match self.metric {
            Metric::Mean => (pixels.map(|(off, _)| off).sum::<f64>() / n).abs(),
            Metric::Rmse => (pixels.map(|(off, _)| off * off).sum::<f64>() / n).sqrt(),
            // The estimated value is close to the exact one.
            Metric::RelMse => pixels.map(|(off, v)| off * off / (v * v + 0.01)).sum::<f64>() / n,
        }
    }

    /// The target of a tolerance that is a share of the mean value.
    pub(crate) fn target(&self, share: f64) -> Target {
        let mean = self.truth.iter().sum::<f64>() / self.truth.len() as f64;
        let tolerance = if self.metric == Metric::RelMse { share * share } else { share * mean };
        Target::new(self.metric, tolerance)
    }
}

/// What many seeds gave.
#[derive(Default)]
pub(crate) struct Tally {
    pub(crate) seeds: u32,
    pub(crate) converged: u32,
    /// The true error was within the upper bound.
    pub(crate) below: u32,
    /// It was within the tolerance, and convergence was claimed.
    pub(crate) good: u32,
    /// Samples per pixel in all.
    pub(crate) samples: u64,
}

/// Renders the film once for each seed.
pub(crate) fn tally<C: Camera + Sync>(
    known: &Known<C>,
    kernel: &Estimator<'_>,
    method: SampleMethod,
    until: &Until,
    seeds: u32,
) -> Tally {
    let all = Mutex::new(Tally::default());
    in_parallel(seeds as usize, 8.min(seeds as usize / 8), |part| {
        for seed in part {
            let sampling = Sampling::new(1).pixels(known.pixels).method(method).seed(seed as u32);
            let mut film = Film::new(known.film.0, known.film.1);
            // A packet would have one lane at work for one pixel.
            let variant = if known.film == (1, 1) { Variant::Scalar } else { Variant::widest() };
            let scheduler = SimpleScheduler::new().variant(variant);
            let reached = scheduler
                .render_until(&known.camera, kernel, &sampling, &mut film, until)
                .expect("a target and a budget");
            let error = known.error(&film);
            let has_converged = reached.outcome == Outcome::Converged;
            let mut all = all.lock().expect("no one panics");
            all.seeds += 1;
            all.converged += u32::from(has_converged);
            all.below += u32::from(error <= reached.estimate.high);
            all.good += u32::from(has_converged && error <= until.target.tolerance);
            all.samples += u64::from(reached.spent);
        }
    });
    all.into_inner().expect("no one panics")
}

/// The runs of a row: random samples to a tolerance, Sobol samples to another one, and random samples
/// for a tolerance that is out of reach.
#[derive(Clone, Copy)]
pub(crate) struct Runs {
    /// The tolerance of random samples, as a share of the mean value.
    pub(crate) random: f64,
    /// The tolerance of Sobol samples.
    pub(crate) sobol: f64,
    /// Samples per pixel of the pilot.
    pub(crate) pilot: u32,
    /// Samples per pixel of the last run.
    pub(crate) samples: u32,
}

/// A table of coverage, a row for each case.
pub(crate) struct Table {
    seeds: u32,
    wrong: Vec<String>,
}

impl Table {
    pub(crate) fn new() -> Self {
        let seeds = scaled(64) as u32;
        println!("{seeds} seeds: % of bounds that hold, and samples a pixel");
        println!("{:32} {:>16} {:>16} {:>16}", "", "random", "Sobol", "out of samples");
        Self { seeds, wrong: Vec::new() }
    }

    /// Measures a case, whose coverage is to be within `range`.
    pub(crate) fn row<C: Camera + Sync>(
        &mut self,
        name: &str,
        range: (f64, f64),
        runs: Runs,
        known: &Known<C>,
        kernel: &Estimator<'_>,
    ) {
        let seeds = self.seeds;
        let until = |share: f64, samples: u32| {
            Until::new(known.target(share).pilot(runs.pilot), Budget::of_samples(samples))
        };
        let (endless, unreachable) = (50_000_000, 1e-4);
        let mut line = format!("{name:32}");
        for (method, until, converges) in [
            (SampleMethod::Random, until(runs.random, endless), true),
            (SampleMethod::Sobol, until(runs.sobol, endless), true),
            (SampleMethod::Random, until(unreachable, runs.samples), false),
        ] {
            let found = tally(known, kernel, method, &until, seeds);
            let covered = 100.0 * f64::from(found.below) / f64::from(seeds);
            line += &format!(" {covered:6.1} {:9}", found.samples / u64::from(seeds));
            let is_covered = holds(found.below, seeds, range);
            let has_converged = found.converged == if converges { seeds } else { 0 };
            let is_good = !converges || holds(found.good, seeds, (range.0, 1.0));
            if !(has_converged && is_covered && is_good) {
                let (converged, good) = (found.converged, found.good);
                self.wrong.push(format!("{name} {method:?}: {covered} {converged} {good}"));
            }
        }
        println!("{line}");
    }

    pub(crate) fn finish(self) {
        assert!(self.wrong.is_empty(), "{:?}", self.wrong);
    }
}

/// Whether `count` of `seeds` is what a probability within `range` gives. Of a thousand seeds it is the
/// share that has to be in the range. Of fewer, counts are refused that the end of the range would
/// give once in a thousand: with a binomial distribution, `sum C(n, k) p^k (1 - p)^(n - k)`.
pub(crate) fn holds(count: u32, seeds: u32, range: (f64, f64)) -> bool {
    const RARE: f64 = 1e-3;
    let share = f64::from(count) / f64::from(seeds);
    if seeds >= 1000 {
        return (range.0..=range.1).contains(&share);
    }
    let fails = seeds - count;
    at_most(count, seeds, range.0) > RARE && at_most(fails, seeds, 1.0 - range.1) > RARE
}

/// The probability of at most `count` of `n` events that have a probability of `p` each.
fn at_most(count: u32, n: u32, p: f64) -> f64 {
    let (mut ln_choose, mut sum) = (0.0, 0.0);
    for k in 0..=count {
        let (hits, others) = (f64::from(k), f64::from(n - k));
        let term = |times: f64, p: f64| if times == 0.0 { 0.0 } else { times * p.ln() };
        sum += (ln_choose + term(hits, p) + term(others, 1.0 - p)).exp();
        ln_choose += (others / (hits + 1.0)).ln();
    }
    sum
}

/// Of 16 seeds 11 or more are to hold, of 64 52, of 256 224, and any number may be all; of 1000 from 930
/// to 990.
#[test]
fn counts_that_a_probability_gives() {
    assert!((at_most(1, 3, 0.5) - 0.5).abs() < 1e-12);
    assert!((at_most(0, 64, 0.01) - 0.99f64.powi(64)).abs() < 1e-12);
    assert!((at_most(64, 64, 0.93) - 1.0).abs() < 1e-12);
    for (seeds, least) in [(16, 11), (64, 52), (256, 224)] {
        let good: Vec<u32> = (0..=seeds).filter(|&n| holds(n, seeds, CLAIMED)).collect();
        assert!(good == (least..=seeds).collect::<Vec<u32>>(), "{seeds}: {good:?}");
    }
    let good: Vec<u32> = (0..=1000).filter(|&n| holds(n, 1000, CLAIMED)).collect();
    assert_eq!(good, (930..=990).collect::<Vec<u32>>());
}
