//! SIMD packets with masked control flow: one register per value and an active mask.

use core::cell::Cell;

use super::types::from_each_lane;
use super::*;

/// A machine of [`Lanes::N`] lanes with masked control flow.
///
/// The mask algebra: an `if` holds one mask, the lanes of the arm that is not running. `begin`
/// splits the running lanes by the condition, `else` swaps the halves, `end` joins their remaining
/// lanes. `return`, `break` and `continue` only remove lanes from the active mask; loops and the
/// end of the function restore them.
#[derive(Clone)]
pub struct Packet<L: Lanes> {
    lanes: L,
    active: Cell<L::Mask>,
}

/// The lanes that left a loop, and those that skip to its next iteration.
pub struct PacketLoop<L: Lanes> {
    exited: Cell<L::Mask>,
    continued: Cell<L::Mask>,
}

impl<L: Lanes> Packet<L> {
    /// Creates a packet with all lanes running.
    #[inline(always)]
    pub fn new(lanes: L) -> Self {
        Self { lanes, active: Cell::new(lanes.mask(true)) }
    }

    /// Creates a packet with the first `count` lanes running.
    #[inline(always)]
    pub fn with_count(lanes: L, count: usize) -> Self {
        let bits = if count >= 64 { u64::MAX } else { (1 << count) - 1 };
        Self::with_bits(lanes, bits)
    }

    /// Creates a packet with the lanes of the set bits running.
    #[inline(always)]
    pub fn with_bits(lanes: L, bits: u64) -> Self {
        let all = if L::N >= 64 { u64::MAX } else { (1 << L::N) - 1 };
        Self { lanes, active: Cell::new(lanes.mask_from_bits(bits & all)) }
    }

    /// Creates a packet with the active mask `active`.
    #[inline(always)]
    pub(crate) fn with_mask(lanes: L, active: L::Mask) -> Self {
        Self { lanes, active: Cell::new(active) }
    }

    /// Returns the lane operations.
    #[inline(always)]
    pub fn lanes(&self) -> L {
        self.lanes
    }

    /// Returns the active mask.
    #[inline(always)]
    pub fn active(&self) -> L::Mask {
        self.active.get()
    }

    /// Runs `f` under the active mask `mask`.
    #[inline(always)]
    pub(crate) fn with_active<R>(&self, mask: L::Mask, f: impl FnOnce() -> R) -> R {
        let old = self.active.replace(mask);
        let result = f();
        self.active.set(old);
        result
    }

    #[inline(always)]
    fn and(&self, a: L::Mask, b: L::Mask) -> L::Mask {
        self.lanes.mask_binary(op::And, a, b)
    }

    #[inline(always)]
    fn or(&self, a: L::Mask, b: L::Mask) -> L::Mask {
        self.lanes.mask_binary(op::Or, a, b)
    }

    /// Returns `of_lane` of each running lane, and `other` in the rest.
    #[inline(always)]
    pub(crate) fn of_running<T: Type>(
        &self,
        other: T,
        of_lane: impl Fn(usize) -> T,
    ) -> T::On<Self> {
        let active = self.lanes.bits(self.active.get());
        from_each_lane(
            self,
            #[inline(always)]
            |lane| if active >> lane & 1 != 0 { of_lane(lane) } else { other },
        )
    }

    #[inline(always)]
    fn is_running(&self) -> bool {
        self.lanes.any(self.active.get())
    }

    /// Stops all running lanes and returns them.
    #[inline(always)]
    fn stop(&self) -> L::Mask {
        self.active.replace(self.lanes.mask(false))
    }

    /// Panics for the first running lane in which Rust would panic.
    ///
    /// Not inlined: its loop over lanes at every operator would be most of the code.
    #[inline(never)]
    fn check(&self, op: IntBinary, is_error: &dyn Fn(usize) -> bool) {
        let active = self.lanes.bits(self.active.get());
        for lane in 0..L::N {
            if active >> lane & 1 != 0 && is_error(lane) {
                scalar::integer_error(op, lane);
            }
        }
    }
}

