//! Arithmetic of the margin machine.

use std::rc::Rc;

use super::affine::{Form, Handle};
use super::arena::Known;
use super::interval::{Interval, Rounded};
use super::sums::Parts;
use super::{Margin, rounding};
use crate::machine::F32Binary;

/// The number of integers an open conversion may give before the run is abandoned.
const ALTERNATIVES: usize = 16;

impl Margin {
    /// Chooses one of some alternatives, the first of which is that of `f64`. Without any the run
    /// is lost, and `value` is used.
    pub(crate) fn one_of<T: Copy>(&self, value: T, alternatives: &[T]) -> T {
        let chosen = match alternatives {
            [first, _, ..] if !self.is_running() => Some(first),
            [_, _, ..] => alternatives.get(self.decisions.choose(alternatives.len())),
            few => few.first(),
        };
        chosen.copied().unwrap_or_else(|| {
            self.decisions.lose();
            value
        })
    }

    /// Decides a monotonically increasing conversion to integers among all possible integers.
    /// `order` and `back` map them to consecutive numbers; `nans` are the results for a NaN.
    pub(super) fn integer<T: Copy + PartialEq>(
        &self,
        a: Known,
        of: impl Fn(f64) -> T,
        order: impl Fn(T) -> i64,
        back: impl Fn(i64) -> T,
        nans: &[T],
    ) -> T {
        let value = of(a.value);
        let mut possible = Vec::new();
        if !a.range.is_nan() {
            let (first, last) = (order(of(a.range.low)), order(of(a.range.high)));
            if last - first >= ALTERNATIVES as i64 {
                if self.is_running() {
                    self.decisions.lose();
                }
                return value;
            }
            possible.extend((first..=last).map(back));
        }
        if a.range.nan {
            let more: Vec<T> = nans.iter().copied().filter(|n| !possible.contains(n)).collect();
            possible.extend(more);
        }
        // Puts the integer of `f64` first; a path other than that of `f64` may lack it.
        if let Some(at) = possible.iter().position(|v| *v == value) {
            possible.swap(0, at);
        }
        self.one_of(value, &possible)
    }

    /// Applies an increasing step function: a decision if few steps are possible.
    pub(super) fn stepped(&self, a: Known, f: impl Fn(f64) -> f64) -> Known {
        let value = f(a.value);
        if a.range.is_nan() {
            return self.point(f64::NAN);
        }
        let (first, last) = (f(a.range.low), f(a.range.high));
        if first == last && !a.range.nan {
            return self.bounded(value, Interval::new(first, last, false));
        }
        if a.range.nan || last - first > 3.0 || !(first..=last).contains(&value) {
            return self.bounded(value, Interval::new(first, last, a.range.nan));
        }
        let mut all = vec![value];
        let steps = (0..=(last - first) as u32).map(|k| first + f64::from(k));
        all.extend(steps.filter(|v| *v != value));
        let step = self.one_of(value, &all);
        // A zero inside is of either sign, a zero at an end of that end's sign.
        let [low, high] = [(first, -0.0), (last, 0.0)].map(|(end, zero)| {
            if step != 0.0 {
                step
            } else if end == 0.0 {
                end
            } else {
                zero
            }
        });
        self.bounded(step, Interval::new(low, high, false))
    }

    /// Returns `|a|`.
    pub(super) fn size(&self, a: Known) -> Known {
        let size = match a.range {
            // The same number, apart from the signs of zeros.
            r if r.low >= 0.0 && !r.is_nan() => a,
            r if r.high <= 0.0 && !r.is_nan() => self.negated(a),
            _ => self.bounded(a.value, a.range),
        };
        Known { value: a.value.abs(), range: a.range.abs(), ..size }
    }

    /// Returns a float that is `value` in `f64`, and a rounded number of `range` in `f32`.
    pub(crate) fn rounded(&self, value: f64, range: Interval, by: Rounded) -> Known {
        self.computed(value, range, None, by)
    }

