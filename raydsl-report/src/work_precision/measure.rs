//! Measurement of the runs.

use std::time::{Duration, Instant};

use super::case::{Backend, Case};
use super::cpu_clock::CpuClock;
use super::curve::{Curve, Point, Repetition, Speedup, Status, rounding_floor};
use super::metrics::Metrics;
use super::run::{CodeHash, Run};
use super::{Measured, WorkPrecision, WorkPrecisionError};
use crate::Missing;
#[cfg(feature = "gpu")]
use raydsl::gpu::GpuScheduler;

/// A curve being measured.
struct Series {
    curve: Curve,
    /// Seconds of its runs so far.
    spent: f64,
    /// The knob's value and the seconds of the last run.
    last: Option<(u32, f64)>,
}

impl Series {
    /// Returns whether a run at `knob` is likely to end within `share` seconds in all.
    fn may_run(&self, knob: u32, share: f64) -> bool {
        let Some((last, seconds)) = self.last else { return true };
        self.spent + seconds * f64::from(knob) / f64::from(last) <= share
    }
}

impl WorkPrecision<'_> {
    pub(super) fn measure(
        &mut self,
        case: &Case<'_>,
        #[cfg(feature = "gpu")] gpu: Option<&GpuScheduler>,
    ) -> Result<Measured, WorkPrecisionError> {
        let runner = Runner {
            case,
            size: self.size,
            floor: rounding_floor(&case.reference),
            #[cfg(feature = "gpu")]
            gpu,
        };
        let mut all = self.series(case);
        let knobs = self.knobs_of(case).to_vec();
        (self.progress)(&format!("{}: warm-up", case.name));
        for series in &mut all {
            runner.warm_up(&mut series.curve, knobs[0])?;
        }
        let points = || knobs.iter().map(|k| Point::new(*k)).collect();
        all.iter_mut().for_each(|s| s.curve.points = points());
        let ready = all.iter().filter(|s| s.curve.missing.is_none()).count();
        let share = self.time.as_secs_f64() / ready.max(1) as f64;
        for seed in 0..self.repetitions {
            (self.progress)(&format!("{}: {} of {}", case.name, seed + 1, self.repetitions));
            for (i, knob) in knobs.iter().enumerate() {
                for series in all.iter_mut().filter(|s| s.curve.missing.is_none()) {
                    if series.may_run(*knob, share) {
                        runner.add(series, i, seed)?;
                    }
                }
            }
        }
        let mut curves: Vec<Curve> = all.into_iter().map(|s| s.curve).collect();
        curves.iter_mut().for_each(Curve::fit);
        compare_with_f64(&mut curves);
        compare_with_first(&mut curves, self.backends[0]);
        runner.count(&mut curves);
        let others = case.methods.iter().filter(|(m, _)| !self.is_chosen(m));
        Ok(Measured {
            name: case.name.clone(),
            family: case.family.clone(),
            knob: case.knob.clone(),
            kind: case.reference.kind(),
            uncertainty: case.reference.uncertainty(),
            rounding_floor: runner.floor,
            build: case.build.map(|time| time.as_secs_f64()),
            curves,
            not_asked_for: others.map(|(m, _)| m.name.clone()).collect(),
        })
    }

    /// Returns a curve for each method and backend, without points.
    fn series(&self, case: &Case<'_>) -> Vec<Series> {
        let chosen = case.methods.iter().filter(|(m, _)| self.is_chosen(m));
        let of_method = |(method, expected): &(super::Method, Option<super::Order>)| {
            let curve = |backend: &Backend| Curve::new(method.clone(), *backend, *expected);
            let series = |b| Series { curve: curve(b), spent: 0.0, last: None };
            self.backends.iter().map(series).collect::<Vec<_>>()
        };
        chosen.flat_map(of_method).collect()
    }
}

/// The case with the device that runs it.
struct Runner<'r, 'c> {
    case: &'r Case<'c>,
    size: (u32, u32),
    floor: f64,
    #[cfg(feature = "gpu")]
    gpu: Option<&'r GpuScheduler>,
}

impl Runner<'_, '_> {
    /// Runs a curve once before all others, at the first value of the knob.
    fn warm_up(&self, curve: &mut Curve, knob: u32) -> Result<(), WorkPrecisionError> {
        let (code, before) = (CodeHash::default(), self.compile_time());
        match self.once(&self.run(curve, knob, 0, Some(&code)))? {
            Ok(first) => {
                curve.first_run = Some(first.seconds);
                curve.compile = Some((self.compile_time() - before).as_secs_f64());
            }
            Err(missing) => curve.missing = Some(missing),
        }
        curve.code = code.hash();
        Ok(())
    }

    /// Returns the compilation time of the device's pipelines so far.
    fn compile_time(&self) -> Duration {
        #[cfg(feature = "gpu")]
        return self.gpu.map_or(Duration::ZERO, |gpu| gpu.context().compile_time());
        #[cfg(not(feature = "gpu"))]
        Duration::ZERO
    }

    /// Counts the work of each method's runs separately. All backends take the same samples.
    fn count(&self, curves: &mut [Curve]) {
        let Some(count) = &self.case.count else { return };
        for i in 0..curves.len() {
            for k in 0..curves[i].points.len() {
                if curves[i].points[k].repetitions.is_empty() {
                    continue;
                }
                let same = curves[..i].iter().find(|c| c.method == curves[i].method);
                let known = same.and_then(|c| c.points[k].counted_apart);
                let knob = curves[i].points[k].knob;
                let work = known.unwrap_or_else(|| count(&self.run(&curves[i], knob, 0, None)));
                curves[i].points[k].counted_apart = Some(work);
            }
        }
    }