/// Implements the checks of both integer types.
impl<L: Lanes> Packet<L> {
    #[inline(never)]
    fn check_i32(&self, op: IntBinary, a: &L::I32, b: &L::I32) {
        let fails = |l| scalar::i32_binary(op, L::i32_lane(a, l), L::i32_lane(b, l)).0.is_none();
        self.check(op, &fails);
    }

    #[inline(never)]
    fn check_u32(&self, op: IntBinary, a: &L::U32, b: &L::U32) {
        let fails = |l| scalar::u32_binary(op, L::u32_lane(a, l), L::u32_lane(b, l)).0.is_none();
        self.check(op, &fails);
    }
}

impl<L: Lanes> Packet<L> {
    #[inline(never)]
    fn check_indices(&self, index: &L::U32, len: u32) {
        let active = self.lanes.bits(self.active.get());
        for lane in (0..L::N).filter(|l| active >> l & 1 != 0) {
            let index = L::u32_lane(index, lane);
            if index >= len {
                scalar::index_error(index, len, lane);
            }
        }
    }
}

/// Returns whether Rust panics for some operands.
const fn is_checked(op: IntBinary) -> bool {
    use IntBinary::{Add, Div, Mul, Rem, Shl, Shr, Sub};
    cfg!(debug_assertions) && matches!(op, Add | Sub | Mul | Div | Rem | Shl | Shr)
}

const UNORM8: [f32; 2] = reciprocal(0xff);
const UNORM16: [f32; 2] = reciprocal(0xffff);

/// Returns `1 / max` as a sum of two numbers. The first is so short that its product with a code up
/// to `max` is exact, and the second so small that `code * high + code * low` is `code / max` for
/// each code: a test tries all. Divisions take as long as ten products.
const fn reciprocal(max: u32) -> [f32; 2] {
    let whole = 1.0 / max as f64;
    // An f32 has 24 bits, a code takes some of them, and an f64 has 53.
    let bits = 24 - (u32::BITS - max.leading_zeros());
    let high = f64::from_bits(whole.to_bits() & (u64::MAX << (53 - bits)));
    [high as f32, (whole - high) as f32]
}

/// Runs a kernel's body as a function of its own, compiled for the level once for all of its calls.
#[inline(never)]
fn apart<L: Lanes, A, R>(m: &Packet<L>, args: A, body: impl FnOnce(&Packet<L>, A) -> R) -> R {
    m.lanes.enter_again(
        #[inline(always)]
        || body(m, args),
    )
}

struct Blend<Mask>(Mask);

impl<L: Lanes> Leaves<Packet<L>> for Blend<L::Mask> {
    #[inline(always)]
    fn f32(&mut self, m: &Packet<L>, a: L::F32, b: L::F32) -> L::F32 {
        m.lanes.f32_select(self.0, b, a)
    }
    #[inline(always)]
    fn i32(&mut self, m: &Packet<L>, a: L::I32, b: L::I32) -> L::I32 {
        m.lanes.i32_select(self.0, b, a)
    }
    #[inline(always)]
    fn u32(&mut self, m: &Packet<L>, a: L::U32, b: L::U32) -> L::U32 {
        m.lanes.u32_select(self.0, b, a)
    }
    #[inline(always)]
    fn bool(&mut self, m: &Packet<L>, a: L::Mask, b: L::Mask) -> L::Mask {
        m.bool_select(self.0, b, a)
    }
}

impl<L: Lanes> Machine for Packet<L> {
    type F32 = L::F32;
    type I32 = L::I32;
    type U32 = L::U32;
    type Bool = L::Mask;
    type Branch = Cell<L::Mask>;
    type Loop = PacketLoop<L>;

