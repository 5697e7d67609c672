//! Pilot stages, and stages of fresh samples in the number that the pilots choose.

use core::ops::ControlFlow;
use std::time::Duration;

use glam::UVec4;

use super::replications::{Replications, is_complete};
use super::shares::Shares;
use super::{Estimate, Outcome, Progress, ProgressObserver, REPLICATIONS, Reached, Until};
use crate::render::Sampling;
use crate::render::allocation::Allocation;
use crate::render::renderer::Samples;
use crate::render::store::Store;
use crate::render::watch::Observer;
use crate::run::clock::Instant;
use crate::sampling::pcg4d;

/// The growth of stages up to the pilot. The first has one sample per replication, so that there is
/// a picture soon.
const RAMP: u32 = 8;
/// The maximum growth of fresh samples from one stage to the next, which does not predict the
/// error's decrease beyond that.
const GROWTH: f64 = 4.0;
/// The targeted share of the tolerance.
const AIM: f64 = 0.8;
/// The share of the error probability (1 - confidence) for the first stage that may end the run;
/// each further one has half of the rest.
const FIRST_SHARE: f64 = 0.8;

/// The reciprocal of the largest part of a time budget that is reserved for the work after the last
/// sample.
const MOST_FOR_END: u32 = 10;

/// Adds samples to an empty film. The observer may stop it.
pub(crate) trait Accumulate {
    /// The error of a failed run.
    type Error;

    /// Adds `samples` to `film`.
    fn accumulate(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Store,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<()>, Self::Error>;
}

/// A stage: replications with samples that no other stage has.
#[derive(Clone, Copy)]
struct Plan {
    /// Samples per pixel of a replication.
    each: u32,
    /// The share of the error probability for its estimate, if it may end the run.
    doubt: Option<f64>,
}

/// The result of a stage.
struct Stage {
    /// Whether all its replications are complete and it is the best so far.
    is_best: bool,
    /// The outcome that ended the run, if any.
    cut: Option<Outcome>,
}

/// Renders into `film` until the target is reached. `until` has been checked.
pub(crate) fn run<R: Accumulate>(
    until: &Until,
    sampling: &Sampling,
    film: &mut Store,
    observer: ProgressObserver<'_>,
    renderer: &mut R,
) -> Result<Reached, R::Error> {
    let size = (film.width(), film.height());
    let begin = Instant::now();
    let best = Replications::none(0);
    let mut run = Run {
        until,
        sampling,
        size,
        empty: film.cleared(),
        begin,
        observer,
        best,
        shares: None,
        spent: 0,
        stages: 0,
        looked: begin,
        between: Duration::ZERO,
    };
    let end = run.stages(renderer);
    let (spent, best) = (run.spent_each(), run.best);
    let samples = best.samples();
    // The best picture so far is kept even after an error.
    match best.into_film() {
        Some(best) => *film = best,
        None if film.samples() > 0 => film.clear(),
        None => {}
    }
    let (outcome, estimate) = end?;
    Ok(Reached {
        outcome,
        estimate,
        samples,
        spent,
        elapsed: begin.elapsed(),
        nan_pixels: film.nan_pixels(),
    })
}

struct Run<'a> {
    until: &'a Until,
    sampling: &'a Sampling,
    /// Columns and rows.
    size: (u32, u32),
    /// A film without samples.
    empty: Store,
    begin: Instant,
    observer: ProgressObserver<'a>,
    /// The stage with the smallest expected error.
    best: Replications,
    /// The allocation of the next stage's samples to the blocks of the film.
    shares: Option<Shares>,
    /// Samples of all pixels taken.
    spent: u64,
    stages: u32,
    /// The time of the last look at the clock.
    looked: Instant,
    /// The time without a look at the clock between the last two replications: the run may take
    /// as long to end.
    between: Duration,
}

