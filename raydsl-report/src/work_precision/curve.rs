//! Curves: the results of one method on one backend over the knob.

use super::case::{Backend, Method, Order};
use super::efficiency::Efficiency;
use super::fit::{Fit, Reached, first_below, student_t, value_at};
#[cfg(feature = "flip")]
use super::flip::Flip;
use super::metrics::{Metrics, root};
use super::reference::Reference;
use super::work::Work;
use crate::{Missing, Times};

/// The status of a point or a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Status {
    /// It is valid.
    Ok,
    /// Its error is not above the uncertainty of the reference, or of rounding: no order is fitted
    /// to it, and it is drawn dotted.
    Floor,
    /// Estimates were not finite.
    Diverged,
    /// It would have exceeded the time budget, and was not run.
    Budget,
}

impl Status {
    /// Returns `ok`, `floor`, `diverged` or `budget`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Floor => "floor",
            Self::Diverged => "diverged",
            Self::Budget => "budget",
        }
    }
}

/// One timed run.
#[derive(Clone, Debug, PartialEq)]
pub struct Repetition {
    /// The seed.
    pub seed: u32,
    /// The run time, in seconds.
    pub seconds: f64,
    /// The CPU time, in seconds: user and system time of all threads of this process, including
    /// those of a driver that computes on the CPU. `None` without the feature `cpu_time`.
    pub cpu_seconds: Option<f64>,
    /// Samples in all.
    pub samples: u64,
    /// The kernel's own count, in all.
    pub counted: Option<u64>,
    /// The work reported by the run.
    pub work: Work,
    /// The error.
    pub metrics: Metrics,
    /// The FLIP difference to the reference, in LDR, if the estimates are a picture.
    #[cfg(feature = "flip")]
    pub flip: Option<Flip>,
    /// The FLIP difference in HDR.
    #[cfg(feature = "flip")]
    pub hdr_flip: Option<Flip>,
    /// The status.
    pub status: Status,
    /// The estimates.
    pub values: Vec<f64>,
}

/// All runs of one method on one backend with one value of the knob.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The knob's value.
    pub knob: u32,
    /// Its runs, each with another seed; none if the time budget did not allow one.
    pub repetitions: Vec<Repetition>,
    /// The root of the mean square difference to the same samples in `f64`, if those were run.
    pub rounding: Option<f64>,
    /// The work of a run with the first seed, if the case [counts it
    /// separately](super::Case::counted).
    pub counted_apart: Option<Work>,
}

impl Point {
    /// Creates a point without runs.
    pub(super) fn new(knob: u32) -> Self {
        Self { knob, repetitions: Vec::new(), rounding: None, counted_apart: None }
    }

    /// Returns the root of the mean square error over all repetitions with finite estimates. Mean
    /// squares of two halves are summed with their signs: only their mean is clamped at 0.
    pub fn rmse(&self) -> f64 {
        let squares: Vec<f64> = self.finite().map(|r| r.metrics.mse).collect();
        root(squares.iter().sum::<f64>() / squares.len() as f64)
    }

    /// Returns the 95 % interval of [`Self::rmse`]: the roots of that of the mean square, by
    /// Student's t over the repetitions. `None` for fewer than two with finite estimates.
    pub fn rmse_interval(&self) -> Option<[f64; 2]> {
        let squares: Vec<f64> = self.finite().map(|r| r.metrics.mse).collect();
        let n = squares.len();
        if n < 2 {
            return None;
        }
        let mean = squares.iter().sum::<f64>() / n as f64;
        let spread: f64 = squares.iter().map(|s| (s - mean).powi(2)).sum();
        let half = student_t(n - 1) * (spread / (n - 1) as f64 / n as f64).sqrt();
        Some([root(mean - half), root(mean + half)])
    }

    /// Returns the mean error over all repetitions, in standard errors; 0 if there is no error at
    /// all.
    pub fn bias_z(&self) -> f64 {
        let bias: f64 = self.finite().map(|r| r.metrics.bias).sum();
        let variance: f64 = self.finite().map(|r| r.metrics.bias_error.powi(2)).sum();
        if bias == 0.0 { 0.0 } else { bias / variance.sqrt() }
    }

