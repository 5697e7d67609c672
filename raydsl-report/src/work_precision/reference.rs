//! Reference results of a case.

use super::error::WorkPrecisionError;

/// The origin of a reference, the strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ReferenceKind {
    /// R0: a closed form.
    ClosedForm,
    /// R1: a quadrature done in advance.
    Quadrature,
    /// R2: the same kernel in `f64`, with a finer knob.
    F64,
    /// R3: two converged independent renderings.
    Halves,
}

impl ReferenceKind {
    /// Returns `R0`, `R1`, `R2` or `R3`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "R0",
            Self::Quadrature => "R1",
            Self::F64 => "R2",
            Self::Halves => "R3",
        }
    }

    /// Returns the meaning of the name.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed form",
            Self::Quadrature => "quadrature",
            Self::F64 => "f64",
            Self::Halves => "two halves",
        }
    }
}

/// The exact result of a case, and its uncertainty: one value for all pixels, or one for each, row
/// by row from the bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    kind: ReferenceKind,
    values: Vec<f64>,
    /// The other half, for [`ReferenceKind::Halves`].
    other: Option<Vec<f64>>,
    uncertainty: f64,
}

impl Reference {
    /// Creates a reference from a closed form: the same value for each pixel, without an error.
    pub fn closed_form(value: f64) -> Self {
        Self::new(ReferenceKind::ClosedForm, vec![value], 0.0)
    }

    /// Creates a reference from a closed form for each pixel, without an error.
    pub fn closed_forms(values: impl Into<Vec<f64>>) -> Self {
        Self::new(ReferenceKind::ClosedForm, values.into(), 0.0)
    }

    /// Creates a reference from a quadrature, one value or one for each pixel, and a bound on their
    /// error.
    pub fn quadrature(values: impl Into<Vec<f64>>, uncertainty: f64) -> Self {
        Self::new(ReferenceKind::Quadrature, values.into(), uncertainty)
    }

    /// Creates a reference from the same kernel in `f64`, one value or one for each pixel, and a
    /// bound on their error: for example the distance to the next finer ones.
    pub fn f64(values: impl Into<Vec<f64>>, uncertainty: f64) -> Self {
        Self::new(ReferenceKind::F64, values.into(), uncertainty)
    }

    /// Creates a reference from two renderings with different samples. The squared error of an
    /// estimate x is then (x - a)(x - b), on average without the noise of either. Their uncertainty
    /// is the standard error of their mean, half of the root of the mean of (a - b)^2.
    pub fn halves(a: impl Into<Vec<f64>>, b: impl Into<Vec<f64>>) -> Self {
        let (a, b) = (a.into(), b.into());
        let squares: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
        let uncertainty = 0.5 * (squares / a.len().max(1) as f64).sqrt();
        let mut halves = Self::new(ReferenceKind::Halves, a, uncertainty);
        halves.other = Some(b);
        halves
    }

    fn new(kind: ReferenceKind, values: Vec<f64>, uncertainty: f64) -> Self {
        Self { kind, values, other: None, uncertainty }
    }

    /// Returns the kind.
    pub fn kind(&self) -> ReferenceKind {
        self.kind
    }

    /// Returns the uncertainty.
    pub fn uncertainty(&self) -> f64 {
        self.uncertainty
    }

    /// Returns the number of values: 1, or one for each pixel.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Returns whether it has no values.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Returns whether it fits `count` estimates.
    pub(super) fn fits(&self, count: usize) -> bool {
        count > 0 && (self.len() == 1 || self.len() == count)
    }

    /// Returns the reference of estimate `i`, and its two halves.
    pub(super) fn at(&self, i: usize) -> (f64, [f64; 2]) {
        let i = if self.len() == 1 { 0 } else { i };
        let a = self.values[i];
        let b = self.other.as_ref().map_or(a, |other| other[i]);
        (0.5 * (a + b), [a, b])
    }

    /// Returns the root of the mean square.
    pub(super) fn size(&self) -> f64 {
        let squares: f64 = self.values.iter().map(|v| v * v).sum();
        (squares / self.len().max(1) as f64).sqrt()
    }

    /// Checks that the reference is valid.
    pub(super) fn check(&self, case: &str) -> Result<(), WorkPrecisionError> {
        let case = || case.to_owned();
        if self.is_empty() {
            return Err(WorkPrecisionError::Nothing { what: "number in a reference" });
        }
        let others = self.other.as_ref().unwrap_or(&self.values);
        if others.len() != self.len() {
            let (found, expected) = (others.len(), self.len());
            let method = "the other half".to_owned();
            return Err(WorkPrecisionError::Length {
                case: case(),
                method,
                knob: 0,
                found,
                expected,
            });
        }
        for values in [&self.values, others] {
            if let Some(index) = values.iter().position(|v| !v.is_finite()) {
                let value = values[index];
                return Err(WorkPrecisionError::Reference { case: case(), index, value });
            }
        }
        let value = self.uncertainty;
        if value.is_finite() && value >= 0.0 {
            return Ok(());
        }
        Err(WorkPrecisionError::Uncertainty { case: case(), value })
    }
}
