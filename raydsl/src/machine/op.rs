//! Operations as types, so that each is known when code is made.
//!
//! A kernel is inlined whole before an optimiser looks at it: were operations values, all of them
//! would be compiled wherever there is one, to be thrown away.

use super::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, U32Unary};

/// One of the operations of `Kind`.
pub trait Op<Kind>: Copy + 'static {
    /// As a value.
    const OP: Kind;
}

/// A `match` on an operation that is known when code is made: only the arm that is taken is
/// compiled.
macro_rules! known {
    ($op:path; $($pattern:pat => $result:expr,)+) => {
        $(if const { matches!($op, $pattern) } { $result } else)+ { unreachable!() }
    };
}
pub(crate) use known;

/// A `match` on an operation that is known at run time only: `$known` is its type's value in
/// `$result`. For tests.
#[doc(hidden)]
#[macro_export]
macro_rules! __at_run_time {
    (F32Unary $($rest:tt)+) => {
        $crate::__at_run_time!(@F32Unary Neg Abs Sqrt Floor Ceil Trunc; $($rest)+)
    };
    (F32Binary $($rest:tt)+) => {
        $crate::__at_run_time!(@F32Binary Add Sub Mul Div Min Max; $($rest)+)
    };
    (IntBinary $($rest:tt)+) => {
        $crate::__at_run_time!(
            @IntBinary Add Sub Mul Div Rem And Or Xor Shl Shr WrappingAdd WrappingSub WrappingMul;
            $($rest)+
        )
    };
    (BoolBinary $($rest:tt)+) => { $crate::__at_run_time!(@BoolBinary And Or Xor; $($rest)+) };
    (Compare $($rest:tt)+) => { $crate::__at_run_time!(@Compare Eq Ne Lt Le Gt Ge; $($rest)+) };
    (@$kind:ident $($name:ident)+; $op:expr, |$known:ident| $result:expr) => {
        match $op {
            $($crate::machine::$kind::$name => {
                let $known = $crate::machine::op::$name;
                $result
            })+
        }
    };
}

macro_rules! operations {
    ($($name:ident: $($kind:ident)+;)+) => {
        $(
            #[doc = concat!("The operation `", stringify!($name), "`.")]
            #[derive(Clone, Copy, Debug)]
            pub struct $name;

            $(
                impl Op<$kind> for $name {
                    const OP: $kind = $kind::$name;
                }
            )+
        )+
    };
}

operations! {
    Add: F32Binary IntBinary;
    Sub: F32Binary IntBinary;
    Mul: F32Binary IntBinary;
    Div: F32Binary IntBinary;
    Min: F32Binary;
    Max: F32Binary;
    Rem: IntBinary;
    And: IntBinary BoolBinary;
    Or: IntBinary BoolBinary;
    Xor: IntBinary BoolBinary;
    Shl: IntBinary;
    Shr: IntBinary;
    WrappingAdd: IntBinary;
    WrappingSub: IntBinary;
    WrappingMul: IntBinary;
    Neg: F32Unary;
    Abs: F32Unary;
    Sqrt: F32Unary;
    Floor: F32Unary;
    Ceil: F32Unary;
    Trunc: F32Unary;
    CountOnes: U32Unary;
    LeadingZeros: U32Unary;
    TrailingZeros: U32Unary;
    ReverseBits: U32Unary;
    Eq: Compare;
    Ne: Compare;
    Lt: Compare;
    Le: Compare;
    Gt: Compare;
    Ge: Compare;
}
