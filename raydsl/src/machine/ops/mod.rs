//! The operators of lifted code.
//!
//! There is one trait per operator: rustc resolves the receiver, the right side and the result, so
//! the macro needs no types. Integer literals of the source remain host values until combined with
//! a value of the machine; `f32` literals become values at once.

mod arithmetic;
mod cast;
mod coerce;
mod compare;

pub use coerce::{Bounds, Coerce, Varying};

use super::{Compare, Machine, Op, Type};

macro_rules! binary_traits {
    ($($trait:ident :: $method:ident $symbol:literal),+ $(,)?) => {
        $(
            #[doc = concat!("`a ", $symbol, " b` on machine `M`.")]
            #[diagnostic::on_unimplemented(
                message = "a kernel has no operator for these operands",
                label = "not an operation of the kernel language",
                note = "there are: two values of one type, and a vector with a number of its \
                        components' type; convert with `as`, as in `x * n as f32`",
                note = "an operator of a type of your own needs `#[kernel]` on its impl: \
                        `#[kernel] impl Add for Spectrum`"
            )]
            pub trait $trait<M: Machine, R, Via = ()> {
                /// The result type.
                type Output;
                /// Applies the operator.
                fn $method(m: &M, a: Self, b: R) -> Self::Output;
            }
        )+
    };
}

binary_traits!(
    OpAdd::add "+",
    OpSub::sub "-",
    OpMul::mul "*",
    OpDiv::div "/",
    OpRem::rem "%",
    OpBitAnd::bit_and "&",
    OpBitOr::bit_or "|",
    OpBitXor::bit_xor "^",
    OpShl::shl "<<",
    OpShr::shr ">>",
    OpAnd::and "&&",
    OpOr::or "||",
);

/// `-a` on machine `M`.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot negate this value",
    label = "no number with a sign, and no vector of such",
    note = "of a `u32`, write `n.wrapping_neg()` or convert it: `-(n as i32)`"
)]
pub trait OpNeg<M: Machine> {
    /// Applies the operator.
    fn neg(m: &M, a: Self) -> Self;
}

/// `!a` on machine `M`.
#[diagnostic::on_unimplemented(
    message = "a kernel has no `!` for this value",
    label = "neither a truth value nor an integer, nor a vector of such"
)]
pub trait OpNot<M: Machine> {
    /// Applies the operator.
    fn not(m: &M, a: Self) -> Self;
}

/// Comparisons on machine `M`.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot compare these two values",
    label = "not two numbers of one type",
    note = "convert one with `as`, as in `x < n as f32`; compare the members of a struct one by one"
)]
pub trait OpCompare<M: Machine, R> {
    /// The result type.
    type Output;
    /// Compares the operands.
    fn compare<O: Op<Compare>>(m: &M, op: O, a: Self, b: R) -> Self::Output;
}

/// Enums with fields that a kernel compares: none.
///
/// A lifted comparison has to be that of the source, and no macro sees whether `PartialEq` is
/// derived.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot compare two values of `{Self}`, an enum with fields",
    label = "no comparison of enums with fields",
    note = "take them apart by a `match`: `match (a, b) {{ (Shape::Ball(a), Shape::Ball(b)) => \
            a.radius == b.radius, .. }}`"
)]
pub trait Comparable<M: Machine> {}

/// `a as T` on machine `M`.
#[diagnostic::on_unimplemented(
    message = "a kernel has no `as {T}` for this value",
    label = "not a number that becomes a `{T}`",
    note = "`as` is for `f32`, `i32`, `u32`, `usize`, and from `bool` and enums to integers"
)]
pub trait OpCast<M: Machine, T: Type> {
    /// Converts as Rust's `as` does.
    fn cast(m: &M, a: Self) -> T::On<M>;
}
