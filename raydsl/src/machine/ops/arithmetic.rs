//! Arithmetic operators: each for two values of the machine, and for host values on one or both
//! sides where a literal may be an operand.

use super::{
    Coerce, OpAdd, OpAnd, OpBitAnd, OpBitOr, OpBitXor, OpDiv, OpMul, OpNeg, OpNot, OpOr, OpRem,
    OpShl, OpShr, OpSub,
};
use crate::machine::vector::{Amounts, Arithmetic, Bits, Broadcast, Floats, Integer, Vector};
use crate::machine::{B, F, I, Machine, Type, U, Usize, X2, X3, X4, op};

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

/// Carries the error message for `%` of floats.
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
    // Each vector by itself: an impl for all of them would also claim other types, and give them a
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

// Truth values: `&&` and `&` differ only in the macro's treatment of the right side.

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
        )+
    };
}

vector_unary!(X2, X3, X4);
