//! The scalar machine: one lane of plain numbers.

use core::cell::Cell;

use super::*;

/// A machine of one lane with plain Rust numbers: a cross-check of the lowering.
///
/// The scalar *variant* of a kernel is the user's own function; this machine runs the lifted body
/// and must agree with it.
#[derive(Clone, Debug)]
pub struct Scalar {
    pub(super) active: Cell<bool>,
}

impl Default for Scalar {
    fn default() -> Self {
        Self { active: Cell::new(true) }
    }
}

/// The lanes that left a loop, and those that skip to its next iteration.
#[derive(Debug, Default)]
pub struct ScalarLoop {
    exited: Cell<bool>,
    continued: Cell<bool>,
}

macro_rules! int_binary {
    ($name:ident, $t:ty) => {
        /// Returns Rust's result, `None` where it panics, and the defined result of every
        /// operation.
        #[inline(always)]
        pub(super) fn $name(op: IntBinary, a: $t, b: $t) -> (Option<$t>, $t) {
            let shift = b as u32 & 31;
            let fits = (0..32).contains(&b);
            match op {
                IntBinary::Add => (a.checked_add(b), a.wrapping_add(b)),
                IntBinary::Sub => (a.checked_sub(b), a.wrapping_sub(b)),
                IntBinary::Mul => (a.checked_mul(b), a.wrapping_mul(b)),
                IntBinary::Div => (a.checked_div(b), if b == 0 { a } else { a.wrapping_div(b) }),
                IntBinary::Rem => (a.checked_rem(b), if b == 0 { 0 } else { a.wrapping_rem(b) }),
                IntBinary::And => (Some(a & b), a & b),
                IntBinary::Or => (Some(a | b), a | b),
                IntBinary::Xor => (Some(a ^ b), a ^ b),
                IntBinary::Shl => (fits.then_some(a << shift), a << shift),
                IntBinary::Shr => (fits.then_some(a >> shift), a >> shift),
                IntBinary::WrappingAdd => (Some(a.wrapping_add(b)), a.wrapping_add(b)),
                IntBinary::WrappingSub => (Some(a.wrapping_sub(b)), a.wrapping_sub(b)),
                IntBinary::WrappingMul => (Some(a.wrapping_mul(b)), a.wrapping_mul(b)),
            }
        }
    };
}

int_binary!(i32_binary, i32);
int_binary!(u32_binary, u32);

/// Panics with the error of a kernel's integer operation.
#[cold]
#[inline(never)]
#[track_caller]
pub(super) fn integer_error(op: IntBinary, lane: usize) -> ! {
    let what = match op {
        IntBinary::Div => "division by zero or overflow",
        IntBinary::Rem => "remainder by zero or overflow",
        IntBinary::Shl | IntBinary::Shr => "shift by 32 bits or more",
        _ => "overflow",
    };
    panic!("integer {what} in lane {lane} of a kernel; use wrapping_* where it is meant")
}

/// Panics for an index out of range in a running lane.
#[cold]
#[inline(never)]
#[track_caller]
pub(super) fn index_error(index: u32, len: u32, lane: usize) -> ! {
    panic!("index {index} is out of range for {len} elements in lane {lane} of a kernel")
}

impl Machine for Scalar {
    type F32 = f32;
    type I32 = i32;
    type U32 = u32;
    type Bool = bool;
    type Branch = Cell<bool>;
    type Loop = ScalarLoop;