    fn finite(&self) -> impl Iterator<Item = &Repetition> {
        self.repetitions.iter().filter(|r| r.status != Status::Diverged)
    }

    /// Returns the shortest time, in seconds; infinite without a run.
    pub fn t_min(&self) -> f64 {
        self.repetitions.iter().map(|r| r.seconds).fold(f64::INFINITY, f64::min)
    }

    /// Returns the CPU time, in seconds, over all of its runs together; `None` without a run, or
    /// without the feature `cpu_time`.
    pub fn cpu_seconds(&self) -> Option<f64> {
        let all = self.repetitions.iter().map(|r| r.cpu_seconds).sum::<Option<f64>>();
        all.filter(|_| !self.repetitions.is_empty())
    }

    /// Returns the median time, in seconds; 0 without a run.
    pub fn t_median(&self) -> f64 {
        Times { ms: self.repetitions.iter().map(|r| r.seconds).collect() }.median()
    }

    /// Returns the quantile `share`, from 0 to 1, of the run times, in seconds, interpolated
    /// linearly; NaN without a run.
    pub fn t_quantile(&self, share: f64) -> f64 {
        quantile(self.repetitions.iter().map(|r| r.seconds), share)
    }

    /// Returns the quantile `share`, from 0 to 1, of the runs' root mean square errors,
    /// interpolated linearly; NaN without a run with finite estimates.
    pub fn rmse_quantile(&self, share: f64) -> f64 {
        quantile(self.finite().map(|r| r.metrics.rmse), share)
    }

    /// Returns one over variance and time, of three runs or more with finite estimates.
    pub fn efficiency(&self) -> Option<Efficiency> {
        let runs: Vec<(f64, &[f64])> =
            self.finite().map(|r| (r.seconds, r.values.as_slice())).collect();
        Efficiency::of(&runs)
    }

    /// Returns the work of a run: [`Self::counted_apart`], or that reported by the first run.
    pub fn work(&self) -> Work {
        let first = self.repetitions.first().map(|r| r.work);
        self.counted_apart.or(first).unwrap_or_default()
    }

    /// Returns the samples of one run; 0 without one.
    pub fn samples(&self) -> u64 {
        self.repetitions.first().map_or(0, |r| r.samples)
    }

    /// Returns the worst status of a run; [`Status::Budget`] without a run.
    pub fn status(&self) -> Status {
        let has = |status| self.repetitions.iter().any(|r| r.status == status);
        match self.repetitions.len() {
            0 => Status::Budget,
            _ if has(Status::Diverged) => Status::Diverged,
            _ if has(Status::Floor) => Status::Floor,
            _ => Status::Ok,
        }
    }
}

/// The verdict on the measured order of convergence against theory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The 95 % interval overlaps the expected orders.
    AsExpected,
    /// The error decreases more slowly than theory predicts.
    TooSlow,
    /// It decreases faster: the theory does not fit the case.
    Steeper,
    /// The interval is wider than 0.5, or there are too few points above the floor.
    Unclear,
    /// There is no theoretical order of the method.
    NoTheory,
    /// Estimates were not finite.
    Diverged,
    /// It was not run.
    NotRun,
}

impl Verdict {
    /// Returns a word or two.
    pub const fn name(self) -> &'static str {
        match self {
            Self::AsExpected => "expected",
            Self::TooSlow => "too slow",
            Self::Steeper => "steeper",
            Self::Unclear => "unclear",
            Self::NoTheory => "no theory",
            Self::Diverged => "diverged",
            Self::NotRun => "not run",
        }
    }
}

/// The speed-up of one backend over another, at the largest value of the knob that both ran.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speedup {
    /// The geometric mean of the ratios round by round.
    pub ratio: f64,
    /// The lower end of its 95 % interval, by Student's t of the logarithms.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Speedup {
    /// Computes the speed-up from pairs of times, the base's first. `None` for fewer than two.
    pub fn of(pairs: &[(f64, f64)]) -> Option<Self> {
        let logs: Vec<f64> =
            pairs.iter().filter(|p| p.0 > 0.0 && p.1 > 0.0).map(|p| (p.0 / p.1).ln()).collect();
        let n = logs.len();
        if n < 2 {
            return None;
        }
        let mean = logs.iter().sum::<f64>() / n as f64;
        let squares: f64 = logs.iter().map(|x| (x - mean).powi(2)).sum();
        let half = student_t(n - 1) * (squares / (n - 1) as f64 / n as f64).sqrt();
        let [ratio, low, high] = [mean, mean - half, mean + half].map(f64::exp);
        Some(Self { ratio, low, high })
    }

    /// Returns whether it is significant: the interval does not contain 1.
    pub fn is_claimed(&self) -> bool {
        self.low > 1.0 || self.high < 1.0
    }
}

