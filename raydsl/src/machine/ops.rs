//! The operators of lifted code.
//!
//! One trait an operator: the receiver, the right side and the result are looked up by rustc, so
//! the macro needs no types. Integers that appear in the source as literals stay numbers of the
//! host until they meet a value of the machine; `f32` literals become values at once.

use super::vector::{Amounts, Arithmetic, Bits, Broadcast, Floats, Integer, Vector};
use super::{B, Compare, F, I, Machine, Op, Type, U, Usize, Value, Var, X2, X3, X4, op, scalar};
use crate::machine::op::known;

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
                /// The type of the result.
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
    /// What a comparison gives.
    type Output;
    /// Compares.
    fn compare<O: Op<Compare>>(m: &M, op: O, a: Self, b: R) -> Self::Output;
}

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

/// A value of the host, or one of the machine already, where the machine's type `T` is wanted.
#[diagnostic::on_unimplemented(
    message = "this value does not have the type that is wanted here",
    label = "a value of another type",
    note = "convert a number with `as`, as in `n as f32`"
)]
pub trait Coerce<M: Machine, T> {
    /// Converts.
    fn coerce(self, m: &M) -> T;
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Value<M>> Coerce<M, V> for V {
    #[inline(always)]
    fn coerce(self, _: &M) -> V {
        self
    }
}

/// A `&mut` parameter where a value is wanted.
#[diagnostic::do_not_recommend]
impl<M: Machine, V: Value<M>> Coerce<M, V> for &Var<V> {
    #[inline(always)]
    fn coerce(self, m: &M) -> V {
        self.get(m)
    }
}

macro_rules! coerce_host {
    ($($host:ty => $twin:ident $make:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Coerce<M, $twin<M>> for $host {
                #[inline(always)]
                fn coerce(self, m: &M) -> $twin<M> {
                    $twin(m.$make(self))
                }
            }
        )+
    };
}

coerce_host!(f32 => F f32, i32 => I i32, u32 => U u32, bool => B bool);

#[diagnostic::do_not_recommend]
impl<M: Machine> Coerce<M, Usize<M>> for usize {
    #[inline(always)]
    fn coerce(self, m: &M) -> Usize<M> {
        <usize as Type>::splat(m, self)
    }
}

/// What a variable holds: a value of the machine, whether or not the source's was one of the host.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot keep this value in a variable",
    label = "neither a number nor a value made of numbers",
    note = "name data that kernels read where it is used: `points[i]`, `bvh.closest_hit(ray)`"
)]
pub trait Varying<M: Machine> {
    /// The value of the machine.
    type Value: Value<M>;
    /// Converts.
    fn varying(self, m: &M) -> Self::Value;
}

macro_rules! varying {
    ($($t:ident),+; $($host:ty => $twin:ident $make:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Varying<M> for $t<M> {
                type Value = Self;

                #[inline(always)]
                fn varying(self, _: &M) -> Self {
                    self
                }
            }
        )+
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Varying<M> for $host {
                type Value = $twin<M>;

                #[inline(always)]
                fn varying(self, m: &M) -> $twin<M> {
                    $twin(m.$make(self))
                }
            }
        )+
    };
}

varying!(F, I, U, Usize, B; i32 => I i32, u32 => U u32, bool => B bool);

#[diagnostic::do_not_recommend]
impl<M: Machine> Varying<M> for usize {
    type Value = Usize<M>;

