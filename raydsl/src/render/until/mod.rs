//! Samples until an error is reached, or a budget is spent.

mod quantile;
mod replications;
mod run;
mod shares;

use core::ops::ControlFlow;
use std::time::Duration;

pub(crate) use run::{Accumulate, run};

use super::{Film, Sampling};

/// Independent replications of each estimate: the error is told by how far they lie apart.
pub const REPLICATIONS: u32 = 8;

/// How the error of a film is measured. Red, green and blue count, alpha does not.
///
/// Errors are distances from what infinitely many samples would give.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Metric {
    /// The root of the mean squared error, over all pixels and channels.
    #[default]
    Rmse,
    /// The mean of `error^2 / (value^2 + 0.01)`, over all pixels and channels: 1e-4 is about 1 %.
    RelMse,
    /// The error of the mean of the whole picture: of a measurement, where pixels do not matter.
    Mean,
}

impl Metric {
    /// The metric of a root of a mean square, and the root that a metric is of.
    fn of_root(self, root: f64) -> f64 {
        if self == Self::RelMse { root * root } else { root }
    }

    fn root(self, error: f64) -> f64 {
        if self == Self::RelMse { error.sqrt() } else { error }
    }
}

/// The error that is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// How it is measured.
    pub metric: Metric,
    /// What it must not exceed: above 0, in the metric's unit.
    pub tolerance: f64,
    /// How sure that must be: from 0.5 to 0.9999.
    pub confidence: f64,
    /// Samples a pixel of the pilot, from which the number of samples is chosen, and the least
    /// number of those that count: at least 1. What fewer than ten of them meet in the whole
    /// picture may be overlooked.
    pub pilot: u32,
}

impl Target {
    /// With a confidence of 95 % and a pilot of 1024 samples a pixel.
    pub const fn new(metric: Metric, tolerance: f64) -> Self {
        Self { metric, tolerance, confidence: 0.95, pilot: 1024 }
    }

    /// How sure it must be.
    #[must_use]
    pub const fn confidence(self, confidence: f64) -> Self {
        Self { confidence, ..self }
    }

    /// Samples a pixel of the pilot. Few are enough where many pixels have about the same variance;
    /// a single pixel that is rarely bright needs many.
    #[must_use]
    pub const fn pilot(self, samples: u32) -> Self {
        Self { pilot: samples, ..self }
    }
}

/// What may be spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// By the clock. What the run seems to need after its last sample, at most a tenth, is kept
    /// for that: a run that is out of time may end as much earlier.
    pub time: Duration,
    /// Samples a pixel in all, those of pilots too; on the average where [`Until::adaptive`] has
    /// chosen them.
    pub samples: u32,
}

impl Budget {
    /// As much time as this, and any number of samples.
    pub const fn of_time(time: Duration) -> Self {
        Self { time, samples: u32::MAX }
    }

    /// As many samples of each pixel as these, however long they take.
    pub const fn of_samples(samples: u32) -> Self {
        Self { time: Duration::MAX, samples }
    }

    /// No more samples of each pixel than these.
    #[must_use]
    pub const fn samples(self, samples: u32) -> Self {
        Self { samples, ..self }
    }
}

/// An error to reach and what may be spent on it; see
/// [`Renderer::render_until`](super::Renderer::render_until).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// The error.
    pub target: Target,
    /// What may be spent.
    pub budget: Budget,
    /// Whether blocks of 16 by 16 pixels get samples as they need them; see [`Until::adaptive`].
    pub adaptive: bool,
}

impl Until {
    /// Until `target` is reached or `budget` is spent, with as many samples of one pixel as of
    /// another.
    pub const fn new(target: Target, budget: Budget) -> Self {
        Self { target, budget, adaptive: false }
    }

    /// Gives more samples to blocks of 16 by 16 pixels whose samples differ more: as many as make
    /// the error of the whole picture least (Neyman, "On the Two Different Aspects of the
    /// Representative Method", 1934, section III), but nowhere less than an eighth of the mean.
    /// The pilot tells where that is. [`Film::sample_counts`] has the numbers that it came to.
    #[must_use]
    pub const fn adaptive(self) -> Self {
        Self { adaptive: true, ..self }
    }