    /// Returns a float that is `value` in `f64`, and in `f32` a rounded number of `range` and
    /// `form`.
    fn computed(&self, value: f64, range: Interval, form: Option<Form>, by: Rounded) -> Known {
        self.computed_within(value, range, form, by, 0.0)
    }

    /// Returns the same as `computed`, with a further error of up to `extra`.
    pub(super) fn computed_within(
        &self,
        value: f64,
        range: Interval,
        form: Option<Form>,
        by: Rounded,
        extra: f64,
    ) -> Known {
        let form = form.filter(|_| !range.is_nan());
        let range = form.as_ref().map_or(range, |f| range.narrowed(f.range()));
        let result = range.widened(extra).rounded(by);
        // Devices may ignore the sign of a zero.
        let strict = self.rounding.is_strict;
        let rounded = self.bounded(value, if strict { result } else { result.with_any_zero() });
        if rounded.range.may_break() || rounded.range.is_zero() {
            return rounded;
        }
        let form = form.or_else(|| self.forms.get(Handle::NONE, range).map(Rc::unwrap_or_clone));
        let error = range.magnitude() * by.relative + by.absolute + extra;
        Known { form: self.forms.put_rounded(form, error), ..rounded }
    }

    /// Combines two forms by an operation, if both are known.
    pub(super) fn both(
        &self,
        a: Known,
        b: Known,
        f: impl Fn(&Form, &Form) -> Form,
    ) -> Option<Form> {
        Some(f(&*self.forms.get(a.form, a.range)?, &*self.forms.get(b.form, b.range)?))
    }

    /// Returns `-a`.
    pub(super) fn negated(&self, a: Known) -> Known {
        let negated =
            |form| self.forms.put(self.forms.get(form, a.range).map(|f| Rc::new(f.neg())));
        let parts = a.parts.map(|p| Parts { form: negated(p.form), ..p });
        Known { form: negated(a.form), parts, ..self.bounded(-a.value, a.range.neg()) }
    }

    /// Returns the square root.
    pub(super) fn root(&self, a: Known) -> Known {
        if self.rounding.is_strict
            && let Some(exact) = a.range.as_point().and_then(rounding::exact_root)
        {
            return self.point(exact);
        }
        let form = self.forms.get(a.form, a.range).and_then(|f| f.sqrt());
        self.computed(a.value.sqrt(), a.range.sqrt(), form, self.rounding.root())
    }

    /// Returns `a op b`.
    pub(super) fn binary(&self, op: F32Binary, a: Known, b: Known) -> Known {
        let (x, y) = (a.value, b.value);
        if let Some(exact) = self.exact(op, a, b) {
            return match op {
                // Devices may ignore the sign of a zero, and fold what is multiplied by one.
                F32Binary::Mul if exact == 0.0 && !self.rounding.is_strict => {
                    self.bounded(exact, Interval::point(exact).with_any_zero())
                }
                _ => self.point(exact),
            };
        }
        let same = a.id == b.id;
        let sum = self.rounding.sum();
        // The same number, apart from the sign of a zero. Another order of a cancelling sum may
        // differ.
        let is_zero = |v: Known| v.range.is_zero() && v.parts.is_none();
        let kept = |v: Known, value| Known { value, range: v.range.with_any_zero(), ..v };
        match op {
            F32Binary::Add if is_zero(b) => kept(a, x + y),
            F32Binary::Sub if is_zero(b) => kept(a, x - y),
            F32Binary::Add if is_zero(a) => kept(b, x + y),
            F32Binary::Sub if same && a.parts.is_none() && !a.range.may_break() => self.point(0.0),
            F32Binary::Add | F32Binary::Sub if !self.rounding.is_strict => {
                self.sum_in_any_order(op, a, b)
            }
            F32Binary::Add => {
                self.computed(x + y, a.range.add(b.range), self.both(a, b, Form::add), sum)
            }
            F32Binary::Sub => {
                self.computed(x - y, a.range.sub(b.range), self.both(a, b, Form::sub), sum)
            }
            F32Binary::Mul => {
                let range = if same { a.range.square() } else { a.range.mul(b.range) };
                let by = self.rounding.product(a.range, b.range);
                let form = self.both(a, b, Form::mul);
                let product = self.computed(x * y, range, form.clone(), by);
                Known { parts: self.parts_of_product(product.range, form, by), ..product }
            }
            F32Binary::Div if !self.rounding.divides(b.range) => {
                let is_nan = a.range.is_nan() || b.range.is_nan();
                self.bounded(x / y, if is_nan { Interval::NAN } else { Interval::ALL })
            }
            F32Binary::Div => {
                let get = |v: Known| self.forms.get(v.form, v.range);
                let form = get(a).zip(get(b)).and_then(|(a, b)| a.div(&b));
                self.computed(x / y, a.range.div(b.range), form, self.rounding.quotient(b.range))
            }
            F32Binary::Min => self.least(a, b, if y < x { y } else { x }, a.range.min(b.range)),
            F32Binary::Max => self.least(a, b, if x < y { y } else { x }, a.range.max(b.range)),
        }
    }