    #[inline(always)]
    fn varying(self, m: &M) -> Usize<M> {
        Coerce::coerce(self, m)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Varying<M>, const N: usize> Varying<M> for [V; N] {
    type Value = [V::Value; N];

    #[inline(always)]
    fn varying(self, m: &M) -> Self::Value {
        self.map(|v| v.varying(m))
    }
}

macro_rules! varying_tuple {
    ($($name:ident . $index:tt),+) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, $($name: Varying<M>),+> Varying<M> for ($($name,)+) {
            type Value = ($($name::Value,)+);

            #[inline(always)]
            fn varying(self, m: &M) -> Self::Value {
                ($(self.$index.varying(m),)+)
            }
        }
    };
}

varying_tuple!(A.0);
varying_tuple!(A.0, C.1);
varying_tuple!(A.0, C.1, D.2);
varying_tuple!(A.0, C.1, D.2, E.3);
varying_tuple!(A.0, C.1, D.2, E.3, G.4);
varying_tuple!(A.0, C.1, D.2, E.3, G.4, H.5);
varying_tuple!(A.0, C.1, D.2, E.3, G.4, H.5, J.6);
varying_tuple!(A.0, C.1, D.2, E.3, G.4, H.5, J.6, K.7);

#[diagnostic::do_not_recommend]
impl<M: Machine> Varying<M> for () {
    type Value = ();

    #[inline(always)]
    fn varying(self, _: &M) {}
}

/// The two bounds of a `for`, as values of one type.
#[diagnostic::on_unimplemented(
    message = "the bounds of a kernel's `for` are two integers of one type",
    label = "not an integer of the other bound's type",
    note = "write for example `for i in 0..n` with a `u32`, `i32` or `usize`"
)]
pub trait Bounds<M: Machine, E> {
    /// The counter's type.
    type Counter: Value<M>;
    /// Converts both.
    fn bounds(m: &M, start: Self, end: E) -> (Self::Counter, Self::Counter);
}

macro_rules! bounds {
    ($($t:ident $host:ty),+) => {
        $(
            bounds!(@one $t, $t<M>, $t<M>);
            bounds!(@one $t, $host, $t<M>);
            bounds!(@one $t, $t<M>, $host);
            bounds!(@one $t, $host, $host);
        )+
    };
    (@one $t:ident, $a:ty, $b:ty) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> Bounds<M, $b> for $a {
            type Counter = $t<M>;

            #[inline(always)]
            fn bounds(m: &M, start: $a, end: $b) -> ($t<M>, $t<M>) {
                (Coerce::coerce(start, m), Coerce::coerce(end, m))
            }
        }
    };
}

bounds!(I i32, U u32, Usize usize);

// Numbers. Each operator for (lane, lane), (lane, host), (host, lane) and (host, host).

macro_rules! operator {
    ($trait:ident :: $method:ident, $a:ty, $b:ty, $out:ty, |$m:ident, $x:ident, $y:ident| $e:expr) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> $trait<M, $b> for $a {
            type Output = $out;

            #[inline(always)]
            fn $method($m: &M, $x: $a, $y: $b) -> $out {
                $e
            }
        }
    };
}

macro_rules! f32_operators {
    ($($trait:ident :: $method:ident $op:ident),+) => {
        $(
            operator!($trait::$method, F<M>, F<M>, F<M>, |m, a, b| {
                F(m.f32_binary(op::$op, a.0, b.0))
            });
        )+
    };
}

f32_operators!(OpAdd::add Add, OpSub::sub Sub, OpMul::mul Mul, OpDiv::div Div);

/// What the error of `%` of floats is about.
pub struct RemainderOfFloats<M>(core::marker::PhantomData<M>);

const _: () = {
    #[diagnostic::on_unimplemented(
        message = "a kernel has no `%` of floats: an exact one takes hundreds of steps",
        label = "not in the kernel language",
        note = "write `x - y * (x / y).trunc()`, or with `floor` for a remainder that is never \
                negative"
    )]
    pub trait IsShort {}

    impl<M: Machine, R> OpRem<M, R> for F<M>
    where
        RemainderOfFloats<M>: IsShort,
    {
        type Output = F<M>;

        fn rem(_: &M, _: F<M>, _: R) -> F<M> {
            unreachable!()
        }
    }
};

