//! Bounds on sums that a device may reorder, with products that it may fuse.
//!
//! In any order, the error of a sum of `n` addends is at most `n - 1` times the rounding of the sum
//! of their sizes (Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 4.2). So
//! a sum carries the form of its addends without the roundings between them. Each use of it may
//! have another order of evaluation than the next, so their errors are not correlated.

use std::rc::Rc;

use super::affine::{Form, Handle};
use super::arena::Known;
use super::interval::{Interval, Rounded};
use super::{Margin, rounding};
use crate::machine::F32Binary;

/// The addends of a value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts {
    /// The number of addends.
    pub(super) count: f64,
    /// The sum of their sizes.
    pub(super) bulk: f64,
    /// The roundings of the products among them: fused products have none.
    pub(super) error: f64,
    /// The form of their sum without rounding.
    pub(super) form: Handle,
}

impl Margin {
    fn parts(&self, v: Known) -> Parts {
        let one = Parts { count: 1.0, bulk: v.range.magnitude(), error: 0.0, form: v.form };
        v.parts.unwrap_or(one)
    }

    /// Returns the addends of a product, where devices may fuse it.
    pub(super) fn parts_of_product(
        &self,
        range: Interval,
        form: Option<Form>,
        by: Rounded,
    ) -> Option<Parts> {
        // A product with 0 is 0, fused or not.
        if self.rounding.is_strict || range.is_zero() {
            return None;
        }
        let bulk = range.magnitude();
        let error = bulk * by.relative + by.absolute;
        Some(Parts { count: 1.0, bulk, error, form: self.forms.put(form.map(Rc::new)) })
    }

    /// Returns `a + b` or `a - b`, for any order of all their addends.
    pub(super) fn sum_in_any_order(&self, op: F32Binary, a: Known, b: Known) -> Known {
        let (p, q) = (self.parts(a), self.parts(b));
        let (count, bulk, error) = (p.count + q.count, p.bulk + q.bulk, p.error + q.error);
        let is_sum = op == F32Binary::Add;
        let (x, y) = (a.value, b.value);
        let value = if is_sum { x + y } else { x - y };
        let with_parts = |form, v| Known { parts: Some(Parts { count, bulk, error, form }), ..v };
        let is_pair = count == 2.0 && error == 0.0;
        if is_pair
            && let (Some(x), Some(y)) = (a.range.as_point(), b.range.as_point())
            && let Some(exact) = rounding::exact(op, x, y).filter(|v| !(*v as f32).is_subnormal())
        {
            return with_parts(Handle::NONE, self.point(exact));
        }
        let by = self.rounding.sum();
        let any_order = (count - 1.0) * (by.relative * bulk + by.absolute) + error;
        let extra = if is_pair { 0.0 } else { any_order };
        let range = if is_sum { a.range.add(b.range) } else { a.range.sub(b.range) };
        // Another order may overflow.
        let overflows = !is_pair && bulk > f64::from(f32::MAX);
        let range = if overflows && !range.is_nan() { Interval::ALL } else { range };
        // The form does not represent an infinite addend.
        let form = self
            .forms
            .get(p.form, a.range)
            .filter(|_| !range.may_break())
            .zip(self.forms.get(q.form, b.range))
            .map(|(a, b)| if is_sum { a.add(&b) } else { a.sub(&b) });
        let sum = self.computed_within(value, range, form.clone(), by, extra);
        with_parts(self.forms.put(form.map(Rc::new)), sum)
    }
}
