//! Interval arithmetic: bounds that contain a result for any rounding.
//!
//! Moore, Kearfott and Cloud, "Introduction to Interval Analysis" (2009), with NaN separate: an
//! interval holds the possible numbers of a result, and whether it may be NaN.

/// An interval: the result may be every number from `low` to `high` (infinities included), and NaN
/// if `nan`.
///
/// The ends are ordered totally, with -0 before +0: an interval that ends in a zero determines its
/// sign, since a quotient by it is an infinity of that sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) nan: bool,
}

/// The greatest error of a rounded result: relative and absolute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rounded {
    pub(super) relative: f64,
    pub(super) absolute: f64,
}

impl Interval {
    /// The interval of NaN alone.
    pub(crate) const NAN: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, nan: true };
    /// The interval of every number and NaN.
    pub(crate) const ALL: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, nan: true };

    /// Returns the interval of one number.
    pub(crate) fn point(v: f64) -> Self {
        if v.is_nan() { Self::NAN } else { Self { low: v, high: v, nan: false } }
    }

    /// Returns the interval from `low` to `high`; an end that is NaN is unbounded.
    pub(crate) fn new(low: f64, high: f64, nan: bool) -> Self {
        Self {
            low: if low.is_nan() { f64::NEG_INFINITY } else { low },
            high: if high.is_nan() { f64::INFINITY } else { high },
            nan,
        }
    }

    /// Returns the smallest interval around some numbers; a NaN among them is no limit.
    pub(crate) fn around(numbers: impl IntoIterator<Item = f64>, nan: bool) -> Self {
        let mut all = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, nan };
        for v in numbers {
            if v.is_nan() {
                return Self { nan, ..Self::ALL };
            }
            all = Self { low: least(all.low, v), high: greatest(all.high, v), nan };
        }
        all
    }

    /// Returns whether the result is certainly NaN.
    pub(crate) fn is_nan(self) -> bool {
        self.low > self.high
    }

    /// Returns the number, if only one is possible. Zeros of either sign are two numbers.
    pub(crate) fn as_point(self) -> Option<f64> {
        (self.low.to_bits() == self.high.to_bits() && !self.nan).then_some(self.low)
    }

    /// Returns whether the result is certainly 0, of either sign.
    pub(super) fn is_zero(self) -> bool {
        self.low == 0.0 && self.high == 0.0 && !self.nan
    }

    /// Returns the sign, if it is certain: true for `-`. A NaN may have either.
    pub(crate) fn is_negative(self) -> Option<bool> {
        let (low, high) = (self.low.is_sign_negative(), self.high.is_sign_negative());
        (low == high && !self.nan).then_some(low)
    }

    /// Returns the interval with zeros of either sign at its ends.
    pub(super) fn with_any_zero(self) -> Self {
        Self {
            low: if self.low == 0.0 { -0.0 } else { self.low },
            high: if self.high == 0.0 { 0.0 } else { self.high },
            nan: self.nan,
        }
    }

    /// Returns the interval with each end moved outwards by `by`.
    pub(super) fn widened(self, by: f64) -> Self {
        if self.is_nan() || by == 0.0 {
            return self;
        }
        Self::new(self.low - by, self.high + by, self.nan)
    }

    /// Returns the largest absolute value in the interval.
    pub(crate) fn magnitude(self) -> f64 {
        if self.is_nan() { 0.0 } else { self.low.abs().max(self.high.abs()) }
    }

    pub(crate) fn contains(self, v: f64) -> bool {
        if v.is_nan() { self.nan } else { self.low <= v && v <= self.high }
    }

    /// Returns whether infinity or NaN is possible.
    pub(crate) fn may_break(self) -> bool {
        self.nan || !self.low.is_finite() || !self.high.is_finite()
    }

    pub(crate) fn overlaps(self, other: Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }

    /// Returns the intersection with `to`.
    pub(crate) fn narrowed(self, to: Self) -> Self {
        Self { low: greatest(self.low, to.low), high: least(self.high, to.high), nan: self.nan }
    }

    /// Returns the smallest interval that contains both.
    pub(crate) fn hull(self, other: Self) -> Self {
        Self {
            low: least(self.low, other.low),
            high: greatest(self.high, other.high),
            nan: self.nan || other.nan,
        }
    }

    /// Returns the interval after rounding to `f32`, which may overflow.
    pub(super) fn rounded(self, by: Rounded) -> Self {
        if self.is_nan() {
            return self;
        }
        // Infinity times a relative error of 0 would be NaN.
        let error = |v: f64| {
            if v.is_infinite() { 0.0 } else { v.abs() * by.relative + by.absolute }
        };
        // Rounding changes no sign, not even that of a zero.
        let low = if self.low >= 0.0 { 0f64.copysign(self.low) } else { f64::NEG_INFINITY };
        let high = if self.high <= 0.0 { 0f64.copysign(self.high) } else { f64::INFINITY };
        let low = greatest(self.low - error(self.low), low);
        let high = least(self.high + error(self.high), high);
        let limit = f64::from(f32::MAX);
        let (down, up) = (f64::NEG_INFINITY, f64::INFINITY);
        Self {
            low: if low < -limit { down } else { low.min(limit) },
            high: if high > limit { up } else { high.max(-limit) },
            nan: self.nan,
        }
    }

    pub(super) fn neg(self) -> Self {
        if self.is_nan() { self } else { Self { low: -self.high, high: -self.low, nan: self.nan } }
    }

    pub(crate) fn abs(self) -> Self {
        if self.is_nan() || self.low.is_sign_positive() {
            self
        } else if self.high.is_sign_negative() {
            self.neg()
        } else {
            Self { low: 0.0, high: self.high.max(-self.low).abs(), nan: self.nan }
        }
    }

    pub(super) fn add(self, b: Self) -> Self {
        if self.is_nan() || b.is_nan() {
            return Self::NAN;
        }
        let (up, down) = (f64::INFINITY, f64::NEG_INFINITY);
        let opposite = self.high == up && b.low == down || self.low == down && b.high == up;
        Self::new(self.low + b.low, self.high + b.high, self.nan || b.nan || opposite)
    }

    pub(super) fn sub(self, b: Self) -> Self {
        self.add(b.neg())
    }

    /// Returns whether 0 and an infinity are possible: their product and quotients are NaN.
    fn zero_meets_infinity(self, b: Self) -> bool {
        let infinite = |x: Self| x.low.is_infinite() || x.high.is_infinite();
        self.contains(0.0) && infinite(b) || b.contains(0.0) && infinite(self)
    }

    pub(super) fn mul(self, b: Self) -> Self {
        if self.is_nan() || b.is_nan() {
            return Self::NAN;
        }
        // A number near 0 times one without bound is near 0 or unbounded.
        let product = |x: f64, y: f64| {
            let sign = if x.is_sign_negative() == y.is_sign_negative() { 0.0 } else { -0.0 };
            if x == 0.0 || y == 0.0 { sign } else { x * y }
        };
        let corners = [
            product(self.low, b.low),
            product(self.low, b.high),
            product(self.high, b.low),
            product(self.high, b.high),
        ];
        Self::around(corners, self.nan || b.nan || self.zero_meets_infinity(b))
    }

    /// Returns the square.
    pub(super) fn square(self) -> Self {
        let size = self.abs();
        if size.is_nan() {
            size
        } else {
            Self::new(size.low * size.low, size.high * size.high, size.nan)
        }
    }

    pub(super) fn div(self, b: Self) -> Self {
        if self.is_nan() || b.is_nan() {
            return Self::NAN;
        }
        let infinite = |x: Self| x.low.is_infinite() || x.high.is_infinite();
        let nan = self.nan || b.nan || infinite(self) && infinite(b);
        if b.contains(0.0) {
            return Self { nan: nan || self.contains(0.0), ..Self::ALL };
        }
        let corners = [self.low / b.low, self.low / b.high, self.high / b.low, self.high / b.high];
        Self::around(corners, nan)
    }

    pub(super) fn sqrt(self) -> Self {
        if self.is_nan() || self.high < 0.0 {
            return Self::NAN;
        }
        // The root of -0 is -0.
        let low = if self.low < 0.0 { -0.0 } else { self.low };
        Self { low: low.sqrt(), high: self.high.sqrt(), nan: self.nan || self.low < 0.0 }
    }

    /// Returns `if b < a { b } else { a }`, so a NaN `b` gives `a`.
    pub(super) fn min(self, b: Self) -> Self {
        if self.is_nan() || b.is_nan() {
            return self;
        }
        let high = if b.nan { self.high } else { least(self.high, b.high) };
        // -0 is not less than +0, so +0 remains.
        let has_zero = self.low.total_cmp(&0.0).is_le() && self.high.total_cmp(&0.0).is_ge();
        let high = if high == 0.0 && has_zero { 0.0 } else { high };
        // With a NaN in `self` the comparison fails, and the NaN remains.
        Self { low: least(self.low, b.low), high, nan: self.nan }
    }

    /// Returns `if a < b { b } else { a }`.
    pub(super) fn max(self, b: Self) -> Self {
        self.neg().min(b.neg()).neg()
    }

    /// Applies `f`, a function that is monotone in `domain` and NaN outside.
    pub(crate) fn monotone(self, domain: (f64, f64), f: impl Fn(f64) -> f64) -> Self {
        if self.is_nan() || self.high < domain.0 || self.low > domain.1 {
            return Self::NAN;
        }
        let outside = self.low < domain.0 || self.high > domain.1;
        let ends = [self.low.max(domain.0), self.high.min(domain.1)].map(f);
        Self::around(ends, self.nan || outside)
    }
}

