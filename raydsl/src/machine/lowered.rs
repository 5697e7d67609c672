//! Lowering targets for the parts of Rust that are not methods: literals, casts, elements,
//! counters.

use super::index::{Index, Indexed};
use super::{
    B, Bounds, Coerce, Condition, Counter, F, I, Machine, OpCast, OpCompare, Schema, Type, U,
    Usize, Value, op,
};

/// Lowers a literal, given as the two numbers nearest to its text.
#[inline(always)]
pub fn literal<M: Machine>(m: &M, v: f32, exact: f64) -> F<M> {
    F(m.f32_literal(v, exact))
}

/// Lowers a literal with the suffix `i32`.
#[inline(always)]
pub fn i32<M: Machine>(m: &M, v: i32) -> I<M> {
    I(m.i32(v))
}

/// Lowers a literal with the suffix `u32`.
#[inline(always)]
pub fn u32<M: Machine>(m: &M, v: u32) -> U<M> {
    U(m.u32(v))
}

/// Lowers a literal with the suffix `usize`.
#[inline(always)]
pub fn usize<M: Machine>(m: &M, v: usize) -> Usize<M> {
    Type::splat(m, v)
}

/// Lowers a closure that a variable names.
#[inline(always)]
pub fn with_name<F>(closure: F) -> F {
    closure
}

/// Returns the schema of an enum of `COUNT` variants in `bytes` bytes, which are `is_counted` if they
/// have the numbers from 0.
pub const fn number_schema<const COUNT: u32>(bytes: usize, is_counted: bool) -> &'static Schema {
    match bytes {
        1 => &Schema::Small { bytes: 1 },
        2 => &Schema::Small { bytes: 2 },
        4 if is_counted => const { &Schema::Kind { count: COUNT } },
        _ => &Schema::U32,
    }
}

/// Writes the discriminant of a variant.
pub fn write_number(number: u32, bytes: usize, out: &mut [u8]) {
    let n = bytes.min(4);
    out[..n].copy_from_slice(&number.to_le_bytes()[..n]);
}

/// Reads the discriminant of a variant.
pub fn read_number(size: usize, bytes: &[u8]) -> u32 {
    let mut number = [0; 4];
    let n = size.min(4);
    number[..n].copy_from_slice(&bytes[..n]);
    u32::from_le_bytes(number)
}

/// Reports the place that runs next, for lanes that count; see
/// [`CountedKernel`](crate::kernel::CountedKernel).
#[inline(always)]
pub fn here<M: Machine>(m: &M, what: &'static str, file: &'static str, line: u32) {
    m.at(super::Place { what, file, line });
}

/// Lowers `a as T`.
#[inline(always)]
pub fn cast<M: Machine, A: OpCast<M, T>, T: Type>(m: &M, a: A) -> T::On<M> {
    A::cast(m, a)
}

/// Evaluates the right side of `&&` or `||` for the lanes where the left side is `when`.
#[inline(always)]
pub fn guarded<M: Machine, C: Coerce<M, B<M>>, R>(
    m: &M,
    c: C,
    when: bool,
    f: impl FnOnce() -> R,
) -> R {
    m.guarded(c.coerce(m).0, when, f)
}

/// Selects one of two values by a condition of the machine or of the host.
#[inline(always)]
pub fn choose<M: Machine, V: Value<M>, C: Condition<M>>(
    m: &M,
    name: &'static str,
    calls: bool,
    c: C,
    a: impl FnOnce() -> V,
    b: impl FnOnce() -> V,
) -> V {
    c.choose(m, name, calls, a, b)
}

/// Returns the bounds of a `for`.
#[inline(always)]
pub fn range<M: Machine, S: Bounds<M, E>, E>(m: &M, start: S, end: E) -> (S::Counter, S::Counter) {
    S::bounds(m, start, end)
}

/// Returns whether a counter is below its end.
#[inline(always)]
pub fn less<M: Machine, C: OpCompare<M, C, Output = B<M>>>(m: &M, a: C, b: C) -> B<M> {
    C::compare(m, op::Lt, a, b)
}

/// Returns whether an inclusive range goes on: its last number has not been used, and `a <= b`.
#[inline(always)]
pub fn goes_on<M: Machine, C: OpCompare<M, C, Output = B<M>>>(
    m: &M,
    done: B<M>,
    a: C,
    b: C,
) -> B<M> {
    let within = C::compare(m, op::Le, a, b);
    B(m.bool_binary(op::And, m.bool_not(done.0), within.0))
}

/// Returns the step of `.step_by(n)`. Rust panics for 0; here it becomes 1, so that the loop ends.
#[inline(always)]
pub fn step<M: Machine>(m: &M, n: impl Coerce<M, Usize<M>>) -> U<M> {
    let n = n.coerce(m).0;
    let none = m.u32_compare(op::Eq, n, m.u32(0));
    U(m.u32_select(none, m.u32(1), n))
}

/// Returns whether a range with steps goes on: its last number has not been used.
#[inline(always)]
pub fn goes_on_to<M: Machine, C: OpCompare<M, C, Output = B<M>>>(
    m: &M,
    done: B<M>,
    a: C,
    b: C,
    inclusive: bool,
) -> B<M> {
    let within = if inclusive { C::compare(m, op::Le, a, b) } else { C::compare(m, op::Lt, a, b) };
    B(m.bool_binary(op::And, m.bool_not(done.0), within.0))
}

/// Returns whether no step is left before the end, which `a` has not passed: so nothing overflows.
#[inline(always)]
pub fn is_last<M: Machine, C: Counter<M>>(m: &M, a: C, end: C, by: U<M>, inclusive: bool) -> B<M> {
    let left = m.u32_binary(op::WrappingSub, end.bits(m), a.bits(m));
    B(if inclusive { m.u32_compare(op::Lt, left, by.0) } else { m.u32_compare(op::Le, left, by.0) })
}

/// Returns the value of a counter advanced by `by`.
#[inline(always)]
pub fn advance<M: Machine, C: Counter<M>>(m: &M, a: C, by: U<M>) -> C {
    C::of_bits(m, m.u32_binary(op::WrappingAdd, a.bits(m), by.0))
}

/// Returns whether a counter has its last value.
#[inline(always)]
pub fn equal<M: Machine, C: OpCompare<M, C, Output = B<M>>>(m: &M, a: C, b: C) -> B<M> {
    C::compare(m, op::Eq, a, b)
}

/// Lowers `a[i as usize]`.
#[inline(always)]
pub fn element<M: Machine, A: Indexed<M>>(m: &M, a: A, i: impl Index<M>) -> A::Element {
    let i = i.index(m);
    a.element(m, i)
}

/// Lowers `a[i]` where `i` is the same in all running lanes; `index` gives its value in a recorded
/// loop.
#[inline(always)]
pub fn element_in_step<M: Machine, A: Indexed<M>, I: Index<M>>(
    m: &M,
    a: A,
    step: u32,
    index: impl FnOnce() -> I,
) -> A::Element {
    if !M::RUNS {
        return a.element(m, index().index(m));
    }
    if cfg!(debug_assertions) {
        // Type errors in the index expression are reported here too.
        let _ = index();
    }
    a.in_step(m, step)
}

/// Lowers `a[3]`.
#[inline(always)]
pub fn at<M: Machine, A: Indexed<M>>(m: &M, a: A, i: usize) -> A::Element {
    a.at(m, i)
}
