//! Operators of user types.
//!
//! `#[kernel] impl Add for Spectrum` gives `Spectrum` a method named `+`. Its twin forwards the
//! operators to it: those with the twin on the left by impls that the derive writes, those with a
//! number on the left by the impls below.

use super::matrix::{A3, M3, M4};
use super::{
    B, Coerce, F, HostMethod, I, Machine, OpAdd, OpBitAnd, OpBitOr, OpBitXor, OpDiv, OpMul, OpRem,
    OpShl, OpShr, OpSub, U, Usize, X2, X3, X4, name,
};

/// The twin of a struct that may be the right operand of a number.
///
/// It has no parameters, so that nobody can implement it for a number.
pub trait RightOperand {
    /// The struct on the host.
    type Host;
}

/// Compound assignment: `a += b` and its like.
#[diagnostic::on_unimplemented(
    message = "a kernel has no operator for these operands",
    label = "not an operation of the kernel language",
    note = "a type of your own needs a `#[kernel] impl AddAssign` or its like"
)]
pub trait Assigned<const NAME: u64, M: Machine, R, Via = ()>: Sized {
    /// Returns the new value of `a`.
    fn assigned(m: &M, a: Self, b: R) -> Self;
}

/// A type of the library, for which `a += b` is `a = a + b`.
pub trait Plain {}

macro_rules! plain {
    ($($t:ty),+; $($vector:ident),+) => {
        $(impl<M: Machine> Plain for $t {})+
        $(impl<E> Plain for $vector<E> {})+
    };
}

plain!(F<M>, I<M>, U<M>, Usize<M>, B<M>, M3<M>, M4<M>, A3<M>; X2, X3, X4);

macro_rules! assigned {
    ($($name:literal $trait:ident :: $method:ident),+ $(,)?) => {
        $(
            impl<M: Machine, T: Plain, R> Assigned<{ name($name) }, M, R> for T
            where
                T: $trait<M, R>,
                <T as $trait<M, R>>::Output: Coerce<M, T>,
            {
                #[inline(always)]
                fn assigned(m: &M, a: T, b: R) -> T {
                    $trait::$method(m, a, b).coerce(m)
                }
            }
        )+
    };
}

assigned!(
    "+=" OpAdd::add, "-=" OpSub::sub, "*=" OpMul::mul, "/=" OpDiv::div, "%=" OpRem::rem,
    "&=" OpBitAnd::bit_and, "|=" OpBitOr::bit_or, "^=" OpBitXor::bit_xor,
    "<<=" OpShl::shl, ">>=" OpShr::shr,
);

macro_rules! number_on_the_left {
    ($($number:ident: $($trait:ident :: $method:ident $name:literal),+;)+) => {
        $($(
            #[diagnostic::do_not_recommend]
            impl<M: Machine, R: RightOperand> $trait<M, R> for $number<M>
            where
                R::Host: HostMethod<{ name($name) }, M, ($number<M>,), This = R>,
            {
                type Output = <R::Host as HostMethod<{ name($name) }, M, ($number<M>,)>>::Output;

                #[inline(always)]
                fn $method(m: &M, a: $number<M>, b: R) -> Self::Output {
                    <R::Host as HostMethod<{ name($name) }, M, ($number<M>,)>>::call(b, m, (a,))
                }
            }
        )+)+
    };
}

number_on_the_left! {
    F: OpAdd::add "f32 +", OpSub::sub "f32 -", OpMul::mul "f32 *", OpDiv::div "f32 /";
    I: OpAdd::add "i32 +", OpSub::sub "i32 -", OpMul::mul "i32 *", OpDiv::div "i32 /";
    U: OpAdd::add "u32 +", OpSub::sub "u32 -", OpMul::mul "u32 *", OpDiv::div "u32 /";
}