    #[inline(always)]
    fn f32(&self, v: f32) -> L::F32 {
        self.lanes.f32(v)
    }
    #[inline(always)]
    fn i32(&self, v: i32) -> L::I32 {
        self.lanes.i32(v)
    }
    #[inline(always)]
    fn u32(&self, v: u32) -> L::U32 {
        self.lanes.u32(v)
    }
    #[inline(always)]
    fn bool(&self, v: bool) -> L::Mask {
        self.lanes.mask(v)
    }
    #[inline(always)]
    fn f32_unary<O: Op<F32Unary>>(&self, op: O, a: L::F32) -> L::F32 {
        self.lanes.f32_unary(op, a)
    }
    #[inline(always)]
    fn f32_binary<O: Op<F32Binary>>(&self, op: O, a: L::F32, b: L::F32) -> L::F32 {
        self.lanes.f32_binary(op, a, b)
    }
    #[inline(always)]
    fn f32_mul_add(&self, a: L::F32, b: L::F32, c: L::F32) -> L::F32 {
        self.lanes.f32_mul_add(a, b, c)
    }
    #[inline(always)]
    fn i32_binary<O: Op<IntBinary>>(&self, op: O, a: L::I32, b: L::I32) -> L::I32 {
        if const { is_checked(O::OP) } {
            self.check_i32(O::OP, &a, &b);
        }
        self.lanes.i32_binary(op, a, b)
    }
    #[inline(always)]
    fn u32_binary<O: Op<IntBinary>>(&self, op: O, a: L::U32, b: L::U32) -> L::U32 {
        if const { is_checked(O::OP) } {
            self.check_u32(O::OP, &a, &b);
        }
        self.lanes.u32_binary(op, a, b)
    }
    #[inline(always)]
    fn bool_binary<O: Op<BoolBinary>>(&self, op: O, a: L::Mask, b: L::Mask) -> L::Mask {
        self.lanes.mask_binary(op, a, b)
    }
    #[inline(always)]
    fn i32_neg(&self, a: L::I32) -> L::I32 {
        self.i32_binary(op::Sub, self.lanes.i32(0), a)
    }
    #[inline(always)]
    fn i32_not(&self, a: L::I32) -> L::I32 {
        self.lanes.i32_binary(op::Xor, a, self.lanes.i32(-1))
    }
    #[inline(always)]
    fn u32_not(&self, a: L::U32) -> L::U32 {
        self.lanes.u32_binary(op::Xor, a, self.lanes.u32(u32::MAX))
    }
    #[inline(always)]
    fn bool_not(&self, a: L::Mask) -> L::Mask {
        self.lanes.mask_not(a)
    }
    #[inline(always)]
    fn f32_compare<O: Op<Compare>>(&self, op: O, a: L::F32, b: L::F32) -> L::Mask {
        self.lanes.f32_compare(op, a, b)
    }
    #[inline(always)]
    fn i32_compare<O: Op<Compare>>(&self, op: O, a: L::I32, b: L::I32) -> L::Mask {
        self.lanes.i32_compare(op, a, b)
    }
    #[inline(always)]
    fn u32_compare<O: Op<Compare>>(&self, op: O, a: L::U32, b: L::U32) -> L::Mask {
        self.lanes.u32_compare(op, a, b)
    }
    #[inline(always)]
    fn f32_select(&self, c: L::Mask, a: L::F32, b: L::F32) -> L::F32 {
        self.lanes.f32_select(c, a, b)
    }
    #[inline(always)]
    fn i32_select(&self, c: L::Mask, a: L::I32, b: L::I32) -> L::I32 {
        self.lanes.i32_select(c, a, b)
    }
    #[inline(always)]
    fn u32_select(&self, c: L::Mask, a: L::U32, b: L::U32) -> L::U32 {
        self.lanes.u32_select(c, a, b)
    }
    #[inline(always)]
    fn bool_select(&self, c: L::Mask, a: L::Mask, b: L::Mask) -> L::Mask {
        self.or(self.and(c, a), self.and(self.lanes.mask_not(c), b))
    }
    #[inline(always)]
    fn f32_to_i32(&self, a: L::F32) -> L::I32 {
        self.lanes.f32_to_i32(a)
    }
    #[inline(always)]
    fn f32_to_u32(&self, a: L::F32) -> L::U32 {
        self.lanes.f32_to_u32(a)
    }
    #[inline(always)]
    fn i32_to_f32(&self, a: L::I32) -> L::F32 {
        self.lanes.i32_to_f32(a)
    }
    #[inline(always)]
    fn u32_to_f32(&self, a: L::U32) -> L::F32 {
        self.lanes.u32_to_f32(a)
    }
    #[inline(always)]
    fn i32_to_u32(&self, a: L::I32) -> L::U32 {
        self.lanes.i32_to_u32(a)
    }
    #[inline(always)]
    fn u32_to_i32(&self, a: L::U32) -> L::I32 {
        self.lanes.u32_to_i32(a)
    }
    #[inline(always)]
    fn f32_to_bits(&self, a: L::F32) -> L::U32 {
        self.lanes.f32_to_bits(a)
    }
    #[inline(always)]
    fn f32_from_bits(&self, a: L::U32) -> L::F32 {
        self.lanes.f32_from_bits(a)
    }
    #[inline(always)]
    fn bool_to_u32(&self, a: L::Mask) -> L::U32 {
        self.lanes.u32_select(a, self.lanes.u32(1), self.lanes.u32(0))
    }