macro_rules! int_operators {
    ($($trait:ident :: $method:ident $op:ident $symbol:tt),+) => {
        $(
            int_operators!(@one $trait::$method $op $symbol, I, i32, i32_binary);
            int_operators!(@one $trait::$method $op $symbol, U, u32, u32_binary);
            int_operators!(@one $trait::$method $op $symbol, Usize, usize, u32_binary);
        )+
    };
    (@one $trait:ident :: $method:ident $op:ident $symbol:tt, $t:ident, $host:ty, $f:ident) => {
        operator!($trait::$method, $t<M>, $t<M>, $t<M>, |m, a, b| $t(m.$f(op::$op, a.0, b.0)));
        operator!($trait::$method, $t<M>, $host, $t<M>, |m, a, b| {
            $t(m.$f(op::$op, a.0, <$host as Type>::splat(m, b).0))
        });
        operator!($trait::$method, $host, $t<M>, $t<M>, |m, a, b| {
            $t(m.$f(op::$op, <$host as Type>::splat(m, a).0, b.0))
        });
        operator!($trait::$method, $host, $host, $host, |_m, a, b| a $symbol b);
    };
}

int_operators!(
    OpAdd::add Add +, OpSub::sub Sub -, OpMul::mul Mul *, OpDiv::div Div /, OpRem::rem Rem %,
    OpBitAnd::bit_and And &, OpBitOr::bit_or Or |, OpBitXor::bit_xor Xor ^,
    OpShl::shl Shl <<, OpShr::shr Shr >>
);

// Rust lets the amount of a shift have another integer type.
macro_rules! mixed_shift {
    ($($trait:ident :: $method:ident $op:ident),+) => {
        $(
            operator!($trait::$method, I<M>, U<M>, I<M>, |m, a, b| {
                I(m.i32_binary(op::$op, a.0, m.u32_to_i32(b.0)))
            });
            operator!($trait::$method, U<M>, I<M>, U<M>, |m, a, b| {
                U(m.u32_binary(op::$op, a.0, m.i32_to_u32(b.0)))
            });
        )+
    };
}

mixed_shift!(OpShl::shl Shl, OpShr::shr Shr);

// Vectors with vectors and with single numbers on either side.

macro_rules! vector_operators {
    ($bound:ident $right:ident :: $convert:ident |$m:ident, $v:ident, $op:ident, $a:ident, $b:ident| $e:expr;
     $($trait:ident :: $method:ident $name:ident),+) => {
        $(
            vector_operators!(@one $bound $right::$convert |$m, $v, $op, $a, $b| $e;
                $trait::$method $name X2);
            vector_operators!(@one $bound $right::$convert |$m, $v, $op, $a, $b| $e;
                $trait::$method $name X3);
            vector_operators!(@one $bound $right::$convert |$m, $v, $op, $a, $b| $e;
                $trait::$method $name X4);
        )+
    };
    (@one $bound:ident $right:ident :: $convert:ident |$m:ident, $v:ident, $op:ident, $a:ident, $b:ident| $e:expr;
     $trait:ident :: $method:ident $name:ident $x:ident) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, E: $bound<M>, R> $trait<M, R> for $x<E>
        where
            $x<E>: $right<M, R>,
        {
            type Output = $x<E>;

            #[inline(always)]
            fn $method($m: &M, $a: $x<E>, b: R) -> $x<E> {
                type $v<E> = $x<E>;
                let $op = op::$name;
                let $b = $x::<E>::$convert($m, b);
                $e
            }
        }
    };
}

vector_operators!(Arithmetic Broadcast::broadcast |m, X, op, a, b| X::<E>::arithmetic(m, op, a, b);
    OpAdd::add Add, OpSub::sub Sub, OpMul::mul Mul, OpDiv::div Div);
vector_operators!(Integer Broadcast::broadcast |m, X, op, a, b| X::<E>::arithmetic(m, op, a, b);
    OpRem::rem Rem);
vector_operators!(Integer Amounts::amounts |m, X, op, a, b| X::<E>::arithmetic(m, op, a, b);
    OpShl::shl Shl, OpShr::shr Shr);
vector_operators!(Bits Broadcast::broadcast |m, X, op, a, b| {
    X::of(E::bits_each(m, op, a.components(), b.components()))
};
    OpBitAnd::bit_and And, OpBitOr::bit_or Or, OpBitXor::bit_xor Xor);

