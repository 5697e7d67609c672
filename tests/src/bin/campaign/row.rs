//! Groups of rows, and what a row promises.

use std::borrow::Cow;
use std::error::Error;

use crate::measure::Run;
use crate::outcome::{Found, Outcome};

/// Rows about one subject.
pub(crate) struct Group {
    /// For `--only`, and the anchor of its table in the book.
    pub(crate) name: &'static str,
    /// The head of its table.
    pub(crate) title: &'static str,
    /// What is promised; a row names one by its number, from 1.
    pub(crate) clauses: &'static [&'static str],
    /// Makes the rows, without measuring them.
    pub(crate) rows: fn() -> Vec<Row>,
}

/// What a figure counts, and how those of several inputs become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unit {
    /// The number of wrong results; the sum of all.
    Faults,
    /// An absolute error; the largest.
    Absolute,
    /// A relative error; the largest.
    Relative,
    /// An error in units in the last place of `f32`; the largest.
    Ulp,
    /// A multiple of what the bound is a multiple of; the largest.
    Times,
}

impl Unit {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Faults => "faults",
            Self::Absolute => "abs",
            Self::Relative => "rel",
            Self::Ulp => "ulp",
            Self::Times => "times",
        }
    }
}

/// The largest figures that keep a promise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    /// Of the scalar variant and packets.
    pub(crate) cpu: f64,
    /// Of WGSL.
    pub(crate) wgsl: f64,
    /// Of the same kernel in `f64`.
    pub(crate) f64: f64,
}

impl Bound {
    /// The same for every variant.
    pub(crate) const fn all(bound: f64) -> Self {
        Self { cpu: bound, wgsl: bound, f64: bound }
    }

    /// None may be wrong.
    pub(crate) const NONE: Self = Self::all(0.0);

    fn of(self, variant: &str) -> f64 {
        match variant {
            "wgsl" => self.wgsl,
            "f64" => self.f64,
            _ => self.cpu,
        }
    }
}

/// A bound that does not hold.
pub(crate) struct Miss {
    /// What figures are up to.
    within: Bound,
    pub(crate) why: &'static str,
}

/// Measures a row.
type Measure = Box<dyn Fn(&Run) -> Result<Outcome, Box<dyn Error>>>;

/// A line of a table: one figure of every variant, and its bound.
pub(crate) struct Row {
    /// At most 35 characters: what the inputs are like.
    pub(crate) name: Cow<'static, str>,
    /// The number of the clause of its group that promises the bound.
    pub(crate) clause: usize,
    pub(crate) unit: Unit,
    pub(crate) bound: Bound,
    /// Inputs, as a share of `--count`.
    pub(crate) share: f64,
    /// What is known of a bound that does not hold.
    pub(crate) miss: Option<Miss>,
    pub(crate) measure: Measure,
}

impl Row {
    pub(crate) fn new(
        name: impl Into<Cow<'static, str>>,
        clause: usize,
        unit: Unit,
        bound: Bound,
        measure: impl Fn(&Run) -> Result<Outcome, Box<dyn Error>> + 'static,
    ) -> Self {
        let (name, measure) = (name.into(), Box::new(measure));
        Self { name, clause, unit, bound, share: 1.0, miss: None, measure }
    }

    /// The same with this share of the inputs, for those that cost more.
    pub(crate) fn share(self, share: f64) -> Self {
        Self { share, ..self }
    }

    /// The same with a bound that is known not to hold, and why; figures are up to `within`, and faults
    /// that share of the inputs. The table lists the row with its figure, and larger ones fail.
    pub(crate) fn misses(self, within: Bound, why: &'static str) -> Self {
        Self { miss: Some(Miss { within, why }), ..self }
    }

    /// Its name among all rows.
    pub(crate) fn path(&self, group: &Group) -> String {
        format!("{}/{}", group.name, self.name)
    }

    /// Whether a variant kept the promise.
    pub(crate) fn keeps(&self, found: &Found) -> bool {
        found.count > 0 && found.worst <= self.bound_of(found)
    }

    pub(crate) fn bound_of(&self, found: &Found) -> f64 {
        self.bound.of(found.variant)
    }

    /// Whether every variant did, and packets have the bits of the scalar one.
    pub(crate) fn holds(&self, outcome: &Outcome) -> bool {
        outcome.other_bits == 0 && outcome.found.iter().all(|found| self.keeps(found))
    }

    /// Whether the bound is missed as it is known to be.
    pub(crate) fn is_known_miss(&self, outcome: &Outcome) -> bool {
        let Some(miss) = &self.miss else { return false };
        let is_within = |found: &Found| {
            let scale = if self.unit == Unit::Faults { found.count as f64 } else { 1.0 };
            found.worst <= miss.within.of(found.variant) * scale
        };
        let is_known = |found: &Found| self.keeps(found) || is_within(found);
        !self.holds(outcome) && outcome.other_bits == 0 && outcome.found.iter().all(is_known)
    }

    /// The inputs of what broke the promise, in words; why, if that is known.
    pub(crate) fn examples<'o>(&self, outcome: &'o Outcome) -> Vec<&'o str> {
        if self.holds(outcome) {
            return Vec::new();
        }
        if let Some(miss) = &self.miss
            && self.is_known_miss(outcome)
        {
            return vec![miss.why];
        }
        let broke = outcome.found.iter().filter(|found| !self.keeps(found));
        let of_bits = outcome.first_other_bits.as_deref();
        broke.filter_map(|found| found.example.as_deref()).chain(of_bits).collect()
    }
}
