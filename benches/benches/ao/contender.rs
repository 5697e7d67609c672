//! What every system is to the rounds.

use std::iter::Sum;

use raydsl::prelude::*;
use rayon::prelude::*;

use super::row::Row;

/// Rays that a thread is handed at once.
const PART: usize = 4096;

/// What asking some rays gave.
#[derive(Clone, Copy, Default)]
pub(crate) struct Outcome {
    /// See [`raydsl_benches::clock::seconds_on`].
    pub(crate) seconds: f64,
    pub(crate) hits: usize,
    /// The sum of the hits' distances, if they are known.
    pub(crate) distance: f64,
}

impl Sum for Outcome {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |a, b| Self {
            seconds: a.seconds + b.seconds,
            hits: a.hits + b.hits,
            distance: a.distance + b.distance,
        })
    }
}

/// What it took to build a tree.
#[derive(Clone, Copy, Default)]
pub(crate) struct Cost {
    pub(crate) build_ms: f64,
    pub(crate) bytes_per_primitive: f64,
}

impl Cost {
    pub(crate) fn new(seconds: f64, bytes: usize, primitives: usize) -> Self {
        Self { build_ms: 1e3 * seconds, bytes_per_primitive: bytes as f64 / primitives as f64 }
    }
}

/// Runs a row once.
pub(crate) type Run<'a> = Box<dyn FnMut() -> Outcome + Send + 'a>;

/// One way to run one row.
pub(crate) struct Contender<'a> {
    pub(crate) row: Row,
    pub(crate) system: &'static str,
    pub(crate) mode: String,
    pub(crate) isa: &'static str,
    pub(crate) lanes: usize,
    pub(crate) cost: Cost,
    pub(crate) run: Run<'a>,
}

/// Asks rays part by part on the threads of the pool. `ask` says how long it took, without what
/// stands around it, so that nobody is charged for copies of rays; the sum is shared among the
/// threads. It is handed a place for these copies.
pub(crate) fn in_parts<B: Default + Send>(
    rays: &[Ray],
    threads: usize,
    ask: impl Fn(&mut B, &[Ray]) -> Outcome + Sync,
) -> Outcome {
    let all: Outcome =
        rays.par_chunks(PART).map_init(B::default, |place, part| ask(place, part)).sum();
    Outcome { seconds: all.seconds / threads as f64, ..all }
}