macro_rules! number_with_vector {
    ($($t:ty => $component:ident: $($trait:ident :: $method:ident $op:ident),+;)+) => {
        $($(
            number_with_vector!(@one $t, $component, $trait $method $op, X2);
            number_with_vector!(@one $t, $component, $trait $method $op, X3);
            number_with_vector!(@one $t, $component, $trait $method $op, X4);
        )+)+
    };
    // Each vector by itself: an impl for all of them would claim what is none, and give it a
    // result.
    (@one $t:ty, $component:ident, $trait:ident $method:ident $op:ident, $vector:ident) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> $trait<M, $vector<$component<M>>> for $t {
            type Output = $vector<$component<M>>;

            #[inline(always)]
            fn $method(m: &M, a: $t, b: $vector<$component<M>>) -> $vector<$component<M>> {
                let a: $component<M> = Coerce::coerce(a, m);
                Vector::arithmetic(m, op::$op, Vector::of_one(a), b)
            }
        }
    };
}

number_with_vector! {
    F<M> => F: OpAdd::add Add, OpSub::sub Sub, OpMul::mul Mul, OpDiv::div Div;
    I<M> => I: OpAdd::add Add, OpSub::sub Sub, OpMul::mul Mul, OpDiv::div Div, OpRem::rem Rem;
    U<M> => U: OpAdd::add Add, OpSub::sub Sub, OpMul::mul Mul, OpDiv::div Div, OpRem::rem Rem;
    i32 => I: OpAdd::add Add, OpSub::sub Sub, OpMul::mul Mul, OpDiv::div Div, OpRem::rem Rem;
    u32 => U: OpAdd::add Add, OpSub::sub Sub, OpMul::mul Mul, OpDiv::div Div, OpRem::rem Rem;
}

// Truth values: `&&` and `&` differ only in what the macro does with the right side.

macro_rules! bool_operators {
    ($($trait:ident :: $method:ident $op:ident $symbol:tt),+) => {
        $(
            operator!($trait::$method, B<M>, B<M>, B<M>, |m, a, b| {
                B(m.bool_binary(op::$op, a.0, b.0))
            });
            operator!($trait::$method, B<M>, bool, B<M>, |m, a, b| {
                B(m.bool_binary(op::$op, a.0, m.bool(b)))
            });
            operator!($trait::$method, bool, B<M>, B<M>, |m, a, b| {
                B(m.bool_binary(op::$op, m.bool(a), b.0))
            });
            operator!($trait::$method, bool, bool, bool, |_m, a, b| a $symbol b);
        )+
    };
}

bool_operators!(
    OpAnd::and And &&, OpOr::or Or ||,
    OpBitAnd::bit_and And &, OpBitOr::bit_or Or |, OpBitXor::bit_xor Xor ^
);

// Unary operators.

macro_rules! unary {
    ($trait:ident :: $method:ident, $t:ty, |$m:ident, $a:ident| $e:expr) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> $trait<M> for $t {
            #[inline(always)]
            fn $method($m: &M, $a: Self) -> Self {
                $e
            }
        }
    };
}

unary!(OpNeg::neg, F<M>, |m, a| F(m.f32_unary(op::Neg, a.0)));
unary!(OpNeg::neg, I<M>, |m, a| I(m.i32_neg(a.0)));
unary!(OpNeg::neg, i32, |_m, a| -a);
unary!(OpNot::not, B<M>, |m, a| B(m.bool_not(a.0)));
unary!(OpNot::not, I<M>, |m, a| I(m.i32_not(a.0)));
unary!(OpNot::not, U<M>, |m, a| U(m.u32_not(a.0)));
unary!(OpNot::not, bool, |_m, a| !a);
unary!(OpNot::not, i32, |_m, a| !a);
unary!(OpNot::not, u32, |_m, a| !a);
unary!(OpNot::not, Usize<M>, |m, a| Usize(m.u32_not(a.0)));