    /// Whether this can be asked of a film.
    pub(crate) fn check(&self, film: &Film, sampling: &Sampling) -> Result<(), UntilError> {
        let Self { target, budget, .. } = *self;
        if !(target.tolerance > 0.0 && target.tolerance.is_finite()) {
            return Err(UntilError::Tolerance { tolerance: target.tolerance });
        }
        if !(0.5..=0.9999).contains(&target.confidence) {
            return Err(UntilError::Confidence { confidence: target.confidence });
        }
        if target.pilot == 0 {
            return Err(UntilError::NoPilot);
        }
        if budget.time.is_zero() {
            return Err(UntilError::NoTime);
        }
        let needed = REPLICATIONS * sampling.pixels.period();
        if budget.samples < needed {
            return Err(UntilError::TooFewSamples { samples: budget.samples, needed });
        }
        if film.width() == 0 || film.height() == 0 {
            return Err(UntilError::NoPixels { width: film.width(), height: film.height() });
        }
        Ok(())
    }
}

/// Why an error cannot be asked for.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UntilError {
    /// The tolerance is no positive number.
    #[error("the tolerance is {tolerance}: give a number above 0")]
    Tolerance {
        /// What was given.
        tolerance: f64,
    },
    /// The confidence is out of range.
    #[error("the confidence is {confidence}: give a number from 0.5 to 0.9999, as 0.95")]
    Confidence {
        /// What was given.
        confidence: f64,
    },
    /// The pilot has no samples.
    #[error("the pilot has no samples: give it at least 1, as 1024")]
    NoPilot,
    /// There is no time.
    #[error("the budget has no time: give a duration above 0")]
    NoTime,
    /// There are fewer samples than replications.
    #[error(
        "the budget has {samples} samples a pixel but needs {needed}: one for each of \
         {REPLICATIONS} replications, and for each of the places in a pixel, if those are fixed"
    )]
    TooFewSamples {
        /// What was given.
        samples: u32,
        /// The least that there may be.
        needed: u32,
    },
    /// The film has no pixels.
    #[error("the film has {width} x {height} pixels: an error needs one at least")]
    NoPixels {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
}

impl From<core::convert::Infallible> for UntilError {
    fn from(never: core::convert::Infallible) -> Self {
        match never {}
    }
}

/// Why no more samples were taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The error is within the tolerance, as surely as asked.
    Converged,
    /// The time is spent.
    OutOfTime,
    /// The samples are spent.
    OutOfSamples,
    /// `f32` cannot hold colours that well, or no pixel is a number: no number of samples would do.
    Unresolvable {
        /// The least error that rounding leaves, in the metric's unit. A tolerance must be above
        /// twice that. What a kernel's own arithmetic rounds comes on top.
        floor: f64,
    },
    /// The observer wanted no more.
    Stopped,
}

/// An error, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The most likely size of the error; infinite before there are two replications.
    pub error: f64,
    /// It is at least this, with the target's confidence.
    pub low: f64,
    /// It is at most this, with the target's confidence.
    pub high: f64,
}

impl Estimate {
    /// Of nothing.
    pub(crate) const UNKNOWN: Self = Self { error: f64::INFINITY, low: 0.0, high: f64::INFINITY };
}

/// How far it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The error of the best picture so far.
    pub estimate: Estimate,
    /// Its samples a pixel, on the average.
    pub samples: u32,
    /// Samples a pixel that were taken in all, on the average.
    pub spent: u32,
    /// Since the beginning.
    pub elapsed: Duration,
    /// Of the budget's time.
    pub time_left: Duration,
}

/// What became of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// Why it ended.
    pub outcome: Outcome,
    /// The error of the picture in the film.
    pub estimate: Estimate,
    /// Samples a pixel of it, on the average; [`Film::sample_counts`] has those of each.
    pub samples: u32,
    /// Samples a pixel that were taken in all, those of pilots too, on the average.
    pub spent: u32,
    /// How long it took.
    pub elapsed: Duration,
    /// Pixels with a sample that was no number. They are not in the error.
    pub nan_pixels: usize,
}

/// Who is told how far it is, and says whether to go on.
pub type ProgressObserver<'a> = &'a mut (dyn FnMut(&Progress) -> ControlFlow<()> + Send);
