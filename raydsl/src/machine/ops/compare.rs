//! Comparison operators.

use super::OpCompare;
use crate::machine::op::known;
use crate::machine::vector::{Component, Vector};
use crate::machine::{B, Compare, F, I, Machine, Op, Type, U, Usize, X2, X3, X4, op};

macro_rules! compare {
    ($a:ty, $b:ty, $out:ty, |$m:ident, $op:ident, $x:ident, $y:ident| $e:expr) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> OpCompare<M, $b> for $a {
            type Output = $out;

            #[inline(always)]
            fn compare<O: Op<Compare>>($m: &M, $op: O, $x: $a, $y: $b) -> $out {
                $e
            }
        }
    };
}

fn compare_host<T: PartialOrd, O: Op<Compare>>(_: O, a: T, b: T) -> bool {
    O::OP.of(a, b)
}

compare!(F<M>, F<M>, B<M>, |m, op, a, b| B(m.f32_compare(op, a.0, b.0)));

macro_rules! compare_int {
    ($t:ident, $host:ty, $f:ident) => {
        compare!($t<M>, $t<M>, B<M>, |m, op, a, b| B(m.$f(op, a.0, b.0)));
        compare!($t<M>, $host, B<M>, |m, op, a, b| {
            B(m.$f(op, a.0, <$host as Type>::splat(m, b).0))
        });
        compare!($host, $t<M>, B<M>, |m, op, a, b| {
            B(m.$f(op, <$host as Type>::splat(m, a).0, b.0))
        });
        compare!($host, $host, bool, |_m, op, a, b| compare_host(op, a, b));
    };
}

compare_int!(I, i32, i32_compare);
compare_int!(U, u32, u32_compare);
compare_int!(Usize, usize, u32_compare);

/// Compares truth values: `==` and `!=`, and an order (`false < true`) spelled out.
#[inline(always)]
fn compare_bool<M: Machine, O: Op<Compare>>(m: &M, _: O, a: M::Bool, b: M::Bool) -> B<M> {
    let not = |x| m.bool_not(x);
    B(known!(O::OP;
        Compare::Ne => m.bool_binary(op::Xor, a, b),
        Compare::Eq => not(m.bool_binary(op::Xor, a, b)),
        Compare::Lt => m.bool_binary(op::And, not(a), b),
        Compare::Le => m.bool_binary(op::Or, not(a), b),
        Compare::Gt => m.bool_binary(op::And, a, not(b)),
        Compare::Ge => m.bool_binary(op::Or, a, not(b)),
    ))
}

compare!(B<M>, B<M>, B<M>, |m, op, a, b| compare_bool(m, op, a.0, b.0));
compare!(B<M>, bool, B<M>, |m, op, a, b| compare_bool(m, op, a.0, m.bool(b)));
compare!(bool, B<M>, B<M>, |m, op, a, b| compare_bool(m, op, m.bool(a), b.0));
compare!(bool, bool, bool, |_m, op, a, b| compare_host(op, a, b));

/// A component type of vectors with `==` and `!=`.
pub trait Equal<M: Machine>: Component<M> {
    /// Compares two components.
    fn equal<O: Op<Compare>>(m: &M, op: O, a: Self, b: Self) -> B<M>;
}

macro_rules! equal {
    ($($t:ident),+) => {
        $(
            impl<M: Machine> Equal<M> for $t<M> {
                #[inline(always)]
                fn equal<O: Op<Compare>>(m: &M, op: O, a: Self, b: Self) -> B<M> {
                    OpCompare::compare(m, op, a, b)
                }
            }
        )+
    };
}

equal!(F, I, U, B);

macro_rules! vectors {
    ($($v:ident),+) => {
        $(
            /// Compares whole vectors by `==` and `!=`.
            #[diagnostic::do_not_recommend]
            impl<M: Machine, E: Equal<M>> OpCompare<M, $v<E>> for $v<E> {
                type Output = B<M>;

                #[inline(always)]
                fn compare<O: Op<Compare>>(m: &M, op: O, a: Self, b: Self) -> B<M> {
                    let each = a.both(b, #[inline(always)] |x, y| E::equal(m, op, x, y));
                    known!(O::OP;
                        Compare::Ne => {
                            each.fold(#[inline(always)] |x, y| B(m.bool_binary(op::Or, x.0, y.0)))
                        },
                        _ => each.fold(#[inline(always)] |x, y| B(m.bool_binary(op::And, x.0, y.0))),
                    )
                }
            }
        )+
    };
}

vectors!(X2, X3, X4);