macro_rules! vector_unary {
    ($($v:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> OpNeg<M> for $v<F<M>> {
                #[inline(always)]
                fn neg(m: &M, a: Self) -> Self {
                    Self::unary(m, op::Neg, a)
                }
            }

            #[diagnostic::do_not_recommend]
            impl<M: Machine> OpNeg<M> for $v<I<M>> {
                #[inline(always)]
                fn neg(m: &M, a: Self) -> Self {
                    a.each(#[inline(always)] |c| Arithmetic::neg(m, c))
                }
            }

            #[diagnostic::do_not_recommend]
            impl<M: Machine, E: Bits<M>> OpNot<M> for $v<E> {
                #[inline(always)]
                fn not(m: &M, a: Self) -> Self {
                    a.each(#[inline(always)] |c| E::not(m, c))
                }
            }

            /// `==` and `!=` of whole vectors.
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

vector_unary!(X2, X3, X4);

// Comparisons.

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
    scalar::compare(O::OP, a, b)
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

/// `==` and `!=`; an order of truth values (`false < true`) is spelled out.
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

/// What vectors of it need for `==` and `!=`.
pub trait Equal<M: Machine>: super::vector::Component<M> {
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

// Conversions.

macro_rules! cast {
    ($($a:ty => $t:ident: |$m:ident, $x:ident| $e:expr),+ $(,)?) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> OpCast<M, $t> for $a {
                #[inline(always)]
                fn cast($m: &M, $x: $a) -> <$t as Type>::On<M> {
                    $e
                }
            }
        )+
    };
}

cast!(
    F<M> => f32: |_m, a| a,
    F<M> => i32: |m, a| I(m.f32_to_i32(a.0)),
    F<M> => u32: |m, a| U(m.f32_to_u32(a.0)),
    I<M> => f32: |m, a| F(m.i32_to_f32(a.0)),
    I<M> => i32: |_m, a| a,
    I<M> => u32: |m, a| U(m.i32_to_u32(a.0)),
    U<M> => f32: |m, a| F(m.u32_to_f32(a.0)),
    U<M> => i32: |m, a| I(m.u32_to_i32(a.0)),
    U<M> => u32: |_m, a| a,
    B<M> => u32: |m, a| U(m.bool_to_u32(a.0)),
    B<M> => i32: |m, a| I(m.u32_to_i32(m.bool_to_u32(a.0))),
    i32 => f32: |m, a| F(m.f32(a as f32)),
    i32 => i32: |m, a| I(m.i32(a)),
    i32 => u32: |m, a| U(m.u32(a as u32)),
    u32 => f32: |m, a| F(m.f32(a as f32)),
    u32 => i32: |m, a| I(m.i32(a as i32)),
    u32 => u32: |m, a| U(m.u32(a)),
    bool => u32: |m, a| U(m.u32(u32::from(a))),
    bool => i32: |m, a| I(m.i32(i32::from(a))),
    bool => usize: |m, a| Usize(m.u32(u32::from(a))),
    F<M> => usize: |m, a| Usize(m.f32_to_u32(a.0)),
    I<M> => usize: |m, a| Usize(m.i32_to_u32(a.0)),
    U<M> => usize: |_m, a| Usize(a.0),
    B<M> => usize: |m, a| Usize(m.bool_to_u32(a.0)),
    Usize<M> => f32: |m, a| F(m.u32_to_f32(a.0)),
    Usize<M> => i32: |m, a| I(m.u32_to_i32(a.0)),
    Usize<M> => u32: |_m, a| U(a.0),
    Usize<M> => usize: |_m, a| a,
    i32 => usize: |m, a| Usize(m.u32(a as u32)),
    u32 => usize: |m, a| Usize(m.u32(a)),
    usize => f32: |m, a| F(m.f32(a as f32)),
    usize => i32: |m, a| I(m.i32(a as i32)),
    usize => u32: |m, a| U(m.u32(a as u32)),
    usize => usize: |m, a| Usize(m.u32(a as u32)),
);