/// One method on one backend: error over knob and time.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The method.
    pub method: Method,
    /// The backend.
    pub backend: Backend,
    /// The theoretical order.
    pub expected: Option<Order>,
    /// A point for each value of the knob.
    pub points: Vec<Point>,
    /// The fitted order.
    pub fit: Option<Fit>,
    /// The speed-up over the first backend of the same method.
    pub speedup: Option<Speedup>,
    /// The reason why it was not run, if it was not.
    pub missing: Option<Missing>,
    /// Seconds of the run before all others, with the first value of the knob: it warms caches and
    /// compiles pipelines, and is used for nothing else.
    pub first_run: Option<f64>,
    /// Seconds of [`Self::first_run`] spent on compiling WGSL for the device, by
    /// `gpu::Context::compile_time`. 0 on the CPU, whose variants are compiled by rustc, and where
    /// an earlier curve had the same text. `None` without a run.
    pub compile: Option<f64>,
    /// A hash of the WGSL of the kernels, on every backend: FNV-1a, 64 bits. `None` if
    /// [`Run`](super::Run) ran no kernel.
    pub code: Option<u64>,
}

impl Curve {
    /// Creates a curve without points.
    pub(super) fn new(method: Method, backend: Backend, expected: Option<Order>) -> Self {
        Self {
            method,
            backend,
            expected,
            points: Vec::new(),
            fit: None,
            speedup: None,
            missing: None,
            first_run: None,
            compile: None,
            code: None,
        }
    }