    #[inline(always)]
    fn f32(&self, v: f32) -> f32 {
        v
    }
    #[inline(always)]
    fn i32(&self, v: i32) -> i32 {
        v
    }
    #[inline(always)]
    fn u32(&self, v: u32) -> u32 {
        v
    }
    #[inline(always)]
    fn bool(&self, v: bool) -> bool {
        v
    }
    #[inline(always)]
    fn f32_unary<O: Op<F32Unary>>(&self, _: O, a: f32) -> f32 {
        O::OP.of(a)
    }
    #[inline(always)]
    fn f32_binary<O: Op<F32Binary>>(&self, _: O, a: f32, b: f32) -> f32 {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn f32_mul_add(&self, a: f32, b: f32, c: f32) -> f32 {
        a.mul_add(b, c)
    }
    #[inline(always)]
    fn i32_binary<O: Op<IntBinary>>(&self, _: O, a: i32, b: i32) -> i32 {
        let (checked, defined) = i32_binary(O::OP, a, b);
        if cfg!(debug_assertions) && checked.is_none() && self.active.get() {
            integer_error(O::OP, 0);
        }
        defined
    }
    #[inline(always)]
    fn u32_binary<O: Op<IntBinary>>(&self, _: O, a: u32, b: u32) -> u32 {
        let (checked, defined) = u32_binary(O::OP, a, b);
        if cfg!(debug_assertions) && checked.is_none() && self.active.get() {
            integer_error(O::OP, 0);
        }
        defined
    }
    #[inline(always)]
    fn bool_binary<O: Op<BoolBinary>>(&self, _: O, a: bool, b: bool) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn i32_neg(&self, a: i32) -> i32 {
        self.i32_binary(op::Sub, 0, a)
    }
    #[inline(always)]
    fn i32_not(&self, a: i32) -> i32 {
        !a
    }
    #[inline(always)]
    fn u32_not(&self, a: u32) -> u32 {
        !a
    }
    #[inline(always)]
    fn bool_not(&self, a: bool) -> bool {
        !a
    }
    #[inline(always)]
    fn f32_compare<O: Op<Compare>>(&self, _: O, a: f32, b: f32) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn i32_compare<O: Op<Compare>>(&self, _: O, a: i32, b: i32) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn u32_compare<O: Op<Compare>>(&self, _: O, a: u32, b: u32) -> bool {
        O::OP.of(a, b)
    }
    #[inline(always)]
    fn f32_select(&self, c: bool, a: f32, b: f32) -> f32 {
        if c { a } else { b }
    }
    #[inline(always)]
    fn i32_select(&self, c: bool, a: i32, b: i32) -> i32 {
        if c { a } else { b }
    }
    #[inline(always)]
    fn u32_select(&self, c: bool, a: u32, b: u32) -> u32 {
        if c { a } else { b }
    }
    #[inline(always)]
    fn bool_select(&self, c: bool, a: bool, b: bool) -> bool {
        if c { a } else { b }
    }
    #[inline(always)]
    fn f32_to_i32(&self, a: f32) -> i32 {
        a as i32
    }
    #[inline(always)]
    fn f32_to_u32(&self, a: f32) -> u32 {
        a as u32
    }
    #[inline(always)]
    fn i32_to_f32(&self, a: i32) -> f32 {
        a as f32
    }
    #[inline(always)]
    fn u32_to_f32(&self, a: u32) -> f32 {
        a as f32
    }
    #[inline(always)]
    fn i32_to_u32(&self, a: i32) -> u32 {
        a as u32
    }
    #[inline(always)]
    fn u32_to_i32(&self, a: u32) -> i32 {
        a as i32
    }
    #[inline(always)]
    fn f32_to_bits(&self, a: f32) -> u32 {
        a.to_bits()
    }
    #[inline(always)]
    fn f32_from_bits(&self, a: u32) -> f32 {
        f32::from_bits(a)
    }
    #[inline(always)]
    fn bool_to_u32(&self, a: bool) -> u32 {
        u32::from(a)
    }

    #[inline(always)]
    fn branch(&self, c: bool) -> Cell<bool> {
        let old = self.active.get();
        self.active.set(old & c);
        Cell::new(old & !c)
    }
    #[inline(always)]
    fn branch_then(&self, _: &Cell<bool>) -> bool {
        self.active.get()
    }
    #[inline(always)]
    fn branch_else(&self, rest: &Cell<bool>) -> bool {
        self.active.swap(rest);
        self.active.get()
    }
    #[inline(always)]
    fn choose<V: Value<Self>>(
        &self,
        _: &'static str,
        _: bool,
        c: B<Self>,
        a: impl FnOnce() -> V,
        b: impl FnOnce() -> V,
    ) -> V {
        if c.0 { a() } else { b() }
    }
    #[inline(always)]
    fn branch_end(&self, rest: Cell<bool>) {
        self.active.set(self.active.get() | rest.get());
    }
    #[inline(always)]
    fn loop_begin(&self) -> ScalarLoop {
        ScalarLoop::default()
    }
    #[inline(always)]
    fn loop_test(&self, l: &ScalarLoop, c: bool) -> bool {
        if !c {
            self.loop_break(l);
        }
        self.active.get()
    }
    #[inline(always)]
    fn loop_break(&self, l: &ScalarLoop) {
        l.exited.set(l.exited.get() | self.active.replace(false));
    }
    #[inline(always)]
    fn loop_continue(&self, l: &ScalarLoop) {
        l.continued.set(l.continued.get() | self.active.replace(false));
    }
    #[inline(always)]
    fn loop_continuing(&self, l: &ScalarLoop) {
        self.active.set(self.active.get() | l.continued.replace(false));
    }
    #[inline(always)]
    fn loop_again(&self, _: &ScalarLoop) -> bool {
        self.active.get()
    }
    #[inline(always)]
    fn loop_end(&self, l: ScalarLoop) {
        self.active.set(l.exited.get());
    }
    #[inline(always)]
    fn alive(&self) -> bool {
        self.active.get()
    }
    #[inline(always)]
    fn any(&self, c: bool) -> bool {
        self.active.get() & c
    }
    #[inline(always)]
    fn check_index(&self, index: &u32, len: u32) {
        if cfg!(debug_assertions) && self.active.get() && *index >= len {
            index_error(*index, len, 0);
        }
    }

    #[inline(always)]
    fn guarded<R>(&self, c: bool, when: bool, f: impl FnOnce() -> R) -> R {
        let old = self.active.replace(self.active.get() & (c == when));
        let result = f();
        self.active.set(old);
        result
    }

    #[inline(always)]
    fn var_new<V: Value<Self>>(&self, _: &'static str, v: V) -> V {
        v
    }
    #[inline(always)]
    fn var_declare<V: Value<Self>>(&self, _: &'static str) -> V {
        V::zero(self)
    }
    #[inline(always)]
    fn var_get<V: Value<Self>>(&self, state: V) -> V {
        state
    }
    #[inline(always)]
    fn var_set<V: Value<Self>>(&self, state: V, v: V) -> V {
        if self.active.get() { v } else { state }
    }
    #[inline(always)]
    fn give<V: Value<Self>>(&self, slot: &Cell<V>, v: V) {
        if self.active.replace(false) {
            slot.set(v);
        }
    }
    #[inline(always)]
    fn give_slot<V: Value<Self>>(&self) -> V {
        V::zero(self)
    }
    #[inline(always)]
    fn call<A: Value<Self>, R: Value<Self>>(
        &self,
        _: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        let entry = self.active.get();
        let result = body(self, args);
        self.active.set(entry);
        result
    }

    #[inline(always)]
    fn perform<O: Operation>(
        &self,
        operation: &O,
        input: On<O::Input, Self>,
    ) -> On<O::Output, Self> {
        operation.on_scalar(self, input)
    }
    fn visit<T: Visit>(
        &self,
        items: &T,
        input: On<T::Input, Self>,
        limit: impl Fn() -> F<Self>,
        visit: impl Fn(On<T::Item, Self>) -> B<Self>,
    ) {
        items.on_scalar(self, input, limit, visit);
    }
    #[inline(always)]
    fn fetch<D: Data>(&self, data: &D, index: U<Self>) -> <D::Element as Type>::On<Self> {
        if data.count() == 0 {
            return Value::zero(self);
        }
        D::Element::splat(self, data.get(index.0))
    }
}

impl LaneMachine for Scalar {
    const LANES: usize = 1;

    #[inline(always)]
    fn f32_from_fn(&self, mut f: impl FnMut(usize) -> f32) -> f32 {
        f(0)
    }
    #[inline(always)]
    fn i32_from_fn(&self, mut f: impl FnMut(usize) -> i32) -> i32 {
        f(0)
    }
    #[inline(always)]
    fn u32_from_fn(&self, mut f: impl FnMut(usize) -> u32) -> u32 {
        f(0)
    }
    #[inline(always)]
    fn bool_from_fn(&self, mut f: impl FnMut(usize) -> bool) -> bool {
        f(0)
    }
    #[inline(always)]
    fn f32_lane(v: &f32, _: usize) -> f32 {
        *v
    }
    #[inline(always)]
    fn i32_lane(v: &i32, _: usize) -> i32 {
        *v
    }
    #[inline(always)]
    fn u32_lane(v: &u32, _: usize) -> u32 {
        *v
    }
    #[inline(always)]
    fn bool_lane(v: &bool, _: usize) -> bool {
        *v
    }
}
