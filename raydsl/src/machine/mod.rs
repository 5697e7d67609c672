//! The machines that a lifted kernel body runs on.
//!
//! The `#[kernel]` macro rewrites a body *once*, into a function generic over a [`Machine`]
//! (tagless final: Carette, Kiselyov and Shan, "Finally tagless, partially evaluated", 2009). Three
//! implementations give the variants: [`Scalar`] (a cross-check of the rewriting; the scalar
//! *variant* is the user's own function), [`Packet`] (SIMD with masked control flow) and
//! [`Recorder`] (writes WGSL). A fourth, [`Margin`], computes the reference in `f64` and bounds
//! what rounding may do to the variants.
//!
//! A machine offers arithmetic on lanes and *control hooks*: an `if` or a loop of the source calls
//! them, and their results steer real Rust control flow. The scalar machine returns the condition
//! itself, a packet whether any lane is left, the recorder always `true`.

// The files:
//
// * `scalar`: one lane of plain numbers, to check the rewriting.
// * `packet`: SIMD packets with masked control flow.
// * `lanes`, `gang`, `counted`: the lanes of packets: one register, several, with counters
//   (Batcher, "Sorting Networks and Their Applications", 1968, for sorting within a register).
// * `record`, `wgsl`: the recorder, its intermediate representation, and the WGSL module.
// * `margin`: the `f64` reference with bounds on rounding errors (Higham, "Accuracy and Stability
//   of Numerical Algorithms", 2002; Stolfi and de Figueiredo, "Self-Validated Numerical Methods and
//   Applications", 1997).
// * `control`, `counter`: structured control flow of lifted code: variables, branches, loops.
// * `bare`, `option`: integers whose type rustc infers, and `Option`.
// * `types`, `schema`, `twin`, `value`: host types, their layouts, and their twins on a machine.
// * `words`, `kinds`: the storage of an enum's kinds, and the kinds a scene has.
// * `vector`, `matrix`, `inverse`: the twins of glam's types.
// * `op`, `ops`, `operand`, `bits`: operations as types, and the operators of lifted code (Warren,
//   "Hacker's Delight", 2013, for bit counting).
// * `methods`, `functions`, `generic`: methods and functions of lifted code.
// * `data`, `index`, `cursor`, `table`: slices, their elements, the items of `for`, and data that is
//   a member of a captured value.
// * `capture`, `host`, `owner`: captures of a kernel, host values, liveness of scene data.
// * `operation`: extension points for other modules.
// * `call`, `lowered`: kernels as functions, and the functions that lifted code calls.

mod bare;
mod bits;
mod call;
mod capture;
mod control;
mod counted;
mod counter;
mod cursor;
mod data;
pub(crate) mod functions;
mod gang;
pub(crate) mod generic;
pub(crate) mod host;
pub(crate) mod index;
mod inverse;
mod kinds;
mod lanes;
pub(crate) mod lowered;
pub(crate) mod margin;
pub(crate) mod matrix;
mod methods;
#[doc(hidden)]
pub mod op;
mod operand;
mod operation;
mod ops;
mod option;
pub(crate) mod owner;
mod packet;
pub(crate) mod record;
mod scalar;
mod schema;
mod table;
mod twin;
mod types;
mod value;
mod vector;
pub mod wgsl;
mod words;

pub use call::{KernelFn, KernelInfo};
pub(crate) use call::{KnownFunction, WithoutNan};
pub use capture::{
    Capture, ConstantFact, HostFact, Resource, VisitConstant, visit_host, visit_known, visit_value,
};
pub(crate) use counted::count;
pub use counted::{Count, Counted, Place};
#[cfg(feature = "gpu")]
pub(crate) use data::is_borrowed;
pub use data::{Data, Slice};
pub(crate) use data::{DescribedSlice, borrowed_key, bytes_of, read_in_place};
pub use gang::Gang;
pub(crate) use host::host_options;
pub(crate) use index::{Index, Indexed, element_in_step};
pub use kinds::Kinds;
/// For callbacks of other tracers, whose code the caller has compiled for a level.
#[doc(hidden)]
pub use lanes::Entered;
pub(crate) use lanes::fill;
pub use lanes::{Lanes, One, Simd4, Simd8, Simd16};
pub(crate) use lifted::*;
pub use margin::{Leaf, Margin, Outcomes, Rounding, result_leaves};
pub(crate) use matrix::A3;
pub use op::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Op, U32Unary};
pub use operation::{On, Operation, Visit};
pub(crate) use owner::Owner;
pub use packet::Packet;
pub(crate) use record::stride;
pub use record::{Description, Recorder, Recording};
#[cfg(feature = "gpu")]
pub(crate) use record::{Frame, Identity, Modules};
pub use scalar::Scalar;
pub use schema::{Field, Schema};
#[doc(hidden)]
pub(crate) use table::table_view;
pub use table::{Table, TableView};
pub use types::Type;
pub(crate) use types::{KernelType, kernel_type};
pub(crate) use value::Floats;
pub use value::{B, F, I, U, Usize, Value};
pub use vector::{V2, V3, V4, X2, X3, X4};

