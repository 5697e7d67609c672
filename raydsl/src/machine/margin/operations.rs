//! The operations that are generic methods of [`Machine`](crate::machine::Machine), compiled once.

use super::arena::{Bounded, Known};
use super::interval::Interval;
use super::{Margin, Truth, affine};
use crate::machine::scalar;
use crate::machine::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, KnownBy};

impl Margin {
    #[inline(never)]
    pub(super) fn of_one(&self, op: F32Unary, a: Bounded) -> Bounded {
        self.put(self.unary(op, self.get(a)))
    }

    #[inline(never)]
    pub(super) fn of_two(&self, op: F32Binary, a: Bounded, b: Bounded) -> Bounded {
        self.put(self.binary(op, self.get(a), self.get(b)))
    }

    fn unary(&self, op: F32Unary, a: Known) -> Known {
        match op {
            F32Unary::Neg => self.negated(a),
            F32Unary::Abs => self.size(a),
            F32Unary::Sqrt => self.root(a),
            F32Unary::Floor => self.stepped(a, f64::floor),
            F32Unary::Ceil => self.stepped(a, f64::ceil),
            F32Unary::Trunc => self.stepped(a, f64::trunc),
        }
    }

    #[inline(never)]
    pub(super) fn compared(&self, op: Compare, a: Bounded, b: Bounded) -> Truth {
        let (a, b) = (self.get(a), self.get(b));
        let value = op.of(a.value, b.value);
        let (x, y) = (a.range, b.range);
        let numbers = !x.is_nan() && !y.is_nan();
        let same = a.id == b.id;
        let mut less = numbers && !same && x.low < y.high;
        let mut more = numbers && !same && x.high > y.low;
        let mut equal = numbers && x.overlaps(y);
        if less
            && more
            && let Some(difference) = self.both(a, b, affine::Form::sub)
        {
            let difference = difference.range();
            less = difference.low < 0.0;
            more = difference.high > 0.0;
            equal = difference.contains(0.0);
        }
        let unordered = x.nan || y.nan;
        let (is_true, is_false) = match op {
            Compare::Eq => (equal, less || more || unordered),
            Compare::Ne => (less || more || unordered, equal),
            Compare::Lt => (less, equal || more || unordered),
            Compare::Le => (less || equal, more || unordered),
            Compare::Gt => (more, less || equal || unordered),
            Compare::Ge => (more || equal, less || unordered),
        };
        self.truth(value, is_true, is_false)
    }

    #[inline(never)]
    pub(super) fn beside_infinity(&self, op: Compare, a: Bounded) -> Truth {
        let a = self.get(a);
        let Interval { low, high, nan } = a.range;
        let is_number = !a.range.is_nan();
        let may_be_infinite = is_number && (low.is_infinite() || high.is_infinite());
        let may_be_finite = is_number && low < f64::INFINITY && high > f64::NEG_INFINITY;
        let size = a.value.abs();
        let is_nan = || self.truth(size.is_nan(), nan, is_number);
        let is_infinite = || self.truth(size.is_infinite(), may_be_infinite, nan || may_be_finite);
        let is_finite = || self.truth(size.is_finite(), may_be_finite, nan || may_be_infinite);
        match op {
            Compare::Gt => is_nan(),
            Compare::Eq => is_infinite(),
            Compare::Lt => is_finite(),
            Compare::Le => is_nan().opposite(),
            Compare::Ne => is_infinite().opposite(),
            Compare::Ge => is_finite().opposite(),
        }
    }

    #[inline(never)]
    pub(super) fn sign_bit(&self, op: Compare, a: Bounded) -> Truth {
        let is_negative = self.is_negative(self.get(a));
        if op == Compare::Lt { is_negative } else { is_negative.opposite() }
    }

    #[inline(never)]
    pub(super) fn joined(&self, op: BoolBinary, a: Truth, b: Truth) -> Truth {
        let (a, b) = (self.known(a), self.known(b));
        let value = op.of(a.value, b.value);
        match op {
            BoolBinary::And if a.is(false) || b.is(false) => Truth::certain(false),
            BoolBinary::Or if a.is(true) || b.is(true) => Truth::certain(true),
            _ if a.open == 0 && b.open == 0 => Truth::certain(value),
            // The other one decides: the result is that one, or its opposite.
            _ if a.open == 0 => Truth { value, open: b.open },
            _ if b.open == 0 => Truth { value, open: a.open },
            _ => self.truth(value, true, true),
        }
    }
}

impl Margin {
    /// Returns the function's bounds on its results for these floats, if they are better than its
    /// code's.
    #[inline(never)]
    pub(super) fn results(&self, of: KnownBy, args: &[Bounded]) -> Option<Vec<Bounded>> {
        let args: Vec<Known> = args.iter().map(|a| self.get(*a)).collect();
        Some(of.0.bound(self, &args)?.into_iter().map(|v| self.put(v)).collect())
    }
}

impl Truth {
    pub(super) fn opposite(self) -> Self {
        Self { value: !self.value, ..self }
    }
}

#[inline(never)]
pub(super) fn of_two_i32(op: IntBinary, a: i32, b: i32) -> i32 {
    scalar::i32_binary(op, a, b).1
}

#[inline(never)]
pub(super) fn of_two_u32(op: IntBinary, a: u32, b: u32) -> u32 {
    scalar::u32_binary(op, a, b).1
}

/// Compares integers of either type.
#[inline(never)]
pub(super) fn compared_integers(op: Compare, a: i64, b: i64) -> Truth {
    Truth::certain(op.of(a, b))
}