    /// Returns the points (x, error) with a finite error, ordered by x.
    fn errors(&self, x: impl Fn(&Point) -> f64) -> Vec<(f64, f64)> {
        let ran = self.points.iter().filter(|p| p.rmse().is_finite());
        let mut points: Vec<_> = ran.map(|p| (x(p), p.rmse())).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    /// Returns the median time, in seconds, after which the error is no larger than `limit`.
    pub fn time_to_error(&self, limit: f64) -> Reached {
        first_below(&self.errors(Point::t_median), limit)
    }

    /// Returns the error after this many seconds.
    pub fn error_at_time(&self, seconds: f64) -> Reached {
        value_at(&self.errors(Point::t_median), seconds)
    }

    /// Fits the order to all repetitions of the valid points. A point with a run at the floor is
    /// omitted as a whole: the runs that happen to lie above it would make the curve look flatter.
    pub(super) fn fit(&mut self) {
        let all = |point: &Point| {
            let knob = f64::from(point.knob);
            point.repetitions.iter().map(|r| (knob, r.metrics.rmse)).collect::<Vec<_>>()
        };
        let good = self.points.iter().filter(|p| p.status() == Status::Ok);
        let points: Vec<_> = good.flat_map(all).collect();
        self.fit = Fit::of(&points);
    }

    /// Returns the verdict on the fitted order against theory's.
    pub fn verdict(&self) -> Verdict {
        let is = |status| self.points.iter().any(|p| p.status() == status);
        if self.missing.is_some() {
            return Verdict::NotRun;
        }
        if is(Status::Diverged) {
            return Verdict::Diverged;
        }
        match (self.fit, self.expected) {
            (_, None) => Verdict::NoTheory,
            (None, _) => Verdict::Unclear,
            (Some(fit), _) if fit.high - fit.low > 0.5 => Verdict::Unclear,
            (Some(fit), Some(order)) if fit.low > order.flattest => Verdict::TooSlow,
            (Some(fit), Some(order)) if fit.high < order.steepest => Verdict::Steeper,
            _ => Verdict::AsExpected,
        }
    }
}

/// Returns the quantile `share`, interpolated linearly between neighbours (Hyndman and Fan, "Sample
/// Quantiles in Statistical Packages", 1996, definition 7); NaN of an empty set.
pub(super) fn quantile(numbers: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut sorted: Vec<f64> = numbers.collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share.clamp(0.0, 1.0) * last as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    if below == above { below } else { below + (above - below) * place.fract() }
}

/// Returns the rounding error of `f32` in an estimate of this reference: one rounding of the result
/// and one of the running mean, 2^-24 each, of the root of its mean square.
pub(super) fn rounding_floor(reference: &Reference) -> f64 {
    reference.size() * f64::from(f32::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;
    use raydsl::kernel::Variant;
    use raydsl::sampling::SampleMethod;

    fn point(knob: u32, rmse: f64, status: Status) -> Point {
        let metrics = Metrics { mse: rmse * rmse, rmse, ..Metrics::default() };
        let seconds = f64::from(knob) * 1e-3;
        let repetition = Repetition {
            seed: 0,
            seconds,
            cpu_seconds: None,
            #[cfg(feature = "flip")]
            flip: None,
            #[cfg(feature = "flip")]
            hdr_flip: None,
            samples: u64::from(knob),
            counted: None,
            work: Work::default(),
            metrics,
            status,
            values: Vec::new(),
        };
        Point { repetitions: vec![repetition], ..Point::new(knob) }
    }

    fn curve(points: Vec<Point>, expected: Option<Order>) -> Curve {
        let scalar = Backend::Variant(Variant::Scalar);
        let mut curve = Curve::new(SampleMethod::Random.into(), scalar, expected);
        curve.points = points;
        curve.fit();
        curve
    }

    #[test]
    fn quantiles_lie_between_neighbours() {
        let of = |share| quantile([3.0, 1.0, 2.0, 5.0, 4.0].into_iter(), share);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(of(0.1), 1.4);
        close(of(0.5), 3.0);
        close(of(0.9), 4.6);
        assert_eq!((of(-1.0), of(0.0), of(1.0), of(2.0)), (1.0, 1.0, 5.0, 5.0));
        assert_eq!(quantile([7.0].into_iter(), 0.9), 7.0);
        assert!(quantile([].into_iter(), 0.5).is_nan());
    }

    /// Tests three runs, the third of which gave no number: it has a time, and no error.
    #[test]
    fn quantiles_of_a_point() {
        let mut all = point(8, 0.5, Status::Ok);
        let run = |seconds, rmse, status| {
            let mut run = all.repetitions[0].clone();
            (run.seconds, run.metrics.rmse, run.status) = (seconds, rmse, status);
            run
        };
        all.repetitions = vec![
            run(1.0, 0.5, Status::Ok),
            run(2.0, 0.25, Status::Floor),
            run(9.0, f64::NAN, Status::Diverged),
        ];
        assert_eq!((all.t_quantile(0.5), all.t_quantile(1.0)), (2.0, 9.0));
        assert_eq!((all.rmse_quantile(0.5), all.rmse_quantile(1.0)), (0.375, 0.5));
    }

    /// Tests mean squares of -1, 2 and 5: their mean is 2; with the first clamped at 0 it would be
    /// 7/3.
    #[test]
    fn squares_are_cut_off_once() {
        let mut all = point(8, 1.0, Status::Ok);
        let run = |mse| {
            let mut run = all.repetitions[0].clone();
            (run.metrics.mse, run.metrics.rmse) = (mse, root(mse));
            run
        };
        all.repetitions = [-1.0, 2.0, 5.0].map(run).to_vec();
        assert_eq!(all.rmse(), 2.0f64.sqrt());
        // The standard error is sqrt(3), and 2 - 4.303 sqrt(3) is below 0.
        let [low, high] = all.rmse_interval().expect("three runs");
        assert_eq!(low, 0.0);
        assert!((high - (2.0 + 4.303 * 3.0f64.sqrt()).sqrt()).abs() < 1e-3, "{high}");
        all.repetitions.truncate(1);
        assert_eq!((all.rmse(), all.rmse_interval()), (0.0, None));
    }

    #[test]
    fn what_is_counted_apart_comes_first() {
        let mut one = point(8, 0.5, Status::Ok);
        one.repetitions[0].work.rays = Some(7);
        assert_eq!(one.work().rays, Some(7));
        one.counted_apart = Some(Work { nodes: Some(3), ..Work::default() });
        assert_eq!((one.work().rays, one.work().nodes), (None, Some(3)));
    }

    /// Returns errors of order -1 that stop decreasing at 1e-3.
    fn with_floor(status: Status) -> Vec<Point> {
        let law = |i: u32| {
            let error = (1.0 / f64::from(1u32 << i)).max(1e-3);
            point(1 << i, error, if error > 1e-3 { Status::Ok } else { status })
        };
        (3..16).map(law).collect()
    }

    #[test]
    fn what_lies_at_the_floor_is_not_fitted() {
        let fit = curve(with_floor(Status::Floor), None).fit.expect("seven points");
        assert!((fit.order + 1.0).abs() < 1e-12 && fit.points == 7, "{fit:?}");
        let bent = curve(with_floor(Status::Ok), None).fit.expect("thirteen points");
        assert!(bent.order > -0.85 && bent.points == 13, "{bent:?}");
    }

    /// Tests a last point with one run above the floor, three times as high as the curve.
    #[test]
    fn a_point_that_touches_the_floor_is_not_fitted() {
        let mut points: Vec<_> =
            (3..8).map(|i| point(1 << i, 0.5f64.powi(i), Status::Ok)).collect();
        let mut above = points[4].repetitions[0].clone();
        above.metrics.rmse *= 3.0;
        points[4].repetitions[0].status = Status::Floor;
        points[4].repetitions.push(above);
        let fit = curve(points, None).fit.expect("four points");
        assert!((fit.order + 1.0).abs() < 1e-12 && fit.points == 4, "{fit:?}");
    }

    #[test]
    fn verdicts() {
        let points = || with_floor(Status::Floor);
        let of = |order| curve(points(), Some(order)).verdict();
        assert_eq!(of(Order::near(-1.0, 0.05)), Verdict::AsExpected);
        assert_eq!(of(Order::at_most(-0.7)), Verdict::AsExpected);
        assert_eq!(of(Order::at_most(-1.2)), Verdict::TooSlow);
        assert_eq!(of(Order::RANDOM), Verdict::Steeper);
        assert_eq!(curve(points(), None).verdict(), Verdict::NoTheory);
        let few = curve(points()[..2].to_vec(), Some(Order::RANDOM));
        assert_eq!(few.verdict(), Verdict::Unclear);
        let mut bad = points();
        bad[12].repetitions[0].status = Status::Diverged;
        assert_eq!(curve(bad, Some(Order::RANDOM)).verdict(), Verdict::Diverged);
        let mut missing = curve(points(), Some(Order::RANDOM));
        missing.missing = Some(Missing::NoDevice("none".to_owned()));
        assert_eq!(missing.verdict(), Verdict::NotRun);
    }

    #[test]
    fn a_speed_up_is_claimed_only_if_it_is_one() {
        let clear = Speedup::of(&[(4.0, 2.0), (4.1, 2.0), (3.9, 2.0), (4.0, 2.1)]);
        let clear = clear.expect("four pairs");
        assert!(clear.is_claimed() && (clear.ratio - 1.97).abs() < 0.02, "{clear:?}");
        let noise = Speedup::of(&[(1.0, 2.0), (2.0, 1.0), (1.5, 1.2)]).expect("three pairs");
        assert!(!noise.is_claimed() && noise.low < 1.0 && noise.high > 1.0, "{noise:?}");
        assert_eq!(Speedup::of(&[(1.0, 2.0)]), None);
    }

    #[test]
    fn a_point_without_a_run_is_out_of_budget() {
        let none = Point::new(1);
        assert_eq!(none.status(), Status::Budget);
        assert!(none.rmse().is_nan() && none.t_quantile(0.9).is_nan());
        assert!(none.efficiency().is_none() && none.work().is_empty());
        let curve = curve(vec![point(4, 0.5, Status::Ok), none], None);
        assert_eq!(curve.time_to_error(0.5), Reached::AtMost(0.004));
        assert_eq!(curve.time_to_error(0.1), Reached::Never);
        assert_eq!(curve.error_at_time(1.0), Reached::AtMost(0.5));
    }
}