/// Everything that only generated code is written with.
pub mod lifted {
    pub use super::host::{Constant, GiveConstant, HostCapture, HostUse};
    pub use super::index::{Index, Indexed, with_element};
    pub use super::kinds::Kind;
    pub use super::lowered::*;

    pub use super::bare::{Bare, bare};
    pub use super::call::KnownBy;
    pub use super::capture::Parameter;
    pub use super::control::{Branch, Condition, Loop, Ret, Var};
    pub use super::counter::{Counter, Steps, Stop, decrement, increment};
    pub use super::cursor::Cursor;
    pub use super::methods::{Const, HostMethod, Method, Through, call_on_element, is_mut, name};
    pub use super::operand::{Assigned, Plain, RightOperand};
    pub use super::ops::{
        Bounds, Coerce, Comparable, OpAdd, OpAnd, OpBitAnd, OpBitOr, OpBitXor, OpCast, OpCompare,
        OpDiv, OpMul, OpNeg, OpNot, OpOr, OpRem, OpShl, OpShr, OpSub, Varying,
    };
    pub use super::option::{OptionOn, Options, zero_of};
    pub use super::schema::Places;
    pub use super::twin::{Inferred, Twin};
    pub use super::types::{KernelType, LaneMachine, Stated, from_each_lane};
    pub use super::value::Leaves;
    pub use super::words::{host_of_words, is_kind, of_kind, of_words, to_words, to_words_on};
}

