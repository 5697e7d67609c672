//! What measuring a row gave.

use crate::row::Unit;

/// One variant's figure.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// `scalar`, `packet4` .. `packet16`, `wgsl`, `f64`, or `host` for what has no variants.
    pub(crate) variant: &'static str,
    /// How many inputs were judged.
    pub(crate) count: u64,
    /// The figure, in the unit of the row.
    pub(crate) worst: f64,
    /// The input with the largest error.
    pub(crate) example: Option<String>,
}

impl Found {
    /// Nothing yet.
    pub(crate) fn new(variant: &'static str) -> Self {
        Self { variant, count: 0, worst: 0.0, example: None }
    }

    /// A figure of all inputs together.
    pub(crate) fn whole(variant: &'static str, count: usize, figure: f64) -> Self {
        let worst = if figure.is_nan() { f64::INFINITY } else { figure };
        Self { variant, count: count as u64, worst, example: None }
    }

    /// Adds the error of one input; `example` describes it. A NaN is an infinite error.
    pub(crate) fn add(&mut self, unit: Unit, error: f64, example: impl FnOnce() -> String) {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        self.count += 1;
        let is_worse = match unit {
            Unit::Faults => error > 0.0 && self.example.is_none(),
            _ => error > self.worst,
        };
        if is_worse {
            self.example = Some(format!("{}: {}", self.variant, example()));
        }
        self.worst = if unit == Unit::Faults { self.worst + error } else { self.worst.max(error) };
    }

    /// Adds what was found elsewhere with inputs of the same kind.
    pub(crate) fn merge(&mut self, unit: Unit, other: Self) {
        self.count += other.count;
        let takes = match unit {
            Unit::Faults => self.example.is_none(),
            _ => other.worst > self.worst,
        };
        if takes {
            self.example = other.example;
        }
        self.worst = if unit == Unit::Faults {
            self.worst + other.worst
        } else {
            self.worst.max(other.worst)
        };
    }
}

/// What measuring a row gave.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    /// A figure of each variant that ran.
    pub(crate) found: Vec<Found>,
    /// How many results of packets have other bits than the scalar variant's.
    pub(crate) other_bits: u64,
    /// The first of those, in words.
    pub(crate) first_other_bits: Option<String>,
    /// The figure of a textbook's way, for comparison: the share of faults, or the worst error.
    pub(crate) textbook: Option<f64>,
}

impl Outcome {
    /// Of something that has no variants: a builder, a loader.
    pub(crate) fn host(found: Found) -> Self {
        Self { found: vec![found], ..Self::default() }
    }

    /// Of figures of all inputs together.
    pub(crate) fn of_figures(found: Vec<Found>) -> Self {
        Self { found, ..Self::default() }
    }

    /// With a textbook's figure beside.
    pub(crate) fn beside(self, textbook: f64) -> Self {
        Self { textbook: Some(textbook), ..self }
    }

    /// Adds what other inputs of the row gave.
    pub(crate) fn merge(&mut self, unit: Unit, other: Self) {
        for found in other.found {
            match self.found.iter_mut().find(|mine| mine.variant == found.variant) {
                Some(mine) => mine.merge(unit, found),
                None => self.found.push(found),
            }
        }
        self.other_bits += other.other_bits;
        self.first_other_bits = self.first_other_bits.take().or(other.first_other_bits);
        self.textbook = self.textbook.or(other.textbook);
    }

    pub(crate) fn of(&self, variant: &str) -> Option<&Found> {
        self.found.iter().find(|found| found.variant == variant)
    }
}
