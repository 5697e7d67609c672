//! The machine that computes in `f64` and knows what `f32` may make of it.
//!
//! Each float is the `f64` result, which is the *reference*, together with an interval that holds
//! the `f32` result of every variant: the running error analysis of Higham, "Accuracy and
//! Stability of Numerical Algorithms" (2002), section 3.3, with the bound on either side of the
//! value kept apart. Integers and truth values are what they are.
//!
//! A comparison is *open* when its sides overlap. Truth values are those of Kleene's three-valued
//! logic until an `if`, a loop, a selection or a result needs to know: that is a **decision**. A
//! run follows `f64`; [`Margin::explore`] runs again with decisions turned.

mod decisions;
mod elementary;
mod interval;
mod outcome;
mod rounding;
mod traverse;

use core::cell::Cell;

use super::scalar::{self, ScalarLoop, compare};
use super::*;
use crate::geometry::{HitOn, Primitive, RayOn};
use decisions::{Decisions, Explored};
use interval::Interval;

pub(crate) use outcome::result_leaves;
pub use outcome::{Leaf, Outcomes};
pub use rounding::Rounding;

/// How many integers an open conversion may give before the run is given up.
const ALTERNATIVES: usize = 16;

/// A float on [`Margin`]: its `f64` value, and where the `f32` one lies.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    value: f64,
    range: Interval,
    /// Values of one number are the same value.
    id: u64,
}

/// A truth value on [`Margin`].
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    value: bool,
    /// The number of the open truth value that this one depends on; 0 if it is certain.
    open: u64,
}

impl Truth {
    fn certain(value: bool) -> Self {
        Self { value, open: 0 }
    }

    fn is(self, value: bool) -> bool {
        self.open == 0 && self.value == value
    }
}

/// The machine of one lane that computes in `f64` with a bound of the rounding error of `f32`.
#[derive(Debug)]
pub struct Margin {
    lane: Scalar,
    rounding: Rounding,
    decisions: Decisions,
}

impl Margin {
    /// A machine for variants that round like this.
    pub fn new(rounding: Rounding) -> Self {
        Self { lane: Scalar::default(), rounding, decisions: Decisions::default() }
    }

    /// A float with a number of its own.
    fn bounded(&self, value: f64, range: Interval) -> Bounded {
        Bounded { value, range, id: self.decisions.fresh() }
    }

    fn point(&self, v: f64) -> Bounded {
        self.bounded(v, Interval::point(v))
    }

    fn is_running(&self) -> bool {
        self.lane.active.get()
    }

    /// Runs `f` for each way in which its decisions may go, up to `limit`.
    fn each_way<R>(&self, limit: usize, f: impl Fn() -> R) -> Explored<R> {
        let active = self.lane.active.replace(true);
        let explored = self.decisions.explore(limit, || {
            self.lane.active.set(true);
            f()
        });
        self.lane.active.set(active);
        explored
    }

    /// A truth value that the sides of a comparison leave open, if they do.
    fn truth(&self, value: bool, may_be_true: bool, may_be_false: bool) -> Truth {
        match (may_be_true, may_be_false) {
            (true, true) => Truth { value, open: self.decisions.fresh() },
            (certain, _) => Truth::certain(certain),
        }
    }

    /// Decides.
    fn decided(&self, t: Truth) -> bool {
        if t.open == 0 || !self.is_running() {
            return t.value;
        }
        t.value ^ self.decisions.flip(t.open)
    }

    /// What is known of a truth value by now.
    fn known(&self, t: Truth) -> Truth {
        match self.decisions.known(t.open) {
            Some(flip) if t.open != 0 => Truth::certain(t.value ^ flip),
            _ => t,
        }
    }

    /// One of some integers, the first of which is that of `f64`.
    fn one_of<T: Copy>(&self, alternatives: &[T]) -> T {
        match alternatives {
            [only] => *only,
            all if self.is_running() => all[self.decisions.choose(all.len())],
            all => all[0],
        }
    }

    /// A conversion to integers that rises: each integer that is possible. `order` and `back` count
    /// them.
    fn integer<T: Copy + PartialEq>(
        &self,
        a: Bounded,
        of: impl Fn(f64) -> T,
        order: impl Fn(T) -> i64,
        back: impl Fn(i64) -> T,
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
        if a.range.nan && !possible.contains(&of(f64::NAN)) {
            possible.push(of(f64::NAN));
        }
        // The integer of `f64` first; a path that `f64` does not take may lack it.
        if let Some(at) = possible.iter().position(|v| *v == value) {
            possible.swap(0, at);
        }
        self.one_of(&possible)
    }

