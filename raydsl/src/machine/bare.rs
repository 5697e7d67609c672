//! Integers whose type the source leaves to inference: `let mut n = 0`, `for i in 0..4`.
//!
//! rustc infers the type of such a number from its uses, and takes `i32` where none says it. That
//! works for its own integers only, so a [`Bare`] number carries the type of the host as a
//! parameter: the literal of the source is an argument of [`bare`], and the impls below let every
//! use say as much of it as it does in Rust. An index makes it a `usize`, a sum with a `u32` a `u32`.

use core::marker::PhantomData;

use super::generic::{Alike, OrderedOn};
use super::vector::IsScalar;
use super::{
    B, Bounds, Coerce, Compare, Counter, F32Binary, I, Index, Inferred, Leaves, Machine, Method,
    Op, OpAdd, OpBitAnd, OpBitOr, OpBitXor, OpCast, OpCompare, OpDiv, OpMul, OpNeg, OpNot, OpRem,
    OpShl, OpShr, OpSub, Plain, Schema, Type, U, Usize, Value, Varying,
};

/// An integer of the host.
pub trait Integer: Type {
    /// Its bits on the machine.
    fn bits<M: Machine>(m: &M, v: Self::On<M>) -> U<M>;
}

/// A number of the type `K`, which rustc infers.
pub struct Bare<M: Machine, K: Integer>(K::On<M>, PhantomData<K>);

impl<M: Machine, K: Integer> Clone for Bare<M, K> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Machine, K: Integer> Copy for Bare<M, K> {}

/// A literal without a suffix, as a value of the machine.
#[inline(always)]
pub fn bare<M: Machine, K: Integer>(m: &M, k: K) -> Bare<M, K> {
    of(K::splat(m, k))
}

#[inline(always)]
fn of<M: Machine, K: Integer>(v: K::On<M>) -> Bare<M, K> {
    Bare(v, PhantomData)
}

impl<M: Machine, K: Integer> Value<M> for Bare<M, K> {
    const SCHEMA: &'static Schema = K::SCHEMA;

    #[inline(always)]
    fn zero(m: &M) -> Self {
        of(Value::zero(m))
    }

