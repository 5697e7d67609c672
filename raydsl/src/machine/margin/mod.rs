//! The margin machine: an `f64` reference with bounds on the `f32` results.
//!
//! Each float is the `f64` result, which is the *reference*, together with an interval that
//! contains the `f32` result of every variant: the running error analysis of Higham, "Accuracy and
//! Stability of Numerical Algorithms" (2002), section 3.3, with separate bounds on either side of
//! the value, and affine forms where errors cancel. Integers and truth values are exact.
//!
//! A comparison is *open* when the intervals of its sides overlap. Truth values are those of
//! Kleene's three-valued logic until an `if`, a loop, a selection or a result needs one: that is a
//! **decision**. A run follows `f64`; [`Outcomes`] come from further runs with decisions changed.
//!
//! The data of a float are large and stay in the machine's [`arena`]; lifted code moves handles.
//! That code is compiled once more for every kernel, so an operation in it is one call: methods
//! that are generic over the operation pass it on as a value.

mod affine;
mod arena;
mod arithmetic;
#[cfg(test)]
mod cases;
mod decisions;
#[cfg(test)]
mod fuzz;
mod interval;
mod leaves;
#[cfg(test)]
mod loops;
mod operations;
mod outcome;
mod rounding;
mod sums;

use core::cell::Cell;

use super::scalar::ScalarLoop;
use super::*;
use affine::{Forms, Handle};
use arena::{Arena, Bounded, Mark};
use arithmetic::{bits_of, constant, ordered};
use decisions::Decisions;
use leaves::{Assigned, Copied, Give, Take};

pub(crate) use affine::Form;
pub(crate) use arena::Known;
pub(crate) use decisions::Explored;
pub(crate) use interval::Interval;
pub use outcome::{Leaf, Outcomes, result_leaves};
pub use rounding::Rounding;

/// A truth value on [`Margin`].
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    value: bool,
    /// The id of the open truth value that this one depends on; 0 if it is certain.
    open: u64,
}

impl Truth {
    pub(crate) fn certain(value: bool) -> Self {
        Self { value, open: 0 }
    }

    fn is(self, value: bool) -> bool {
        self.open == 0 && self.value == value
    }
}

/// A loop being executed.
#[derive(Debug)]
pub struct Rounds {
    lane: ScalarLoop,
    /// The start of an iteration's floats.
    begin: Mark,
}

/// A machine of one lane that computes in `f64` and bounds the rounding error of `f32`.
#[derive(Debug)]
pub struct Margin {
    lane: Scalar,
    rounding: Rounding,
    decisions: Decisions,
    pub(crate) floats: Arena,
    pub(crate) forms: Forms,
}

impl Margin {
    /// Creates a machine for variants with this rounding.
    pub fn new(rounding: Rounding) -> Self {
        Self {
            lane: Scalar::default(),
            rounding,
            decisions: Decisions::default(),
            floats: Arena::default(),
            forms: Forms::default(),
        }
    }

    /// Stores a float.
    pub(crate) fn put(&self, known: Known) -> Bounded {
        self.floats.put(known)
    }

    /// Returns the data of a float.
    pub(crate) fn get(&self, float: Bounded) -> Known {
        self.floats.get(float)
    }

    /// Returns the rounding of its variants.
    pub(crate) fn rounding(&self) -> Rounding {
        self.rounding
    }

    /// Decides between two alternatives and returns whether the path takes the second; `f64` takes
    /// the first.
    pub(crate) fn chooses_other(&self) -> bool {
        self.is_running() && self.decisions.choose(2) == 1
    }

    /// Returns the data of a float with a new id.
    pub(crate) fn bounded(&self, value: f64, range: Interval) -> Known {
        Known { value, range, id: self.decisions.fresh(), form: Handle::NONE, parts: None }
    }

    fn point(&self, v: f64) -> Known {
        self.bounded(v, Interval::point(v))
    }

    /// Returns the data of a number of the input or of the scene.
    fn taken(&self, v: f32) -> Known {
        self.bounded(f64::from(v), self.rounding.taken(v))
    }

    /// Marks the run as incomplete: something is open that cannot be followed.
    pub(crate) fn lose(&self) {
        self.decisions.lose();
    }

    pub(crate) fn is_running(&self) -> bool {
        self.lane.active.get()
    }

    /// Runs `f` once per path through its decisions, up to `limit`. The floats of a run are dropped
    /// after it, so its result has none.
    pub(crate) fn each_way<R>(&self, limit: usize, f: &dyn Fn() -> R) -> Explored<R> {
        let active = self.lane.active.replace(true);
        let explored = self.decisions.explore(limit, || {
            self.lane.active.set(true);
            let begin = self.floats.mark();
            let result = f();
            self.floats.drop_since(begin);
            result
        });
        self.lane.active.set(active);
        explored
    }