    /// A function in steps that rises: a decision where few steps are possible.
    fn stepped(&self, a: Bounded, f: impl Fn(f64) -> f64) -> Bounded {
        let value = f(a.value);
        if a.range.is_nan() {
            return self.point(f64::NAN);
        }
        let (first, last) = (f(a.range.low), f(a.range.high));
        if first == last && !a.range.nan {
            return self.point(first);
        }
        if a.range.nan || last - first > 3.0 || !(first..=last).contains(&value) {
            return self.bounded(value, Interval::new(first, last, a.range.nan));
        }
        let mut all = vec![value];
        let steps = (0..=(last - first) as u32).map(|k| first + f64::from(k));
        all.extend(steps.filter(|v| *v != value));
        self.point(self.one_of(&all))
    }

    /// A float that is `value` in `f64` and a rounded one of `range` in `f32`.
    fn rounded(&self, value: f64, range: Interval, by: interval::Rounded) -> Bounded {
        self.bounded(value, range.rounded(by))
    }

    fn binary(&self, op: F32Binary, a: Bounded, b: Bounded) -> Bounded {
        let (x, y) = (a.value, b.value);
        if let (Some(x), Some(y)) = (a.range.as_point(), b.range.as_point())
            && let Some(exact) = rounding::exact(op, x, y)
        {
            return self.point(exact);
        }
        let is_zero = |v: Bounded| v.range.as_point() == Some(0.0);
        let same = a.id == b.id;
        let sum = self.rounding.sum();
        match op {
            F32Binary::Add | F32Binary::Sub if is_zero(b) => a,
            F32Binary::Add if is_zero(a) => b,
            F32Binary::Add => self.rounded(x + y, a.range.add(b.range), sum),
            F32Binary::Sub if same && !a.range.may_break() => self.point(0.0),
            F32Binary::Sub => self.rounded(x - y, a.range.sub(b.range), sum),
            F32Binary::Mul => {
                let range = if same { a.range.square() } else { a.range.mul(b.range) };
                self.rounded(x * y, range, self.rounding.product(a.range, b.range))
            }
            F32Binary::Div => {
                self.rounded(x / y, a.range.div(b.range), self.rounding.quotient(b.range))
            }
            F32Binary::Min => self.least(a, b, if y < x { y } else { x }, a.range.min(b.range)),
            F32Binary::Max => self.least(a, b, if x < y { y } else { x }, a.range.max(b.range)),
        }
    }

    /// The smaller or the larger of two, which needs no decision: it is near either's ends.
    fn least(&self, a: Bounded, b: Bounded, value: f64, range: Interval) -> Bounded {
        // The operand itself, where it is certain which one it is.
        match range {
            r if a.range.overlaps(b.range) || r.nan => self.bounded(value, r),
            r if r == a.range => Bounded { value, ..a },
            r if r == b.range => Bounded { value, ..b },
            r => self.bounded(value, r),
        }
    }
}