    #[inline(always)]
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
        of(Value::zip(m, a.0, b.0, f))
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> Varying<M> for Bare<M, K> {
    type Value = Self;

    #[inline(always)]
    fn varying(self, _: &M) -> Self {
        self
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> Inferred<M> for Bare<M, K> {
    type Host = K;

    #[inline(always)]
    fn give(self, _: &M) -> K::On<M> {
        self.0
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> Index<M> for Bare<M, K>
where
    Self: Coerce<M, Usize<M>>,
{
    #[inline(always)]
    fn index(self, m: &M) -> U<M> {
        U(self.coerce(m).0)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer, T: Type> OpCast<M, T> for Bare<M, K>
where
    K::On<M>: OpCast<M, T>,
{
    #[inline(always)]
    fn cast(m: &M, a: Self) -> T::On<M> {
        OpCast::cast(m, a.0)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> OpNeg<M> for Bare<M, K>
where
    K::On<M>: OpNeg<M>,
{
    #[inline(always)]
    fn neg(m: &M, a: Self) -> Self {
        of(OpNeg::neg(m, a.0))
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> OpNot<M> for Bare<M, K>
where
    K::On<M>: OpNot<M>,
{
    #[inline(always)]
    fn not(m: &M, a: Self) -> Self {
        of(OpNot::not(m, a.0))
    }
}

impl<M: Machine, K: Integer> IsScalar for Bare<M, K> {}
impl<M: Machine, K: Integer> Plain for Bare<M, K> {}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> Counter<M> for Bare<M, K>
where
    K::On<M>: Counter<M>,
{
    #[inline(always)]
    fn bits(self, m: &M) -> M::U32 {
        self.0.bits(m)
    }
    #[inline(always)]
    fn of_bits(m: &M, bits: M::U32) -> Self {
        of(Counter::of_bits(m, bits))
    }
    #[inline(always)]
    fn is_less(a: u32, b: u32) -> bool {
        <K::On<M> as Counter<M>>::is_less(a, b)
    }
    #[inline(always)]
    fn next(self, m: &M) -> Self {
        of(self.0.next(m))
    }
    #[inline(always)]
    fn previous(self, m: &M) -> Self {
        of(self.0.previous(m))
    }
}

#[diagnostic::do_not_recommend]
impl<const NAME: u64, M: Machine, K: Integer, A, Via> Method<NAME, M, A, Via> for Bare<M, K>
where
    K::On<M>: Method<NAME, M, A, Via>,
{
    type Output = <K::On<M> as Method<NAME, M, A, Via>>::Output;

    #[inline(always)]
    fn call(self, m: &M, args: A) -> Self::Output {
        self.0.call(m, args)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> OrderedOn<M> for Bare<M, K>
where
    K::On<M>: OrderedOn<M>,
{
    #[inline(always)]
    fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self {
        of(OrderedOn::extreme(m, op, a.0, b.0))
    }
}

/// Impls for what may stand beside a bare number: another, a literal, and each integer of the machine.
macro_rules! beside {
    ($each:ident!($($args:tt)*)) => {
        $each!($($args)* [K: Integer] Bare<M, K>, Bare<M, K>, |m, a, b| (a.0, b.0), Bare<M, K>);
        $each!($($args)* [K: Integer] Bare<M, K>, K, |m, a, b| (a.0, K::splat(m, b)), Bare<M, K>);
        $each!($($args)* [] i32, Bare<M, i32>, |m, a, b| (I(m.i32(a)), b.0), Bare<M, i32>);
        $each!($($args)* [] u32, Bare<M, u32>, |m, a, b| (U(m.u32(a)), b.0), Bare<M, u32>);
        $each!($($args)* [] usize, Bare<M, usize>, |m, a, b| {
            (<usize as Type>::splat(m, a), b.0)
        }, Bare<M, usize>);
        $each!($($args)* [] Bare<M, i32>, I<M>, |m, a, b| (a.0, b), Bare<M, i32>);
        $each!($($args)* [] I<M>, Bare<M, i32>, |m, a, b| (a, b.0), I<M>);
        $each!($($args)* [] Bare<M, u32>, U<M>, |m, a, b| (a.0, b), Bare<M, u32>);
        $each!($($args)* [] U<M>, Bare<M, u32>, |m, a, b| (a, b.0), U<M>);
        $each!($($args)* [] Bare<M, usize>, Usize<M>, |m, a, b| (a.0, b), Bare<M, usize>);
        $each!($($args)* [] Usize<M>, Bare<M, usize>, |m, a, b| (a, b.0), Usize<M>);
    };
}

macro_rules! operator {
    ($trait:ident :: $method:ident
     [K: Integer] $a:ty, $b:ty, |$m:ident, $x:ident, $y:ident| $pair:expr, $out:ty) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, K: Integer> $trait<M, $b> for $a
        where
            K::On<M>: $trait<M, K::On<M>, Output = K::On<M>>,
        {
            type Output = $out;

            #[inline(always)]
            fn $method($m: &M, $x: $a, $y: $b) -> $out {
                let (a, b) = $pair;
                of($trait::$method($m, a, b))
            }
        }
    };
    ($trait:ident :: $method:ident
     [] $a:ty, $b:ty, |$m:ident, $x:ident, $y:ident| $pair:expr, $out:ty) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> $trait<M, $b> for $a {
            type Output = $out;

            #[inline(always)]
            fn $method($m: &M, $x: $a, $y: $b) -> $out {
                let (a, b) = $pair;
                Coerce::<M, $out>::coerce($trait::$method($m, a, b), $m)
            }
        }
    };
}

beside!(operator!(OpAdd::add));
beside!(operator!(OpSub::sub));
beside!(operator!(OpMul::mul));
beside!(operator!(OpDiv::div));
beside!(operator!(OpRem::rem));
beside!(operator!(OpBitAnd::bit_and));
beside!(operator!(OpBitOr::bit_or));
beside!(operator!(OpBitXor::bit_xor));

macro_rules! compare {
    ([$($k:ident: $integer:ident)?] $a:ty, $b:ty, |$m:ident, $x:ident, $y:ident| $pair:expr, $out:ty) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, $($k: $integer)?> OpCompare<M, $b> for $a
        $(where
            $k::On<M>: OpCompare<M, $k::On<M>, Output = B<M>>,)?
        {
            type Output = B<M>;

            #[inline(always)]
            fn compare<O: Op<Compare>>($m: &M, op: O, $x: $a, $y: $b) -> B<M> {
                let (a, b) = $pair;
                OpCompare::compare($m, op, a, b)
            }
        }
    };
}

beside!(compare!());

macro_rules! bounds {
    ([$($k:ident: $integer:ident)?] $a:ty, $b:ty, |$m:ident, $x:ident, $y:ident| $pair:expr, $out:ty) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, $($k: $integer)?> Bounds<M, $b> for $a {
            type Counter = $out;

            #[inline(always)]
            fn bounds($m: &M, $x: $a, $y: $b) -> ($out, $out) {
                let (a, b) = $pair;
                bounds!(@both $m a b $($k)?)
            }
        }
    };
    (@both $m:ident $a:ident $b:ident K) => {{
        let _ = $m;
        (of($a), of($b))
    }};
    (@both $m:ident $a:ident $b:ident) => { ($a.coerce($m), $b.coerce($m)) };
}

beside!(bounds!());

macro_rules! integers {
    ($($host:ident $twin:ident),+) => {
        $(
            impl Integer for $host {
                #[inline(always)]
                fn bits<M: Machine>(m: &M, v: $twin<M>) -> U<M> {
                    U(Counter::bits(v, m))
                }
            }

            // A literal beside it has its type.
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Coerce<M, Bare<M, $host>> for $host {
                #[inline(always)]
                fn coerce(self, m: &M) -> Bare<M, $host> {
                    bare(m, self)
                }
            }

            #[diagnostic::do_not_recommend]
            impl<M: Machine> Coerce<M, $twin<M>> for Bare<M, $host> {
                #[inline(always)]
                fn coerce(self, _: &M) -> $twin<M> {
                    self.0
                }
            }

            #[diagnostic::do_not_recommend]
            impl<M: Machine> Coerce<M, Bare<M, $host>> for $twin<M> {
                #[inline(always)]
                fn coerce(self, _: &M) -> Bare<M, $host> {
                    of(self)
                }
            }

            #[diagnostic::do_not_recommend]
            impl<M: Machine, const N: usize> Coerce<M, [$twin<M>; N]> for [Bare<M, $host>; N] {
                #[inline(always)]
                fn coerce(self, _: &M) -> [$twin<M>; N] {
                    self.map(|v| v.0)
                }
            }
        )+
    };
}

integers!(i32 I, u32 U, usize Usize);

macro_rules! alike {
    ($($a:ty, $b:ty, $value:ty;)+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Alike<M, $b> for $a {
                type Value = $value;

                #[inline(always)]
                fn alike(self, m: &M, r: $b) -> ($value, $value) {
                    (self.coerce(m), r.coerce(m))
                }
            }
        )+
    };
}

alike! {
    Bare<M, i32>, I<M>, I<M>;
    I<M>, Bare<M, i32>, I<M>;
    Bare<M, u32>, U<M>, U<M>;
    U<M>, Bare<M, u32>, U<M>;
}

#[diagnostic::do_not_recommend]
impl<M: Machine, K: Integer> Alike<M, K> for Bare<M, K> {
    type Value = Self;

    #[inline(always)]
    fn alike(self, m: &M, r: K) -> (Self, Self) {
        (self, bare(m, r))
    }
}

// The amount of a shift has a type of its own.

macro_rules! shift {
    ($($trait:ident :: $method:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine, K: Integer, R> $trait<M, R> for Bare<M, K>
            where
                K::On<M>: $trait<M, R, Output = K::On<M>>,
            {
                type Output = Self;

                #[inline(always)]
                fn $method(m: &M, a: Self, b: R) -> Self {
                    of($trait::$method(m, a.0, b))
                }
            }

            shift!(@by $trait::$method I);
            shift!(@by $trait::$method U);
            shift!(@by $trait::$method Usize);
        )+
    };
    (@by $trait:ident :: $method:ident $twin:ident) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, K: Integer> $trait<M, Bare<M, K>> for $twin<M> {
            type Output = $twin<M>;

            #[inline(always)]
            fn $method(m: &M, a: $twin<M>, b: Bare<M, K>) -> $twin<M> {
                // The same amount, and the same error where it is out of range.
                let amount = <$twin<M> as Counter<M>>::of_bits(m, K::bits(m, b.0).0);
                $trait::$method(m, a, amount)
            }
        }
    };
}

shift!(OpShl::shl, OpShr::shr);
