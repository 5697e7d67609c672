//! The picture in progress, and what is asked of films and looks.

use std::time::{Duration, Instant};

use raydsl::prelude::*;

use crate::link::Job;
use crate::look::{Look, Show};

/// Samples of a pass where nobody waits for pictures in between.
pub(super) const LONGEST_PASS: u32 = 16;
/// The time that a pass should take at most, so that pictures follow each other.
const SHORT: Duration = Duration::from_millis(100);

/// The picture in progress.
pub(super) struct Picture {
    pub(super) number: u64,
    /// The number of the change that the film is of.
    pub(super) light: u64,
    pub(super) since: Instant,
    /// The film, and that of the variant it is compared with.
    pub(super) films: Option<(Film, Option<Film>)>,
    pub(super) samples: u32,
    /// Whether a coarse one is still to be made.
    pub(super) is_coarse_due: bool,
    pub(super) is_failed: bool,
    /// Whether its goal is reached, or given up.
    pub(super) is_settled: bool,
    /// The error, where it is known better than from the film's samples.
    pub(super) error: Option<f32>,
    pub(super) shown_at: Option<Instant>,
    /// Milliseconds of a sample of the last pass.
    pub(super) ms: f64,
    /// Samples of the next pass.
    pub(super) next: u32,
}

impl Picture {
    pub(super) fn none() -> Self {
        Self {
            number: 0,
            light: 0,
            since: Instant::now(),
            films: None,
            samples: 0,
            is_coarse_due: false,
            is_failed: false,
            is_settled: false,
            error: None,
            shown_at: None,
            ms: 0.0,
            next: 1,
        }
    }

    /// One that cannot be made.
    pub(super) fn failed(job: &Job) -> Self {
        Self { number: job.number, is_failed: true, ..Self::none() }
    }

    /// Makes the next pass longer if this one was short, and shorter if it was long.
    pub(super) fn pace(&mut self, count: u32, took: Duration) {
        if took > SHORT {
            self.next = (count / 2).max(1);
        } else if took < SHORT / 4 {
            self.next = (count * 2).min(LONGEST_PASS);
        }
    }
}

/// Returns the milliseconds of each of some samples.
pub(super) fn milliseconds(took: Duration, count: u32) -> f64 {
    took.as_secs_f64() * 1e3 / f64::from(count.max(1))
}

/// Returns whether the kernel for both looks is the same one.
pub(crate) fn is_same_kernel(a: &Look, b: &Look) -> bool {
    a.mode == b.mode
        && (a.show == Show::Cost) == (b.show == Show::Cost)
        && a.pose.up == b.pose.up
        && a.knots == b.knots
        && a.cuts == b.cuts
        && a.sky == b.sky
}

/// Returns the root mean square of the standard errors of a film's pixels.
pub(super) fn error(film: &Film) -> f32 {
    let errors = film.standard_error();
    let squares = errors.pixels().iter().map(|e| f64::from(e.truncate().length_squared() / 3.0));
    (squares.sum::<f64>() / errors.pixels().len().max(1) as f64).sqrt() as f32
}
