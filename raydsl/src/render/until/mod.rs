//! Rendering until a target error is reached, or a budget is spent.

mod quantile;
mod replications;
mod run;
mod shares;

use core::ops::ControlFlow;
use std::time::Duration;

pub(crate) use run::{Accumulate, run};

use super::Sampling;

/// The number of independent replications per estimate: their spread measures the error.
pub const REPLICATIONS: u32 = 8;

/// The error metric of a film. Red, green and blue count, alpha does not.
///
/// Errors are distances from the limit of infinitely many samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Metric {
    /// The root of the mean squared error, over all pixels and channels.
    #[default]
    Rmse,
    /// The mean of `error^2 / (value^2 + 0.01)`, over all pixels and channels: 1e-4 is about 1 %.
    RelMse,
    /// The error of the mean of the whole picture: for a measurement, where pixels do not matter.
    Mean,
}

impl Metric {
    /// Converts a root of a mean square to the metric, and the other way round.
    fn of_root(self, root: f64) -> f64 {
        if self == Self::RelMse { root * root } else { root }
    }

    fn root(self, error: f64) -> f64 {
        if self == Self::RelMse { error.sqrt() } else { error }
    }
}

/// The target error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The error metric.
    pub metric: Metric,
    /// The greatest error allowed: above 0, in the metric's unit.
    pub tolerance: f64,
    /// The confidence with which the error is below it: from 0.5 to 0.9999.
    pub confidence: f64,
    /// The pilot's samples per pixel, from which the number of samples is chosen, and the minimum
    /// of samples that count: at least 1. Events that fewer than ten of them find in the whole
    /// picture may be missed.
    pub pilot: u32,
}

impl Target {
    /// Creates a target with a confidence of 95 % and a pilot of 1024 samples per pixel.
    pub const fn new(metric: Metric, tolerance: f64) -> Self {
        Self { metric, tolerance, confidence: 0.95, pilot: 1024 }
    }

    /// Sets the confidence.
    #[must_use]
    pub const fn confidence(self, confidence: f64) -> Self {
        Self { confidence, ..self }
    }

    /// Sets the pilot's samples per pixel. Few suffice where many pixels have about the same
    /// variance; a single pixel that is rarely bright needs many.
    #[must_use]
    pub const fn pilot(self, samples: u32) -> Self {
        Self { pilot: samples, ..self }
    }
}

/// The limits on time and samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// The time limit. The estimated time after the last sample, at most a tenth, is reserved: a
    /// run that is out of time may end earlier by that much.
    pub time: Duration,
    /// Samples per pixel in all, including pilots; on average if [`Until::adaptive`] chose them.
    pub samples: u32,
}

impl Budget {
    /// Creates a budget of this time, and any number of samples.
    pub const fn of_time(time: Duration) -> Self {
        Self { time, samples: u32::MAX }
    }

    /// Creates a budget of this number of samples per pixel, without a time limit.
    pub const fn of_samples(samples: u32) -> Self {
        Self { time: Duration::MAX, samples }
    }

    /// Sets the maximum number of samples per pixel.
    #[must_use]
    pub const fn samples(self, samples: u32) -> Self {
        Self { samples, ..self }
    }
}

/// A target error and a budget; see [`Renderer::render_until`](super::Renderer::render_until).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// The target error.
    pub target: Target,
    /// The budget.
    pub budget: Budget,
    /// Whether samples are allocated to blocks of 16 by 16 pixels by need; see [`Until::adaptive`].
    pub adaptive: bool,
}

impl Until {
    /// Creates a run until `target` is reached or `budget` is spent, with the same number of
    /// samples in every pixel.
    pub const fn new(target: Target, budget: Budget) -> Self {
        Self { target, budget, adaptive: false }
    }

    /// Allocates more samples to blocks of 16 by 16 pixels with more variance: the allocation that
    /// minimises the error of the whole picture (Neyman, "On the Two Different Aspects of the
    /// Representative Method", 1934, section III), but nowhere less than an eighth of the mean. It
    /// follows from the pilot. [`Film::sample_counts`](super::Film::sample_counts) returns the resulting numbers.
    #[must_use]
    pub const fn adaptive(self) -> Self {
        Self { adaptive: true, ..self }
    }

    /// Checks that the target and the budget are valid for a film.
    pub(crate) fn check(
        &self,
        width: u32,
        height: u32,
        sampling: &Sampling,
    ) -> Result<(), UntilError> {
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
        if width == 0 || height == 0 {
            return Err(UntilError::NoPixels { width, height });
        }
        Ok(())
    }
}

/// The reason why a target or a budget is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UntilError {
    /// The tolerance is not a positive number.
    #[error("the tolerance is {tolerance}: give a number above 0")]
    Tolerance {
        /// The given tolerance.
        tolerance: f64,
    },
    /// The confidence is out of range.
    #[error("the confidence is {confidence}: give a number from 0.5 to 0.9999, as 0.95")]
    Confidence {
        /// The given confidence.
        confidence: f64,
    },
    /// The pilot has no samples.
    #[error("the pilot has no samples: give it at least 1, as 1024")]
    NoPilot,
    /// The time budget is zero.
    #[error("the budget has no time: give a duration above 0")]
    NoTime,
    /// There are fewer samples than replications.
    #[error(
        "the budget has {samples} samples a pixel but needs {needed}: one for each of \
         {REPLICATIONS} replications, and for each of the places in a pixel, if those are fixed"
    )]
    TooFewSamples {
        /// The given samples.
        samples: u32,
        /// The minimum.
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

/// The reason why a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The error is within the tolerance, with the target's confidence.
    Converged,
    /// The time is spent.
    OutOfTime,
    /// The samples are spent.
    OutOfSamples,
    /// `f32` cannot represent colours that accurately, or every pixel is NaN: no number of samples
    /// suffices.
    Unresolvable {
        /// The rounding error floor, in the metric's unit. A tolerance must be above twice that.
        /// The rounding of a kernel's own arithmetic comes on top.
        floor: f64,
    },
    /// The observer stopped the run.
    Stopped,
}

/// An error estimate with its confidence bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The most likely error; infinite before there are two replications.
    pub error: f64,
    /// The lower bound, with the target's confidence.
    pub low: f64,
    /// The upper bound, with the target's confidence.
    pub high: f64,
}

impl Estimate {
    /// The estimate of no samples.
    pub(crate) const UNKNOWN: Self = Self { error: f64::INFINITY, low: 0.0, high: f64::INFINITY };
}

/// The progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The error of the best picture so far.
    pub estimate: Estimate,
    /// Its samples per pixel, on average.
    pub samples: u32,
    /// Samples per pixel taken in all, on average.
    pub spent: u32,
    /// The time since the beginning.
    pub elapsed: Duration,
    /// The time left of the budget.
    pub time_left: Duration,
}

/// The result of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// The reason why it ended.
    pub outcome: Outcome,
    /// The error of the picture in the film.
    pub estimate: Estimate,
    /// The picture's samples per pixel, on average; [`Film::sample_counts`](super::Film::sample_counts) has those of each
    /// pixel.
    pub samples: u32,
    /// Samples per pixel taken in all, including pilots, on average.
    pub spent: u32,
    /// The time of the run.
    pub elapsed: Duration,
    /// Pixels with a NaN sample, which are not in the error.
    pub nan_pixels: usize,
}

/// An observer that receives the progress and returns whether to go on.
pub type ProgressObserver<'a> = &'a mut (dyn FnMut(&Progress) -> ControlFlow<()> + Send);