    #[inline(always)]
    fn branch(&self, c: L::Mask) -> Cell<L::Mask> {
        let old = self.active.get();
        self.active.set(self.and(old, c));
        Cell::new(self.and(old, self.lanes.mask_not(c)))
    }
    #[inline(always)]
    fn branch_then(&self, _: &Cell<L::Mask>) -> bool {
        self.is_running()
    }
    #[inline(always)]
    fn branch_else(&self, rest: &Cell<L::Mask>) -> bool {
        self.active.swap(rest);
        self.is_running()
    }
    #[inline(always)]
    fn choose<V: Value<Self>>(
        &self,
        _: &'static str,
        calls: bool,
        c: B<Self>,
        a: impl FnOnce() -> V,
        b: impl FnOnce() -> V,
    ) -> V {
        let (a, b) = if calls {
            let active = self.active.get();
            let others = self.and(active, self.lanes.mask_not(c.0));
            (self.with_active(self.and(active, c.0), a), self.with_active(others, b))
        } else {
            (self.guarded(c.0, true, a), self.guarded(c.0, false, b))
        };
        index::choose(self, c.0, a, b)
    }
    #[inline(always)]
    fn branch_then_small(&self, _: &Cell<L::Mask>) -> bool {
        true
    }
    #[inline(always)]
    fn branch_else_small(&self, rest: &Cell<L::Mask>) -> bool {
        self.active.swap(rest);
        true
    }
    #[inline(always)]
    fn branch_end(&self, rest: Cell<L::Mask>) {
        self.active.set(self.or(self.active.get(), rest.get()));
    }
    #[inline(always)]
    fn loop_begin(&self) -> PacketLoop<L> {
        let none = self.lanes.mask(false);
        PacketLoop { exited: Cell::new(none), continued: Cell::new(none) }
    }
    #[inline(always)]
    fn loop_test(&self, l: &PacketLoop<L>, c: L::Mask) -> bool {
        let old = self.active.get();
        self.active.set(self.and(old, c));
        l.exited.set(self.or(l.exited.get(), self.and(old, self.lanes.mask_not(c))));
        self.is_running()
    }
    #[inline(always)]
    fn loop_break(&self, l: &PacketLoop<L>) {
        l.exited.set(self.or(l.exited.get(), self.stop()));
    }
    #[inline(always)]
    fn loop_continue(&self, l: &PacketLoop<L>) {
        l.continued.set(self.or(l.continued.get(), self.stop()));
    }
    #[inline(always)]
    fn loop_continuing(&self, l: &PacketLoop<L>) {
        let back = l.continued.replace(self.lanes.mask(false));
        self.active.set(self.or(self.active.get(), back));
    }
    #[inline(always)]
    fn loop_again(&self, _: &PacketLoop<L>) -> bool {
        self.is_running()
    }
    #[inline(always)]
    fn loop_end(&self, l: PacketLoop<L>) {
        self.active.set(l.exited.get());
    }
    #[inline(always)]
    fn alive(&self) -> bool {
        L::STRAIGHT || self.is_running()
    }
    #[inline(always)]
    fn any(&self, c: L::Mask) -> bool {
        self.lanes.any(self.and(self.active.get(), c))
    }
    #[inline(always)]
    fn u32_same(&self, a: &L::U32) -> Option<u32> {
        let first = L::u32_lane(a, 0);
        let other = self.lanes.u32_compare(op::Ne, *a, self.lanes.u32(first));
        (!self.lanes.any(other)).then_some(first)
    }
    #[inline(always)]
    fn check_index(&self, index: &L::U32, len: u32) {
        if cfg!(debug_assertions) {
            self.check_indices(index, len);
        }
    }