/// The `f64` number that a constant of [`core::f32::consts`] stands for.
fn constant(v: f32) -> f64 {
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

/// The bits of a float, as an integer in the order of the numbers; -0 comes before +0.
fn ordered(bits: u32) -> i64 {
    if bits >> 31 == 0 { i64::from(bits) } else { i64::from(bits & 0x7fff_ffff) * -1 - 1 }
}

fn bits_of(ordered: i64) -> u32 {
    if ordered >= 0 { ordered as u32 } else { (-ordered - 1) as u32 | 0x8000_0000 }
}

impl Machine for Margin {
    type F32 = Bounded;
    type I32 = i32;
    type U32 = u32;
    type Bool = Truth;
    type Branch = Cell<bool>;
    type Loop = ScalarLoop;

    fn f32(&self, v: f32) -> Bounded {
        self.point(f64::from(v))
    }

    fn f32_literal(&self, v: f32, exact: f64) -> Bounded {
        self.bounded(exact, Interval::around([f64::from(v), exact], false))
    }

    fn f32_constant(&self, v: f32) -> Bounded {
        if v.is_finite() { self.f32_literal(v, constant(v)) } else { self.f32(v) }
    }

    fn i32(&self, v: i32) -> i32 {
        v
    }

    fn u32(&self, v: u32) -> u32 {
        v
    }

    fn bool(&self, v: bool) -> Truth {
        Truth::certain(v)
    }

    fn f32_unary(&self, op: F32Unary, a: Bounded) -> Bounded {
        match op {
            F32Unary::Neg => self.bounded(-a.value, a.range.neg()),
            F32Unary::Abs if a.range.low >= 0.0 && !a.range.is_nan() => a,
            F32Unary::Abs => self.bounded(a.value.abs(), a.range.abs()),
            F32Unary::Sqrt => match a.range.as_point().and_then(rounding::exact_root) {
                Some(exact) => self.point(exact),
                None => self.rounded(a.value.sqrt(), a.range.sqrt(), self.rounding.root()),
            },
            F32Unary::Floor => self.stepped(a, f64::floor),
            F32Unary::Ceil => self.stepped(a, f64::ceil),
            F32Unary::Trunc => self.stepped(a, f64::trunc),
        }
    }

    fn f32_binary(&self, op: F32Binary, a: Bounded, b: Bounded) -> Bounded {
        self.binary(op, a, b)
    }

    fn f32_mul_add(&self, a: Bounded, b: Bounded, c: Bounded) -> Bounded {
        // As two operations, since a device need not fuse them; `f64` does.
        let product = self.binary(F32Binary::Mul, a, b);
        let sum = self.binary(F32Binary::Add, product, c);
        self.bounded(a.value.mul_add(b.value, c.value), sum.range)
    }

    fn i32_binary(&self, op: IntBinary, a: i32, b: i32) -> i32 {
        scalar::i32_binary(op, a, b).1
    }

    fn u32_binary(&self, op: IntBinary, a: u32, b: u32) -> u32 {
        scalar::u32_binary(op, a, b).1
    }

    fn bool_binary(&self, op: BoolBinary, a: Truth, b: Truth) -> Truth {
        let (a, b) = (self.known(a), self.known(b));
        let value = self.lane.bool_binary(op, a.value, b.value);
        match op {
            BoolBinary::And if a.is(false) || b.is(false) => Truth::certain(false),
            BoolBinary::Or if a.is(true) || b.is(true) => Truth::certain(true),
            _ if a.open == 0 && b.open == 0 => Truth::certain(value),
            // The other one decides: it, or its opposite.
            _ if a.open == 0 => Truth { value, open: b.open },
            _ if b.open == 0 => Truth { value, open: a.open },
            _ => self.truth(value, true, true),
        }
    }

    fn i32_neg(&self, a: i32) -> i32 {
        a.wrapping_neg()
    }

    fn i32_not(&self, a: i32) -> i32 {
        !a
    }

    fn u32_not(&self, a: u32) -> u32 {
        !a
    }

    fn bool_not(&self, a: Truth) -> Truth {
        Truth { value: !a.value, ..a }
    }

    fn f32_compare(&self, op: Compare, a: Bounded, b: Bounded) -> Truth {
        let value = compare(op, a.value, b.value);
        let (x, y) = (a.range, b.range);
        let numbers = !x.is_nan() && !y.is_nan();
        let same = a.id == b.id;
        let less = numbers && !same && x.low < y.high;
        let more = numbers && !same && x.high > y.low;
        let equal = numbers && x.overlaps(y);
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

    fn i32_compare(&self, op: Compare, a: i32, b: i32) -> Truth {
        Truth::certain(compare(op, a, b))
    }

    fn u32_compare(&self, op: Compare, a: u32, b: u32) -> Truth {
        Truth::certain(compare(op, a, b))
    }

    fn f32_select(&self, c: Truth, a: Bounded, b: Bounded) -> Bounded {
        if self.decided(c) { a } else { b }
    }

    fn i32_select(&self, c: Truth, a: i32, b: i32) -> i32 {
        if self.decided(c) { a } else { b }
    }

    fn u32_select(&self, c: Truth, a: u32, b: u32) -> u32 {
        if self.decided(c) { a } else { b }
    }

    fn bool_select(&self, c: Truth, a: Truth, b: Truth) -> Truth {
        if self.decided(c) { a } else { b }
    }

    fn f32_to_i32(&self, a: Bounded) -> i32 {
        self.integer(a, |v| v as i32, i64::from, |v| v as i32)
    }

    fn f32_to_u32(&self, a: Bounded) -> u32 {
        self.integer(a, |v| v as u32, i64::from, |v| v as u32)
    }

    fn i32_to_f32(&self, a: i32) -> Bounded {
        self.converted(f64::from(a), a as f32)
    }

    fn u32_to_f32(&self, a: u32) -> Bounded {
        self.converted(f64::from(a), a as f32)
    }

    fn i32_to_u32(&self, a: i32) -> u32 {
        a as u32
    }

    fn u32_to_i32(&self, a: u32) -> i32 {
        a as i32
    }

    fn f32_to_bits(&self, a: Bounded) -> u32 {
        self.integer(a, |v| (v as f32).to_bits(), ordered, bits_of)
    }

    fn f32_from_bits(&self, a: u32) -> Bounded {
        self.f32(f32::from_bits(a))
    }

    fn f32_copysign(&self, a: Bounded, sign: Bounded) -> Bounded {
        let size = self.f32_unary(F32Unary::Abs, a);
        let is_negative = if sign.range.as_point().is_some() || sign.range.is_nan() {
            Truth::certain(sign.value.is_sign_negative())
        } else {
            let may_be = sign.range.low < 0.0 || sign.range.nan;
            self.truth(sign.value.is_sign_negative(), may_be, sign.range.high >= 0.0)
        };
        if self.decided(is_negative) { self.f32_unary(F32Unary::Neg, size) } else { size }
    }

    fn bool_to_u32(&self, a: Truth) -> u32 {
        u32::from(self.decided(a))
    }

    fn branch(&self, c: Truth) -> Cell<bool> {
        self.lane.branch(self.decided(c))
    }

    fn branch_then(&self, t: &Cell<bool>) -> bool {
        self.lane.branch_then(t)
    }

    fn branch_else(&self, t: &Cell<bool>) -> bool {
        self.lane.branch_else(t)
    }

    fn branch_end(&self, t: Cell<bool>) {
        self.lane.branch_end(t);
    }

    fn loop_begin(&self) -> ScalarLoop {
        self.lane.loop_begin()
    }

    fn loop_test(&self, l: &ScalarLoop, c: Truth) -> bool {
        self.lane.loop_test(l, self.decided(c))
    }

    fn loop_break(&self, l: &ScalarLoop) {
        self.lane.loop_break(l);
    }

    fn loop_continue(&self, l: &ScalarLoop) {
        self.lane.loop_continue(l);
    }

    fn loop_continuing(&self, l: &ScalarLoop) {
        self.lane.loop_continuing(l);
    }

    fn loop_again(&self, l: &ScalarLoop) -> bool {
        if self.is_running() && !self.decisions.round() {
            self.lane.loop_break(l);
        }
        self.lane.loop_again(l)
    }

    fn loop_end(&self, l: ScalarLoop) {
        self.lane.loop_end(l);
    }

    fn alive(&self) -> bool {
        self.lane.alive()
    }

    fn any(&self, c: Truth) -> bool {
        self.lane.any(self.decided(c))
    }

    fn var_new<V: Value<Self>>(&self, _: &'static str, v: V) -> V {
        v
    }

    fn var_declare<V: Value<Self>>(&self, _: &'static str) -> V {
        V::zero(self)
    }

    fn var_get<V: Value<Self>>(&self, state: V) -> V {
        state
    }

    fn var_set<V: Value<Self>>(&self, state: V, v: V) -> V {
        if self.is_running() { v } else { state }
    }

    fn give<V: Value<Self>>(&self, slot: &Cell<V>, v: V) {
        if self.lane.active.replace(false) {
            slot.set(v);
        }
    }

    fn give_slot<V: Value<Self>>(&self) -> V {
        V::zero(self)
    }

    fn call<A: Value<Self>, R: Value<Self>>(
        &self,
        info: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        if let Some(function) = elementary::function(info) {
            return self.elementary(function, args);
        }
        let entry = self.is_running();
        let result = body(self, args);
        self.lane.active.set(entry);
        result
    }

    fn closest_hit<P: Primitive>(
        &self,
        prims: &crate::bvh::On<'_, P>,
        ray: RayOn<Self>,
    ) -> HitOn<Self> {
        traverse::closest_hit(self, prims, ray)
    }

    fn any_hit<P: Primitive>(&self, prims: &crate::bvh::On<'_, P>, ray: RayOn<Self>) -> B<Self> {
        B(traverse::any_hit(self, prims, ray))
    }

    fn fetch<P: Primitive>(&self, prims: &crate::bvh::On<'_, P>, index: U<Self>) -> P::On<Self> {
        P::splat(self, prims.get(index.0))
    }
}

impl Margin {
    /// An integer as a float.
    fn converted(&self, value: f64, short: f32) -> Bounded {
        if f64::from(short) == value {
            return self.point(value);
        }
        self.rounded(value, Interval::point(value), self.rounding.sum())
    }
}