impl Run<'_> {
    fn stages<R: Accumulate>(&mut self, renderer: &mut R) -> Result<(Outcome, Estimate), R::Error> {
        let period = self.sampling.pixels.period();
        let pilot = self.until.target.pilot.div_ceil(REPLICATIONS).next_multiple_of(period);
        let mut plan = Plan { each: period, doubt: None };
        let mut left = 1.0;
        loop {
            let Stage { is_best, cut } = self.stage(plan, renderer)?;
            let doubt = plan.doubt.filter(|_| is_best);
            let (error, floor) = self.estimate(doubt);
            if self.best.each >= pilot && self.tolerance() < 2.0 * floor {
                let floor = self.until.target.metric.of_root(floor);
                return Ok((Outcome::Unresolvable { floor }, self.reported(error)));
            }
            if doubt.is_some() && error.high <= self.tolerance() {
                return Ok((Outcome::Converged, self.reported(error)));
            }
            if let Some(outcome) = cut {
                return Ok((outcome, self.reported(error)));
            }
            if self.until.adaptive && is_best && self.best.each >= pilot {
                self.shares = Shares::of(&self.best, self.until.target.metric, self.size.0);
            }
            plan = self.next(plan, pilot, error.high - floor, floor, &mut left);
        }
    }

    /// Returns the tolerance, as a root of a mean square.
    fn tolerance(&self) -> f64 {
        let target = self.until.target;
        target.metric.root(target.tolerance)
    }

    /// Returns the error of the best picture, at the share of the error probability `doubt`, if it
    /// may end the run.
    fn estimate(&self, doubt: Option<f64>) -> (Estimate, f64) {
        let target = self.until.target;
        let share = doubt.unwrap_or(1.0);
        self.best.estimate(target.metric, 1.0 - (1.0 - target.confidence) * share)
    }

    /// Converts an estimate to the metric's unit.
    fn reported(&self, root: Estimate) -> Estimate {
        let of = |v: f64| self.until.target.metric.of_root(v);
        Estimate { error: of(root.error), low: of(root.low), high: of(root.high) }
    }

    /// Returns the stage after one whose error is at most `high`. Its samples made this choice, so
    /// they do not count for the next.
    fn next(&self, last: Plan, pilot: u32, high: f64, floor: f64, left: &mut f64) -> Plan {
        if last.each < pilot {
            return Plan { each: last.each.saturating_mul(RAMP).min(pilot), doubt: None };
        }
        let ratio = high / (AIM * (self.tolerance() - floor));
        // Errors of independent samples decrease with the root of their number; others decrease
        // faster.
        let need = ratio * ratio * self.shares.as_ref().map_or(1.0, |shares| shares.gain);
        // If the last stage was planned to suffice and did not, more samples are needed.
        let least = if last.doubt.is_some() { 2.0 } else { 1.0 };
        let times = need.ceil().clamp(least, GROWTH) as u32;
        let doubt = (need <= GROWTH).then(|| {
            let share = if *left == 1.0 { FIRST_SHARE } else { 0.5 };
            let doubt = *left * share;
            *left -= doubt;
            doubt
        });
        Plan { each: last.each.saturating_mul(times), doubt }
    }

    /// Renders the replications of a stage, as far as the budget allows.
    fn stage<R: Accumulate>(&mut self, plan: Plan, renderer: &mut R) -> Result<Stage, R::Error> {
        let affordable = self.until.budget.samples.saturating_sub(self.spent_each()) / REPLICATIONS;
        // Half a period of fixed positions would weight some parts of a pixel more than others.
        let period = self.sampling.pixels.period();
        let affordable = affordable - affordable % period;
        if affordable == 0 {
            return Ok(Stage { is_best: false, cut: Some(Outcome::OutOfSamples) });
        }
        let each = plan.each.min(affordable);
        let allocation = self.shares.as_ref().map(|shares| shares.allocation(each, period));
        let most = allocation.as_ref().map_or(each, Allocation::most);
        let mut stage = Replications::none(each);
        let mut cut = None;
        let mut end = Ok(());
        for replication in 0..REPLICATIONS {
            let mut one = self.empty.clone();
            let sampling = self.sampling_of(replication, each);
            let allocation = allocation.as_ref();
            let samples = Samples { sampling: &sampling, each: most, allocation };
            let replicated = self.replication(&samples, &mut one, &stage, renderer);
            self.spent += one.total_samples();
            match replicated {
                Ok((is_whole, ended)) => {
                    cut = ended;
                    if is_whole {
                        stage.join(one);
                    }
                }
                Err(error) => end = Err(error),
            }
            if cut.is_some() || end.is_err() {
                break;
            }
        }
        self.stages += 1;
        let (is_short, is_complete) = (each < plan.each, is_complete(&stage));
        let is_better = self.is_better(&stage) || is_complete && !is_short;
        if is_better {
            self.best = stage;
        }
        end?;
        let cut = cut.or_else(|| is_short.then_some(Outcome::OutOfSamples));
        Ok(Stage { is_best: is_better && is_complete, cut })
    }

    fn pixels(&self) -> u64 {
        u64::from(self.size.0) * u64::from(self.size.1)
    }

    /// Returns the samples per pixel taken in all, on average.
    fn spent_each(&self) -> u32 {
        u32::try_from(self.spent.div_ceil(self.pixels())).unwrap_or(u32::MAX)
    }

    /// Returns whether the expected error of a stage is smaller than that of the best one. The
    /// estimated error is not used: that would bias the choice.
    fn is_better(&self, stage: &Replications) -> bool {
        let confidence = self.until.target.confidence;
        stage.expected(confidence) < self.best.expected(confidence)
    }

    /// Returns the sampling of a replication, different for each replication of each stage.
    fn sampling_of(&self, replication: u32, planned: u32) -> Sampling {
        let key = UVec4::new(self.sampling.seed, self.stages, replication, 0x0075_6e74);
        Sampling { seed: pcg4d(key).x, planned, ..*self.sampling }
    }

    /// Renders one replication, checking the clock and asking the observer meanwhile. Returns
    /// whether it is complete, and the outcome that ended the run, if any: there may be both.
    fn replication<R: Accumulate>(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Store,
        stage: &Replications,
        renderer: &mut R,
    ) -> Result<(bool, Option<Outcome>), R::Error> {
        let shown = if self.is_better(stage) { stage } else { &self.best };
        let target = self.until.target;
        let (estimate, _) = shown.estimate(target.metric, target.confidence);
        let (best, spent) = (shown.samples(), self.spent_each());
        let estimate = self.reported(estimate);
        let (begin, time) = (self.begin, self.until.budget.time);
        let mut is_first = true;
        let mut cut = None;
        let mut watch = |share: f64| {
            let (now, last) = (Instant::now(), self.looked);
            self.looked = now;
            if is_first {
                self.between = (now - last).min(time / MOST_FOR_END);
                is_first = false;
            }
            let elapsed = now - begin;
            let time_left = time.saturating_sub(elapsed);
            let spent = spent + (share * f64::from(stage.each)) as u32;
            let progress = Progress { estimate, samples: best, spent, elapsed, time_left };
            if time_left <= self.between {
                cut = Some(Outcome::OutOfTime);
            } else if (self.observer)(&progress).is_break() {
                cut = Some(Outcome::Stopped);
            }
            if cut.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let end = renderer.accumulate(samples, film, &mut watch)?;
        Ok((end.is_continue(), cut))
    }
}