/// A machine that lifted kernel bodies run on: arithmetic on lanes, and hooks for control flow.
///
/// The associated types are the representations of one value of each scalar type: a number for
/// [`Scalar`], a SIMD register for a [`Packet`], the handle of an expression for [`Recorder`].
#[expect(missing_docs, reason = "arithmetic is documented at the enums of operations")]
pub trait Machine: Sized + 'static {
    /// One `f32` per lane.
    type F32: Copy + 'static;
    /// One `i32` per lane.
    type I32: Copy + 'static;
    /// One `u32` per lane.
    type U32: Copy + 'static;
    /// One `bool` per lane.
    type Bool: Copy + 'static;
    /// The state of an `if` being executed.
    type Branch;
    /// The state of a loop being executed.
    type Loop;
    /// Whether lifted code runs every iteration: then a counter is one number in all lanes.
    const RUNS: bool = true;
    /// Whether it has operations on whole vectors; otherwise they go component by component.
    const HAS_VECTORS: bool = false;

    // Constants, the same in every lane.
    fn f32(&self, v: f32) -> Self::F32;
    fn i32(&self, v: i32) -> Self::I32;
    fn u32(&self, v: u32) -> Self::U32;
    fn bool(&self, v: bool) -> Self::Bool;

    /// Returns a literal: the `f32` and the `f64` nearest to its decimal text.
    #[inline(always)]
    fn f32_literal(&self, v: f32, _exact: f64) -> Self::F32 {
        self.f32(v)
    }

    /// Returns a constant of the source that is named by a path.
    #[inline(always)]
    fn f32_constant(&self, v: f32) -> Self::F32 {
        self.f32(v)
    }

    // Arithmetic.
    fn f32_unary<O: Op<F32Unary>>(&self, op: O, a: Self::F32) -> Self::F32;
    fn f32_binary<O: Op<F32Binary>>(&self, op: O, a: Self::F32, b: Self::F32) -> Self::F32;
    /// Returns `a * b + c`, fused: rounded once.
    fn f32_mul_add(&self, a: Self::F32, b: Self::F32, c: Self::F32) -> Self::F32;
    fn i32_binary<O: Op<IntBinary>>(&self, op: O, a: Self::I32, b: Self::I32) -> Self::I32;
    fn u32_binary<O: Op<IntBinary>>(&self, op: O, a: Self::U32, b: Self::U32) -> Self::U32;
    fn bool_binary<O: Op<BoolBinary>>(&self, op: O, a: Self::Bool, b: Self::Bool) -> Self::Bool;
    fn i32_neg(&self, a: Self::I32) -> Self::I32;
    fn i32_not(&self, a: Self::I32) -> Self::I32;
    fn u32_not(&self, a: Self::U32) -> Self::U32;
    fn bool_not(&self, a: Self::Bool) -> Self::Bool;
    fn f32_compare<O: Op<Compare>>(&self, op: O, a: Self::F32, b: Self::F32) -> Self::Bool;
    fn i32_compare<O: Op<Compare>>(&self, op: O, a: Self::I32, b: Self::I32) -> Self::Bool;
    fn u32_compare<O: Op<Compare>>(&self, op: O, a: Self::U32, b: Self::U32) -> Self::Bool;

    // `if c { a } else { b }` with both sides evaluated.
    fn f32_select(&self, c: Self::Bool, a: Self::F32, b: Self::F32) -> Self::F32;
    fn i32_select(&self, c: Self::Bool, a: Self::I32, b: Self::I32) -> Self::I32;
    fn u32_select(&self, c: Self::Bool, a: Self::U32, b: Self::U32) -> Self::U32;
    fn bool_select(&self, c: Self::Bool, a: Self::Bool, b: Self::Bool) -> Self::Bool;

    // Conversions, each as Rust's `as` (floats to integers saturate, NaN gives 0).
    fn f32_to_i32(&self, a: Self::F32) -> Self::I32;
    fn f32_to_u32(&self, a: Self::F32) -> Self::U32;
    fn i32_to_f32(&self, a: Self::I32) -> Self::F32;
    fn u32_to_f32(&self, a: Self::U32) -> Self::F32;
    fn i32_to_u32(&self, a: Self::I32) -> Self::U32;
    fn u32_to_i32(&self, a: Self::U32) -> Self::I32;
    fn f32_to_bits(&self, a: Self::F32) -> Self::U32;
    fn f32_from_bits(&self, a: Self::U32) -> Self::F32;
    fn bool_to_u32(&self, a: Self::Bool) -> Self::U32;

    /// Compares the absolute value of `a` with infinity, by its bits. Unlike `a != a` this also
    /// works on GPUs, which may assume that there is no NaN.
    #[inline(always)]
    fn f32_beside_infinity<O: Op<Compare>>(&self, op: O, a: Self::F32) -> Self::Bool {
        let bits = self.u32_to_i32(self.f32_to_bits(a));
        let size = self.i32_binary(op::And, bits, self.i32(0x7fff_ffff));
        self.i32_compare(op, size, self.i32(0x7f80_0000))
    }

    /// Returns whether the sign is `-`, of zeros and NaN too; with [`op::Ge`] whether it is not.
    #[inline(always)]
    fn f32_sign_bit<O: Op<Compare>>(&self, op: O, a: Self::F32) -> Self::Bool {
        self.i32_compare(op, self.u32_to_i32(self.f32_to_bits(a)), self.i32(0))
    }

    /// Returns the number `a` with the sign of `sign`.
    #[inline(always)]
    fn f32_copysign(&self, a: Self::F32, sign: Self::F32) -> Self::F32 {
        let bits = |x, mask| self.u32_binary(op::And, self.f32_to_bits(x), self.u32(mask));
        let (size, sign) = (bits(a, 0x7fff_ffff), bits(sign, 0x8000_0000));
        self.f32_from_bits(self.u32_binary(op::Or, size, sign))
    }

    /// Applies an operation to every component of two vectors; a machine may have vectors of its
    /// own.
    #[inline(always)]
    fn vector_binary<O: Op<F32Binary>, const N: usize>(
        &self,
        op: O,
        a: [Self::F32; N],
        b: [Self::F32; N],
    ) -> [Self::F32; N] {
        fill(
            #[inline(always)]
            |i| self.f32_binary(op, a[i], b[i]),
        )
    }

    /// Applies an operation to every component of a vector.
    #[inline(always)]
    fn vector_unary<O: Op<F32Unary>, const N: usize>(
        &self,
        op: O,
        a: [Self::F32; N],
    ) -> [Self::F32; N] {
        fill(
            #[inline(always)]
            |i| self.f32_unary(op, a[i]),
        )
    }

    /// Applies an operation to every component of two vectors of `i32`.
    #[inline(always)]
    fn i32_vector_binary<O: Op<IntBinary>, const N: usize>(
        &self,
        op: O,
        a: [Self::I32; N],
        b: [Self::I32; N],
    ) -> [Self::I32; N] {
        fill(
            #[inline(always)]
            |i| self.i32_binary(op, a[i], b[i]),
        )
    }

    /// Applies an operation to every component of two vectors of `u32`.
    #[inline(always)]
    fn u32_vector_binary<O: Op<IntBinary>, const N: usize>(
        &self,
        op: O,
        a: [Self::U32; N],
        b: [Self::U32; N],
    ) -> [Self::U32; N] {
        fill(
            #[inline(always)]
            |i| self.u32_binary(op, a[i], b[i]),
        )
    }

    /// Counts or reverses bits.
    #[inline(always)]
    fn u32_unary<O: Op<U32Unary>>(&self, op: O, a: Self::U32) -> Self::U32 {
        bits::u32_unary(self, op, a)
    }

    // Control flow. Every hook that returns `bool` returns whether to run the code that follows.

    /// Begins an `if`.
    fn branch(&self, c: Self::Bool) -> Self::Branch;
    /// Enters its first arm.
    fn branch_then(&self, t: &Self::Branch) -> bool;
    /// Leaves the first arm and enters the second.
    fn branch_else(&self, t: &Self::Branch) -> bool;
    /// Enters the first arm, which is cheap: a packet need not test whether any lane takes it.
    #[inline(always)]
    fn branch_then_small(&self, t: &Self::Branch) -> bool {
        self.branch_then(t)
    }
    /// Leaves the first arm and enters the second, which is cheap.
    #[inline(always)]
    fn branch_else_small(&self, t: &Self::Branch) -> bool {
        self.branch_else(t)
    }
    /// Joins the arms.
    fn branch_end(&self, t: Self::Branch);

    /// Selects `a()` in the lanes that have `c`, `b()` in the others. Without `calls` neither has a
    /// side effect; with them each is evaluated for its lanes only, into a variable called `name`.
    #[inline(always)]
    fn choose<V: Value<Self>>(
        &self,
        name: &'static str,
        calls: bool,
        c: B<Self>,
        a: impl FnOnce() -> V,
        b: impl FnOnce() -> V,
    ) -> V {
        if calls {
            let value = Var::declare(self, name);
            let branch = Branch::new(self, c);
            if branch.then(self) {
                value.set(self, a());
            }
            if branch.otherwise(self) {
                value.set(self, b());
            }
            branch.end(self);
            return value.get(self);
        }
        let (a, b) = (self.guarded(c.0, true, a), self.guarded(c.0, false, b));
        index::choose(self, c.0, a, b)
    }

    /// Begins a loop.
    fn loop_begin(&self) -> Self::Loop;
    /// Tests a `while` condition: lanes where it fails leave the loop.
    fn loop_test(&self, t: &Self::Loop, c: Self::Bool) -> bool;
    /// Executes `break` for the running lanes.
    fn loop_break(&self, t: &Self::Loop);
    /// Executes `continue` for the running lanes.
    fn loop_continue(&self, t: &Self::Loop);
    /// Ends the body: lanes that said `continue` run again, and the increment of a `for` follows.
    fn loop_continuing(&self, t: &Self::Loop);
    /// Returns whether to run another iteration. A recorder runs the body again if it assumed too
    /// little of it.
    #[must_use]
    fn loop_again(&self, t: &Self::Loop) -> bool;
    /// Leaves the loop: lanes that left it run on behind it.
    fn loop_end(&self, t: Self::Loop);

    /// Returns whether to run the code behind an early exit: if any lane is left, or a test costs
    /// more.
    fn alive(&self) -> bool;
    /// Returns whether any running lane has `c`; the recorder returns true.
    fn any(&self, c: Self::Bool) -> bool;
    /// Returns the number that all lanes have, if it is found quickly.
    #[inline(always)]
    fn u32_same(&self, _a: &Self::U32) -> Option<u32> {
        None
    }

    /// Reports where in the source the running lanes are: in an arm of an `if`, in an iteration.
    #[inline(always)]
    fn at(&self, _place: Place) {}

    /// Evaluates the right side of `&&` or `||`, reached only by lanes where the left side `c` is
    /// `when`: in the others, an overflow there is no error.
    #[inline(always)]
    fn guarded<R>(&self, _c: Self::Bool, _when: bool, f: impl FnOnce() -> R) -> R {
        f()
    }

    /// Panics, with debug assertions, if a running lane's index is not less than `len`.
    #[inline(always)]
    fn check_index(&self, _index: &Self::U32, _len: u32) {}

    // Variables. `V` is a twin; the hooks work leaf by leaf.

    /// Creates the state of a variable that holds `v`.
    fn var_new<V: Value<Self>>(&self, name: &'static str, v: V) -> V;
    /// Creates the state of a variable without a value.
    fn var_declare<V: Value<Self>>(&self, name: &'static str) -> V;
    /// Returns a snapshot of a variable's value.
    fn var_get<V: Value<Self>>(&self, state: V) -> V;
    /// Returns the state after assigning `v` in the running lanes.
    fn var_set<V: Value<Self>>(&self, state: V, v: V) -> V;

    /// Executes `return v`: stores the value for the running lanes and stops them.
    fn give<V: Value<Self>>(&self, slot: &core::cell::Cell<V>, v: V);
    /// Creates the slot for the value of a function with early returns.
    fn give_slot<V: Value<Self>>(&self) -> V;

    /// Runs a kernel's body on this machine. `args` is a tuple of values.
    fn call<A: Value<Self>, R: Value<Self>>(
        &self,
        info: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R;

    /// Runs a kernel marked `#[inline(never)]` like [`call`](Self::call): packets inline others
    /// where they are called from a traversal.
    #[inline(always)]
    fn call_apart<A: Value<Self>, R: Value<Self>>(
        &self,
        info: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        self.call(info, args, body)
    }

    /// Runs a kernel marked `#[inline(always)]` like [`call`](Self::call): in packets it is a part of
    /// its callers, however long they are.
    #[inline(always)]
    fn call_within<A: Value<Self>, R: Value<Self>>(
        &self,
        info: &'static KernelInfo,
        args: A,
        body: impl FnOnce(&Self, A) -> R,
    ) -> R {
        self.call(info, args, body)
    }

    /// Captures a number, vector or struct of the host.
    #[inline(always)]
    fn capture<T: Type>(&self, _name: &'static str, v: T) -> T::On<Self> {
        T::splat(self, v)
    }

    /// Gives a value its name in the source, for readers of generated code.
    #[inline(always)]
    fn named<V: Value<Self>>(&self, _name: &'static str, v: V) -> V {
        v
    }

    /// Performs an operation of another module by its implementation for this machine.
    fn perform<O: Operation>(
        &self,
        operation: &O,
        input: On<O::Input, Self>,
    ) -> On<O::Output, Self>;

    /// Visits items one after another by their implementation for this machine; see [`Visit`].
    fn visit<T: Visit>(
        &self,
        items: &T,
        input: On<T::Input, Self>,
        limit: impl Fn() -> F<Self>,
        visit: impl Fn(On<T::Item, Self>) -> B<Self>,
    );

    /// Returns `[f(0), f(1), ..]`; a loop in generated code.
    #[inline(always)]
    fn each<V: Value<Self>, const N: usize>(&self, mut f: impl FnMut(U<Self>) -> V) -> [V; N] {
        fill(
            #[inline(always)]
            |i| f(U(self.u32(i as u32))),
        )
    }

    /// Returns the number of elements.
    #[inline(always)]
    fn len<D: Data>(&self, data: &D) -> U<Self> {
        U(self.u32(data.count() as u32))
    }

    /// Returns the element `index`; the last one if it is out of range.
    #[inline(always)]
    fn element<D: Data>(&self, data: &D, index: U<Self>) -> <D::Element as Type>::On<Self> {
        let count = u32::try_from(data.count()).unwrap_or(u32::MAX);
        self.check_index(&index.0, count);
        let last = self.u32(count.wrapping_sub(1));
        let within = self.u32_compare(op::Le, index.0, last);
        self.fetch(data, U(self.u32_select(within, index.0, last)))
    }

    /// Returns `code / max`, for a code up to `max`.
    #[inline(always)]
    fn unorm(&self, code: Self::U32, max: u32) -> Self::F32 {
        self.f32_binary(op::Div, self.u32_to_f32(code), self.f32(max as f32))
    }

    /// Returns `v`, where a device's value may differ by `absolute` and `relative` times itself.
    /// Machines that compute it as written return it unchanged.
    #[inline(always)]
    fn off_by(&self, v: Self::F32, _absolute: f32, _relative: f32) -> Self::F32 {
        v
    }

    /// Returns the element `index`, which is in range.
    fn fetch<D: Data>(&self, data: &D, index: U<Self>) -> <D::Element as Type>::On<Self>;
}