    /// Returns the result of an operation that no variant rounds.
    fn exact(&self, op: F32Binary, a: Known, b: Known) -> Option<f64> {
        let (x, y) = (a.range.as_point()?, b.range.as_point()?);
        let result = rounding::exact(op, x, y)?;
        let is_safe = match op {
            _ if self.rounding.is_strict => true,
            // Sums track their addends, and quotients may be computed as products.
            F32Binary::Add | F32Binary::Sub | F32Binary::Div => false,
            _ => !(result as f32).is_subnormal(),
        };
        is_safe.then_some(result)
    }

    /// Returns the smaller or the larger of two numbers. This needs no decision: the interval
    /// follows from both.
    fn least(&self, a: Known, b: Known, value: f64, range: Interval) -> Known {
        // The operand itself, if it is certain which one it is.
        match range {
            r if a.range.overlaps(b.range) || r.nan => self.bounded(value, r),
            r if r == a.range => Known { value, ..a },
            r if r == b.range => Known { value, ..b },
            r => self.bounded(value, r),
        }
    }

    /// Converts an integer to a float.
    pub(super) fn converted(&self, value: f64, short: f32) -> Known {
        if f64::from(short) == value {
            return self.point(value);
        }
        self.rounded(value, Interval::point(value), self.rounding.sum())
    }
}

/// Returns the `f64` number denoted by a constant of [`core::f32::consts`].
///
/// It is recognised by its value, so it may come by any path. A user's constant that has the same
/// bits by chance (18 numbers among four thousand million) would be mistaken for it, which moves
/// the reference by less than the rounding of that constant.
pub(super) fn constant(v: f32) -> f64 {
    use core::{f32::consts as short, f64::consts as long};
    macro_rules! table {
        ($($name:ident)+) => {
            [$((short::$name, long::$name)),+]
        };
    }
    let known = table!(
        E FRAC_1_PI FRAC_1_SQRT_2 FRAC_2_PI FRAC_2_SQRT_PI FRAC_PI_2 FRAC_PI_3 FRAC_PI_4 FRAC_PI_6
        FRAC_PI_8 LN_10 LN_2 LOG10_2 LOG10_E LOG2_10 LOG2_E PI SQRT_2 TAU
    );
    known.into_iter().find_map(|(s, l)| (s == v).then_some(l)).unwrap_or(f64::from(v))
}

/// Maps the bits of a float to an integer in the order of the numbers; -0 comes before +0.
pub(super) fn ordered(bits: u32) -> i64 {
    if bits >> 31 == 0 { i64::from(bits) } else { -i64::from(bits & 0x7fff_ffff) - 1 }
}

/// Inverts [`ordered`]: returns the bits of the float.
pub(super) fn bits_of(ordered: i64) -> u32 {
    if ordered >= 0 { ordered as u32 } else { (-ordered - 1) as u32 | 0x8000_0000 }
}