    fn run<'a>(
        &'a self,
        curve: &'a Curve,
        knob: u32,
        seed: u32,
        code: Option<&'a CodeHash>,
    ) -> Run<'a> {
        Run {
            method: &curve.method,
            backend: curve.backend,
            knob,
            samples: None,
            seed,
            size: self.size,
            code,
            #[cfg(feature = "gpu")]
            gpu: self.gpu,
        }
    }

    /// Adds a run to point `i`.
    fn add(&self, series: &mut Series, i: usize, seed: u32) -> Result<(), WorkPrecisionError> {
        let knob = series.curve.points[i].knob;
        match self.once(&self.run(&series.curve, knob, seed, None))? {
            Ok(repetition) => {
                series.spent += repetition.seconds;
                series.last = Some((knob, repetition.seconds));
                series.curve.points[i].repetitions.push(repetition);
            }
            Err(missing) => series.curve.missing = Some(missing),
        }
        Ok(())
    }

    /// Runs the case once, timed.
    fn once(&self, run: &Run<'_>) -> Result<Result<Repetition, Missing>, WorkPrecisionError> {
        let cpu = CpuClock::start();
        let start = Instant::now();
        let estimates = match self.case.estimate(run) {
            Ok(estimates) => estimates,
            Err(missing) => return Ok(Err(missing)),
        };
        let (took, cpu_seconds) = (start.elapsed(), cpu.seconds());
        let took = took.saturating_sub(run.code.map_or(Duration::ZERO, CodeHash::took));
        let took = took.max(Duration::from_nanos(1));
        let (case, reference) = (self.case, &self.case.reference);
        if !reference.fits(estimates.values.len()) {
            return Err(WorkPrecisionError::Length {
                case: case.name.clone(),
                method: run.method.name.clone(),
                knob: run.knob,
                found: estimates.values.len(),
                expected: reference.len(),
            });
        }
        let metrics = Metrics::of(&estimates.values, reference);
        #[cfg(feature = "flip")]
        let (flip, hdr_flip) = super::flip::of_picture(&estimates, reference).unzip();
        Ok(Ok(Repetition {
            seed: run.seed,
            seconds: took.as_secs_f64(),
            cpu_seconds,
            samples: estimates.samples,
            counted: estimates.counted,
            work: estimates.work,
            metrics,
            #[cfg(feature = "flip")]
            flip,
            #[cfg(feature = "flip")]
            hdr_flip,
            status: self.status(run.backend, &metrics),
            values: estimates.values,
        }))
    }

    fn status(&self, backend: Backend, metrics: &Metrics) -> Status {
        let rounding = match backend {
            Backend::F64 => 0.0,
            Backend::Variant(_) => self.floor,
        };
        if metrics.is_diverged() {
            Status::Diverged
        } else if metrics.rmse <= rounding.max(self.case.reference.uncertainty()) {
            Status::Floor
        } else {
            Status::Ok
        }
    }
}

/// Sets the distance of every point from the same samples in `f64`.
fn compare_with_f64(curves: &mut [Curve]) {
    let exact: Vec<Curve> = curves.iter().filter(|c| c.backend == Backend::F64).cloned().collect();
    for curve in curves.iter_mut().filter(|c| c.backend != Backend::F64) {
        let Some(exact) = exact.iter().find(|e| e.method == curve.method) else { continue };
        for (point, exact) in curve.points.iter_mut().zip(&exact.points) {
            point.rounding = distance(point, exact);
        }
    }
}

/// Returns the root of the mean square difference over the seeds that both have.
fn distance(a: &Point, b: &Point) -> Option<f64> {
    let same = |r: &Repetition| b.repetitions.iter().find(|s| s.seed == r.seed).cloned();
    let pairs = a.repetitions.iter().filter_map(|r| same(r).map(|s| (r, s)));
    let squares: Vec<f64> = pairs
        .flat_map(|(r, s)| {
            r.values.iter().zip(&s.values).map(|(x, y)| (x - y).powi(2)).collect::<Vec<_>>()
        })
        .collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (!squares.is_empty()).then(|| mean.sqrt())
}

/// Sets the speed-ups over the curve of the same method on `first`.
fn compare_with_first(curves: &mut [Curve], first: Backend) {
    let bases: Vec<Curve> = curves.iter().filter(|c| c.backend == first).cloned().collect();
    for curve in curves.iter_mut().filter(|c| c.backend != first) {
        let base = bases.iter().find(|b| b.method == curve.method);
        curve.speedup = base.and_then(|base| {
            let both = base.points.iter().zip(&curve.points).rev();
            both.map(|(b, p)| times(b, p)).find(|t| t.len() > 1).and_then(|t| Speedup::of(&t))
        });
    }
}

/// Returns the times of the rounds that both ran.
fn times(base: &Point, point: &Point) -> Vec<(f64, f64)> {
    let other = |r: &Repetition| point.repetitions.iter().find(|s| s.seed == r.seed);
    let pair = |r: &Repetition| other(r).map(|s| (r.seconds, s.seconds));
    base.repetitions.iter().filter_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_is_likely_too_long_is_not_begun() {
        let curve = Curve::new("m".into(), Backend::F64, None);
        let mut series = Series { curve, spent: 0.0, last: None };
        assert!(series.may_run(1 << 20, 0.0), "the first point is always run");
        (series.spent, series.last) = (1.0, Some((4, 0.5)));
        assert!(series.may_run(8, 2.0) && !series.may_run(16, 2.0));
    }
}