/// Returns the smaller of two numbers, with -0 smaller than +0.
fn least(a: f64, b: f64) -> f64 {
    if a.total_cmp(&b).is_le() { a } else { b }
}

/// Returns the larger of two numbers, with -0 smaller than +0.
fn greatest(a: f64, b: f64) -> f64 {
    if a.total_cmp(&b).is_ge() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from(low: f64, high: f64) -> Interval {
        Interval::new(low, high, false)
    }

    #[test]
    fn products_and_quotients_take_the_farthest_corners() {
        assert_eq!(from(-2.0, 3.0).mul(from(-5.0, 1.0)), from(-15.0, 10.0));
        assert_eq!(from(1.0, 2.0).div(from(4.0, 8.0)), from(0.125, 0.5));
        assert_eq!(from(-3.0, 2.0).square(), from(0.0, 9.0));
        assert_eq!(from(1.0, 2.0).div(from(-1.0, 8.0)), Interval { nan: false, ..Interval::ALL });
        assert!(from(-1.0, 2.0).div(from(-1.0, 8.0)).nan);
        assert!(from(0.0, 1.0).mul(from(1.0, f64::INFINITY)).nan);
    }

    #[test]
    fn roots_of_negative_numbers_are_none() {
        assert!(from(-2.0, -1.0).sqrt().is_nan());
        assert_eq!(from(-2.0, 4.0).sqrt(), Interval::new(0.0, 2.0, true));
    }

    #[test]
    fn minimum_passes_over_a_nan_on_the_right() {
        let either = Interval::new(0.0, 1.0, true);
        assert_eq!(from(3.0, 4.0).min(either), from(0.0, 4.0));
        assert_eq!(from(3.0, 4.0).min(Interval::NAN), from(3.0, 4.0));
        assert_eq!(either.min(from(3.0, 4.0)), either);
        assert_eq!(from(3.0, 4.0).max(from(1.0, 5.0)), from(3.0, 5.0));
    }

    #[test]
    fn zeros_have_signs() {
        let signs = |x: Interval| (x.low.is_sign_negative(), x.high.is_sign_negative());
        let (negative, positive) = (from(-0.0, -0.0), from(0.0, 0.0));
        assert_eq!(signs(negative.mul(from(1.0, 2.0))), (true, true));
        assert_eq!(signs(positive.mul(from(-2.0, -1.0))), (true, true));
        assert_eq!(signs(negative.abs()), (false, false));
        assert_eq!(signs(negative.hull(positive)), (true, false));
        assert_eq!(signs(Interval::around([0.0, -0.0], false)), (true, false));
        assert_eq!(negative.hull(positive).as_point(), None);
        // `if b < a { b } else { a }`: -0 is not less than +0.
        assert_eq!(signs(positive.min(negative)), (true, false));
        assert_eq!(signs(from(1.0, 2.0).min(negative)), (true, true));
        assert_eq!(signs(from(-1.0, 4.0).sqrt()), (true, false));
        let by = Rounded { relative: 0.0, absolute: 2f64.powi(-150) };
        assert_eq!(signs(from(-1e-50, -0.0).rounded(by)), (true, true));
        assert_eq!(signs(from(0.0, 1e-50).rounded(by)), (false, false));
    }

    #[test]
    fn rounding_overflows() {
        let by = Rounded { relative: 2f64.powi(-24), absolute: 2f64.powi(-150) };
        assert_eq!(from(1e39, 1e39).rounded(by), from(f64::from(f32::MAX), f64::INFINITY));
        assert_eq!(from(0.0, 0.0).rounded(by), from(0.0, 0.0));
        let third = Interval::point(1.0 / 3.0).rounded(by);
        assert!(third.contains(f64::from(1.0f32 / 3.0)) && third.high - third.low < 1e-7);
    }
}