    #[inline(always)]
    fn at(&self, place: Place) {
        self.lanes.at(place, self.active.get());
    }

    #[inline(always)]
    fn guarded<R>(&self, c: L::Mask, when: bool, f: impl FnOnce() -> R) -> R {
        let c = if when { c } else { self.lanes.mask_not(c) };
        self.with_active(self.and(self.active.get(), c), f)
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
        V::zip(self, state, v, &mut Blend(self.active.get()))
    }
    #[inline(always)]
    fn give<V: Value<Self>>(&self, slot: &Cell<V>, v: V) {
        slot.set(self.var_set(slot.get(), v));
        self.stop();
    }
    #[inline(always)]
    fn give_slot<V: Value<Self>>(&self) -> V {
        V::zero(self)
    }
    #[inline(always)]
    fn f32_beside_infinity<O: Op<Compare>>(&self, op: O, a: L::F32) -> L::Mask {
        // Compares as floats: a mask of integers would have to be converted.
        let l = self.lanes;
        let (size, infinity) = (l.f32_unary(op::Abs, a), l.f32(f32::INFINITY));
        match O::OP {
            Compare::Gt => l.f32_compare(op::Ne, a, a),
            Compare::Ge => l.mask_not(l.f32_compare(op::Lt, size, infinity)),
            _ => l.f32_compare(op, size, infinity),
        }
    }
    #[inline(always)]
    fn call<A: Value<Self>, R: Value<Self>>(
        &self,
        _: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        let entry = self.active.get();
        let result = self.lanes.vectorize(
            #[inline(always)]
            || body(self, args),
        );
        self.active.set(entry);
        result
    }

    #[inline(always)]
    fn call_apart<A: Value<Self>, R: Value<Self>>(
        &self,
        _: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        let entry = self.active.get();
        let result = apart(self, args, body);
        self.active.set(entry);
        result
    }

    #[inline(always)]
    fn call_within<A: Value<Self>, R: Value<Self>>(
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
        operation.on_packet(self, input)
    }
    #[inline(always)]
    fn visit<T: Visit>(
        &self,
        items: &T,
        input: On<T::Input, Self>,
        limit: impl Fn() -> F<Self>,
        visit: impl Fn(On<T::Item, Self>) -> B<Self>,
    ) {
        items.on_packet(self, input, limit, visit);
    }
    #[inline(always)]
    fn unorm(&self, code: L::U32, max: u32) -> L::F32 {
        let l = self.lanes;
        let [high, low] = match max {
            0xff => UNORM8,
            0xffff => UNORM16,
            _ => return l.f32_binary(op::Div, l.u32_to_f32(code), l.f32(max as f32)),
        };
        let code = l.i32_to_f32(l.u32_to_i32(code));
        let high = l.f32_binary(op::Mul, code, l.f32(high));
        l.f32_binary(op::Add, high, l.f32_binary(op::Mul, code, l.f32(low)))
    }

