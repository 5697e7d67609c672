//! Affine arithmetic: correlated rounding errors.
//!
//! Stolfi and de Figueiredo, "Self-Validated Numerical Methods and Applications" (1997), chapter 3.
//! An interval forgets the origin of an error, so `x - x` is as wide as two errors. Here each
//! rounding is a symbol between -1 and 1, and a value has a weight for each symbol.

use core::cell::{Cell, RefCell};
use std::rc::Rc;

use super::interval::Interval;

/// The number of terms of a form above which the least are merged.
const TERMS: usize = 48;
/// The number of stored forms; values beyond have their interval alone.
const FORMS: usize = 1 << 14;

/// An affine form `center + terms + rest`: terms are symbols between -1 and 1 with weights, ordered
/// by symbol; the rest is an uncorrelated error.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Form {
    center: f64,
    terms: Vec<(u32, f64)>,
    rest: f64,
}

impl Form {
    /// Returns the form of one exact number.
    fn point(center: f64) -> Self {
        Self { center, terms: Vec::new(), rest: 0.0 }
    }

    fn radius(&self) -> f64 {
        self.rest + self.terms.iter().map(|(_, w)| w.abs()).sum::<f64>()
    }

    /// Bounds the error of this arithmetic itself, which runs in `f64`.
    fn slop(&self) -> f64 {
        (self.center.abs() + self.radius()) * 2f64.powi(-48)
    }

    /// Returns the interval of the form.
    pub(super) fn range(&self) -> Interval {
        let radius = self.radius() + self.slop();
        // A sum does not determine the sign of a zero.
        Interval::new(self.center - radius, self.center + radius, false).with_any_zero()
    }

    /// Returns `a * self + b * other`.
    fn combined(&self, a: f64, other: &Self, b: f64) -> Self {
        let mut terms = Vec::with_capacity(self.terms.len() + other.terms.len() + 1);
        let (mut left, mut right) = (self.terms.iter().peekable(), other.terms.iter().peekable());
        loop {
            let (x, y) = (left.peek().map(|t| t.0), right.peek().map(|t| t.0));
            let Some(symbol) = x.into_iter().chain(y).min() else { break };
            let take = |from: &mut core::iter::Peekable<core::slice::Iter<'_, (u32, f64)>>| {
                from.next_if(|t| t.0 == symbol).map_or(0.0, |t| t.1)
            };
            terms.push((symbol, a * take(&mut left) + b * take(&mut right)));
        }
        Self {
            center: a * self.center + b * other.center,
            terms,
            rest: a.abs() * self.rest + b.abs() * other.rest,
        }
    }

    pub(super) fn add(&self, other: &Self) -> Self {
        self.combined(1.0, other, 1.0)
    }

    pub(super) fn sub(&self, other: &Self) -> Self {
        self.combined(1.0, other, -1.0)
    }

    pub(super) fn neg(&self) -> Self {
        self.combined(-1.0, &Self::point(0.0), 0.0)
    }

    pub(super) fn mul(&self, other: &Self) -> Self {
        let mut all = self.combined(other.center, other, self.center);
        all.center = self.center * other.center;
        all.rest += self.radius() * other.radius();
        all
    }

    /// Returns `self / other`, unless `other` may be 0.
    pub(super) fn div(&self, other: &Self) -> Option<Self> {
        let (c, r) = (other.center, other.radius());
        // 1/c - (y - c)/c², and its error.
        (r < c.abs()).then(|| {
            let mut inverse = other.combined(-1.0 / (c * c), &Self::point(0.0), 0.0);
            inverse.center = 1.0 / c;
            inverse.rest += r * r / (c * c * (c.abs() - r));
            self.mul(&inverse)
        })
    }

    /// Returns the square root of a positive number.
    pub(super) fn sqrt(&self) -> Option<Self> {
        let (c, r) = (self.center, self.radius());
        (r < c).then(|| {
            let root = c.sqrt();
            let mut all = self.combined(0.5 / root, &Self::point(0.0), 0.0);
            all.center = root;
            all.rest += r * r / (2.0 * c * root);
            all
        })
    }

    /// Adds an error under a new symbol.
    fn with_error(mut self, symbol: u32, error: f64) -> Self {
        self.terms.push((symbol, error + self.slop()));
        if self.terms.len() > TERMS {
            let mut weights: Vec<f64> = self.terms.iter().map(|(_, w)| w.abs()).collect();
            let (_, least, _) = weights.select_nth_unstable_by(TERMS / 2, f64::total_cmp);
            let (least, mut rest) = (*least, self.rest);
            self.terms.retain(|(_, w)| {
                let stays = w.abs() > least;
                rest += if stays { 0.0 } else { w.abs() };
                stays
            });
            self.rest = rest;
        }
        self
    }
}

