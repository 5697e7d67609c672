//! What every system is to the rounds.

use raydsl_benches::contest::{Cost, Outcome};

use crate::row::Row;

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