    #[inline(always)]
    fn element<D: Data>(&self, data: &D, index: U<Self>) -> <D::Element as Type>::On<Self> {
        let count = u32::try_from(data.count()).unwrap_or(u32::MAX);
        self.check_index(&index.0, count);
        if count == 0 {
            return Value::zero(self);
        }
        let last = self.lanes.u32(count - 1);
        let within = self.lanes.u32_compare(op::Le, index.0, last);
        let index = U(self.lanes.u32_select(within, index.0, last));
        self.fetch_by(
            index,
            #[inline(always)]
            // SAFETY: no lane of `index` is above `last`, running or not: lanes compare and select
            // as they say.
            |i| unsafe { data.get_unchecked(i) },
        )
    }

    #[inline(always)]
    fn fetch<D: Data>(&self, data: &D, index: U<Self>) -> <D::Element as Type>::On<Self> {
        if data.count() == 0 {
            return Value::zero(self);
        }
        self.fetch_by(
            index,
            #[inline(always)]
            |i| data.get(i),
        )
    }
}

impl<L: Lanes> Packet<L> {
    /// Returns what `get` gives for the index of each running lane; it is called for no other.
    #[inline(always)]
    fn fetch_by<T: Type>(&self, index: U<Self>, get: impl Fn(u32) -> T) -> T::On<Self> {
        let active = self.active.get();
        if !self.lanes.any(active) {
            return Value::zero(self);
        }
        let first = self.lanes.bits(active).trailing_zeros() as usize % L::N;
        let first = L::u32_lane(&index.0, first);
        // A loop's counter is the same in all lanes.
        let same = self.lanes.u32_compare(op::Eq, index.0, self.lanes.u32(first));
        if !self.lanes.any(self.and(active, self.lanes.mask_not(same))) {
            return T::splat(self, get(first));
        }
        // A lane that is not running may hold any index.
        let index = self.lanes.u32_select(active, index.0, self.lanes.u32(first));
        from_each_lane(
            self,
            #[inline(always)]
            |lane| get(L::u32_lane(&index, lane)),
        )
    }
}

impl<L: Lanes> LaneMachine for Packet<L> {
    const LANES: usize = L::N;

    #[inline(always)]
    fn f32_from_fn(&self, f: impl FnMut(usize) -> f32) -> L::F32 {
        self.lanes.f32_from_fn(f)
    }
    #[inline(always)]
    fn i32_from_fn(&self, f: impl FnMut(usize) -> i32) -> L::I32 {
        self.lanes.i32_from_fn(f)
    }
    #[inline(always)]
    fn u32_from_fn(&self, f: impl FnMut(usize) -> u32) -> L::U32 {
        self.lanes.u32_from_fn(f)
    }
    #[inline(always)]
    fn bool_from_fn(&self, mut f: impl FnMut(usize) -> bool) -> L::Mask {
        let bits = (0..L::N).fold(0, |bits, l| bits | u64::from(f(l)) << l);
        self.lanes.mask_from_bits(bits)
    }
    #[inline(always)]
    fn f32_lane(v: &L::F32, lane: usize) -> f32 {
        L::f32_lane(v, lane)
    }
    #[inline(always)]
    fn i32_lane(v: &L::I32, lane: usize) -> i32 {
        L::i32_lane(v, lane)
    }
    #[inline(always)]
    fn u32_lane(v: &L::U32, lane: usize) -> u32 {
        L::u32_lane(v, lane)
    }
    #[inline(always)]
    fn bool_lane(v: &L::Mask, lane: usize) -> bool {
        L::mask_lane(v, lane)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_divided() {
        for (max, [high, low]) in [(0xff, UNORM8), (0xffff, UNORM16)] {
            for code in 0..=max {
                let code = code as f32;
                let sum = code * high + code * low;
                assert_eq!(sum.to_bits(), (code / max as f32).to_bits(), "{code} of {max}");
            }
        }
    }
}