/// The index of a form; [`Handle::NONE`] for a value with only an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Handle(u32);

impl Handle {
    pub(super) const NONE: Self = Self(u32::MAX);
}

/// The affine forms of a machine's values.
#[derive(Debug, Default)]
pub(crate) struct Forms {
    all: RefCell<Vec<Rc<Form>>>,
    symbols: Cell<u32>,
    /// Whether forms are disabled, leaving intervals alone.
    off: Cell<bool>,
}

impl Forms {
    fn symbol(&self) -> u32 {
        self.symbols.replace(self.symbols.get().wrapping_add(1))
    }

    pub(crate) fn len(&self) -> usize {
        self.all.borrow().len()
    }

    /// Drops all but the first `len` forms.
    pub(crate) fn truncate(&self, len: usize) {
        self.all.borrow_mut().truncate(len);
    }

    /// Runs `f` with intervals alone, which is faster.
    pub(crate) fn without<R>(&self, f: impl FnOnce() -> R) -> R {
        let off = self.off.replace(true);
        let result = f();
        self.off.set(off);
        result
    }

    /// Returns the form of a value; one without a form gets an error symbol of its own.
    pub(crate) fn get(&self, handle: Handle, range: Interval) -> Option<Rc<Form>> {
        if self.off.get() {
            return None;
        }
        if let Some(form) = self.all.borrow().get(handle.0 as usize) {
            return Some(Rc::clone(form));
        }
        if range.may_break() || range.is_nan() {
            return None;
        }
        let (middle, half) = (0.5 * (range.low + range.high), 0.5 * (range.high - range.low));
        let form = Form::point(middle);
        Some(Rc::new(if half > 0.0 { form.with_error(self.symbol(), half) } else { form }))
    }

    /// Stores a form.
    pub(crate) fn put(&self, form: Option<Rc<Form>>) -> Handle {
        let mut all = self.all.borrow_mut();
        match form {
            Some(form) if all.len() < FORMS && form.radius().is_finite() => {
                all.push(form);
                Handle(all.len() as u32 - 1)
            }
            _ => Handle::NONE,
        }
    }

    /// Stores a form that was rounded, with `error` under a new symbol.
    pub(super) fn put_rounded(&self, form: Option<Form>, error: f64) -> Handle {
        self.put(form.map(|f| Rc::new(f.with_error(self.symbol(), error))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(forms: &Forms, low: f64, high: f64) -> Form {
        let form = forms.get(Handle::NONE, Interval::new(low, high, false));
        form.map_or_else(|| Form::point(f64::NAN), Rc::unwrap_or_clone)
    }

    #[test]
    fn equal_errors_cancel() {
        let forms = Forms::default();
        let (x, y) = (number(&forms, 1.0, 3.0), number(&forms, 10.0, 12.0));
        let back = x.add(&y).sub(&y).range();
        assert!((back.low - 1.0).abs() < 1e-9 && (back.high - 3.0).abs() < 1e-9, "{back:?}");
        assert!(x.sub(&x).range().high < 1e-9);
    }

    #[test]
    fn ranges_hold_the_results_of_samples() {
        let forms = Forms::default();
        let (x, y) = (number(&forms, 1.5, 2.5), number(&forms, -4.0, -3.0));
        let shared = x.add(&y);
        for i in 0..=20 {
            for j in 0..=20 {
                let (a, b) = (1.5 + f64::from(i) * 0.05, -4.0 + f64::from(j) * 0.05);
                let results = [
                    (x.mul(&shared), a * (a + b)),
                    (x.div(&shared).unwrap_or(Form::point(f64::NAN)), a / (a + b)),
                    (x.sqrt().unwrap_or(Form::point(f64::NAN)), a.sqrt()),
                    (y.neg(), -b),
                ];
                for (form, result) in results {
                    let Interval { low, high, .. } = form.range();
                    assert!(low <= result && result <= high, "{result} in {form:?}");
                }
            }
        }
    }

    #[test]
    fn many_terms_become_a_rest() {
        let forms = Forms::default();
        let parts: Vec<Form> = (1..200).map(|i| number(&forms, 0.0, f64::from(i))).collect();
        let sum =
            parts.iter().fold(Form::point(0.0), |s, p| s.add(p).with_error(forms.symbol(), 0.0));
        assert!(sum.terms.len() <= TERMS + 1);
        let all = f64::from((1..200).sum::<i32>());
        assert!(sum.range().low <= 0.0 && sum.range().high >= all && sum.range().high < all + 1e-3);
    }
}