    /// Returns the truth value of a comparison, open if both results are possible.
    pub(crate) fn truth(&self, value: bool, may_be_true: bool, may_be_false: bool) -> Truth {
        match (may_be_true, may_be_false) {
            (true, true) => Truth { value, open: self.decisions.fresh() },
            (certain, _) => Truth::certain(certain),
        }
    }

    /// Decides a truth value.
    pub(crate) fn decided(&self, t: Truth) -> bool {
        if t.open == 0 || !self.is_running() {
            return t.value;
        }
        t.value ^ self.decisions.flip(t.open)
    }

    /// Returns whether the sign is `-`.
    fn is_negative(&self, a: Known) -> Truth {
        match a.range.is_negative() {
            Some(known) => Truth::certain(known),
            None => self.truth(a.value.is_sign_negative(), true, true),
        }
    }

    /// Returns a truth value with earlier decisions applied.
    fn known(&self, t: Truth) -> Truth {
        match self.decisions.known(t.open) {
            Some(flip) if t.open != 0 => Truth::certain(t.value ^ flip),
            _ => t,
        }
    }
}

impl Machine for Margin {
    type F32 = Bounded;
    type I32 = i32;
    type U32 = u32;
    type Bool = Truth;
    type Branch = Cell<bool>;
    type Loop = Rounds;

    fn f32(&self, v: f32) -> Bounded {
        self.put(self.taken(v))
    }

    fn f32_literal(&self, v: f32, exact: f64) -> Bounded {
        let range = self.rounding.taken(v).hull(Interval::point(exact));
        self.put(self.bounded(exact, range))
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

    #[inline]
    fn f32_unary<O: Op<F32Unary>>(&self, _: O, a: Bounded) -> Bounded {
        self.of_one(O::OP, a)
    }

    #[inline]
    fn f32_binary<O: Op<F32Binary>>(&self, _: O, a: Bounded, b: Bounded) -> Bounded {
        self.of_two(O::OP, a, b)
    }

    fn f32_mul_add(&self, a: Bounded, b: Bounded, c: Bounded) -> Bounded {
        let (a, b, c) = (self.get(a), self.get(b), self.get(c));
        // Bounded as two operations, since a device need not fuse them; `f64` does.
        let product = self.binary(F32Binary::Mul, a, b);
        let sum = self.binary(F32Binary::Add, product, c);
        self.put(self.bounded(a.value.mul_add(b.value, c.value), sum.range))
    }

    #[inline]
    fn i32_binary<O: Op<IntBinary>>(&self, _: O, a: i32, b: i32) -> i32 {
        operations::of_two_i32(O::OP, a, b)
    }

    #[inline]
    fn u32_binary<O: Op<IntBinary>>(&self, _: O, a: u32, b: u32) -> u32 {
        operations::of_two_u32(O::OP, a, b)
    }

    #[inline]
    fn bool_binary<O: Op<BoolBinary>>(&self, _: O, a: Truth, b: Truth) -> Truth {
        self.joined(O::OP, a, b)
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
        a.opposite()
    }

    #[inline]
    fn f32_compare<O: Op<Compare>>(&self, _: O, a: Bounded, b: Bounded) -> Truth {
        self.compared(O::OP, a, b)
    }

    #[inline]
    fn i32_compare<O: Op<Compare>>(&self, _: O, a: i32, b: i32) -> Truth {
        operations::compared_integers(O::OP, a.into(), b.into())
    }

    #[inline]
    fn u32_compare<O: Op<Compare>>(&self, _: O, a: u32, b: u32) -> Truth {
        operations::compared_integers(O::OP, a.into(), b.into())
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
        self.integer(self.get(a), |v| v as i32, i64::from, |v| v as i32, &[0])
    }

    fn f32_to_u32(&self, a: Bounded) -> u32 {
        self.integer(self.get(a), |v| v as u32, i64::from, |v| v as u32, &[0])
    }

    fn i32_to_f32(&self, a: i32) -> Bounded {
        self.put(self.converted(f64::from(a), a as f32))
    }

    fn u32_to_f32(&self, a: u32) -> Bounded {
        self.put(self.converted(f64::from(a), a as f32))
    }

    fn i32_to_u32(&self, a: i32) -> u32 {
        a as u32
    }

    fn u32_to_i32(&self, a: u32) -> i32 {
        a as i32
    }

    fn f32_to_bits(&self, a: Bounded) -> u32 {
        let a = self.get(a);
        // The sign of a NaN depends on the processor, and its other bits on its origin.
        if a.range.nan && self.is_running() {
            self.decisions.lose();
        }
        let nan = f32::NAN.to_bits();
        let nans = [nan, nan | 1 << 31];
        self.integer(a, |v| (v as f32).to_bits(), ordered, bits_of, &nans)
    }

    fn f32_from_bits(&self, a: u32) -> Bounded {
        self.f32(f32::from_bits(a))
    }

    #[inline]
    fn f32_beside_infinity<O: Op<Compare>>(&self, _: O, a: Bounded) -> Truth {
        self.beside_infinity(O::OP, a)
    }

    #[inline]
    fn f32_sign_bit<O: Op<Compare>>(&self, _: O, a: Bounded) -> Truth {
        self.sign_bit(O::OP, a)
    }

    fn f32_copysign(&self, a: Bounded, sign: Bounded) -> Bounded {
        let size = self.size(self.get(a));
        let is_negative = self.decided(self.is_negative(self.get(sign)));
        self.put(if is_negative { self.negated(size) } else { size })
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

    fn loop_begin(&self) -> Rounds {
        Rounds { lane: self.lane.loop_begin(), begin: self.floats.mark() }
    }

    fn loop_test(&self, l: &Rounds, c: Truth) -> bool {
        self.lane.loop_test(&l.lane, self.decided(c))
    }

    fn loop_break(&self, l: &Rounds) {
        self.lane.loop_break(&l.lane);
    }

    fn loop_continue(&self, l: &Rounds) {
        self.lane.loop_continue(&l.lane);
    }

    fn loop_continuing(&self, l: &Rounds) {
        self.lane.loop_continuing(&l.lane);
    }

    fn loop_again(&self, l: &Rounds) -> bool {
        self.floats.drop_since(l.begin);
        if self.is_running() && !self.decisions.round() {
            self.lane.loop_break(&l.lane);
        }
        self.lane.loop_again(&l.lane)
    }

    fn loop_end(&self, l: Rounds) {
        // The last iteration may have ended at the loop's test.
        self.floats.drop_since(l.begin);
        self.lane.loop_end(l.lane);
    }

    fn alive(&self) -> bool {
        self.lane.alive()
    }

    fn any(&self, c: Truth) -> bool {
        self.lane.any(self.decided(c))
    }

    #[inline]
    fn var_new<V: Value<Self>>(&self, _: &'static str, v: V) -> V {
        V::zip(self, v, v, &mut Copied)
    }

    #[inline]
    fn var_declare<V: Value<Self>>(&self, _: &'static str) -> V {
        self.give_slot()
    }

    #[inline]
    fn var_get<V: Value<Self>>(&self, state: V) -> V {
        V::zip(self, state, state, &mut Copied)
    }

    #[inline]
    fn var_set<V: Value<Self>>(&self, state: V, v: V) -> V {
        if self.is_running() { V::zip(self, v, state, &mut Assigned) } else { state }
    }

    #[inline]
    fn give<V: Value<Self>>(&self, slot: &Cell<V>, v: V) {
        if self.is_running() {
            slot.set(V::zip(self, v, slot.get(), &mut Assigned));
            self.lane.active.set(false);
        }
    }

    #[inline]
    fn give_slot<V: Value<Self>>(&self) -> V {
        // The zeros of an array share one entry; slots must not.
        let zero = V::zero(self);
        V::zip(self, zero, zero, &mut Copied)
    }

    fn call<A: Value<Self>, R: Value<Self>>(
        &self,
        info: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        // Known functions are of floats: others are spared this.
        if const { A::SCHEMA.is_of_floats() }
            && let Some(known) = info.known
        {
            let mut floats = Take(Vec::new());
            A::zip(self, args, args, &mut floats);
            if let Some(results) = self.results(known, &floats.0) {
                let zero = R::zero(self);
                return R::zip(self, zero, zero, &mut Give(results.into_iter()));
            }
        }
        let entry = self.is_running();
        let result = body(self, args);
        self.lane.active.set(entry);
        result
    }

    #[inline(always)]
    fn perform<O: Operation>(
        &self,
        operation: &O,
        input: On<O::Input, Self>,
    ) -> On<O::Output, Self> {
        operation.on_margin(self, input)
    }
    fn visit<T: Visit>(
        &self,
        items: &T,
        input: On<T::Input, Self>,
        limit: impl Fn() -> F<Self>,
        visit: impl Fn(On<T::Item, Self>) -> B<Self>,
    ) {
        items.on_margin(self, input, limit, visit);
    }

    fn off_by(&self, v: Bounded, absolute: f32, relative: f32) -> Bounded {
        // Packets and scalar code have no samplers.
        if self.rounding.is_strict {
            return v;
        }
        let v = self.get(v);
        let most = f64::from(absolute) + f64::from(relative) * v.range.magnitude();
        self.put(self.bounded(v.value, v.range.widened(most)))
    }

    fn fetch<D: Data>(
        &self,
        data: &D,
        index: U<Self>,
    ) -> <D::Element as crate::machine::Type>::On<Self> {
        if data.count() == 0 {
            return Value::zero(self);
        }
        D::Element::splat(self, data.get(index.0))
    }
}
