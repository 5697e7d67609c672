//! The twins of glam's vectors, of floats, integers and truth values alike.
//!
//! One struct per size, generic over the component, implements every component type once.
//! [`Vector`] lets an operation be written once for all sizes.

use super::op::known;
use super::{
    B, BoolBinary, Coerce, Compare, F, F32Binary, F32Unary, I, IntBinary, Leaves, Machine, Op,
    OpCast, Schema, U, Value, Varying, fill, op,
};

/// `Vec2` on machine `M`.
pub type V2<M> = X2<F<M>>;
/// `Vec3` on machine `M`.
pub type V3<M> = X3<F<M>>;
/// `Vec4` on machine `M`.
pub type V4<M> = X4<F<M>>;

/// The component type of a vector.
pub trait Component<M: Machine>: Value<M> + Varying<M, Value = Self> {}

#[diagnostic::do_not_recommend]
impl<M: Machine> Component<M> for F<M> {}
#[diagnostic::do_not_recommend]
impl<M: Machine> Component<M> for I<M> {}
#[diagnostic::do_not_recommend]
impl<M: Machine> Component<M> for U<M> {}
#[diagnostic::do_not_recommend]
impl<M: Machine> Component<M> for B<M> {}

/// A number type with arithmetic on one number and on several at once.
#[diagnostic::on_unimplemented(
    message = "a kernel has no operator for these operands",
    label = "not an operation of the kernel language"
)]
pub trait Arithmetic<M: Machine>: Component<M> {
    /// Applies `+`, `-`, `*` or `/`; for integers, the others too.
    fn binary<O: Op<IntBinary>>(m: &M, op: O, a: Self, b: Self) -> Self;
    /// Applies `binary` to every component.
    fn binary_each<O: Op<IntBinary>, const N: usize>(
        m: &M,
        op: O,
        a: [Self; N],
        b: [Self; N],
    ) -> [Self; N];
    /// Compares two numbers.
    fn compare<O: Op<Compare>>(m: &M, op: O, a: Self, b: Self) -> B<M>;
    /// Returns the lesser or the greater of each component: [`op::Min`] or [`op::Max`].
    fn extreme_each<O: Op<F32Binary>, const N: usize>(
        m: &M,
        op: O,
        a: [Self; N],
        b: [Self; N],
    ) -> [Self; N];
    /// Returns the lesser or the greater of two numbers.
    fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self;
    /// Returns `-a`.
    fn neg(m: &M, a: Self) -> Self;
}

/// A number type with the operators that only integers have.
#[diagnostic::on_unimplemented(
    message = "a kernel has no such operator for these operands",
    label = "an operation of integers",
    note = "of floats: `%` is not the same everywhere; write `x - y * (x / y).trunc()`, or with \
            `floor` for a remainder that is never negative"
)]
pub trait Integer<M: Machine>: Arithmetic<M> {
    /// Whether it has negative numbers.
    const SIGNED: bool;
    /// Returns the number `v`.
    fn number(m: &M, v: i32) -> Self;
    /// Returns `if c { a } else { b }`.
    fn choose(m: &M, c: B<M>, a: Self, b: Self) -> Self;
    /// Returns the bits.
    fn to_u32(self, m: &M) -> U<M>;
    /// Returns the number with these bits.
    fn from_u32(m: &M, bits: U<M>) -> Self;
}

/// A component type with `&`, `|` and `^`.
#[diagnostic::on_unimplemented(
    message = "a kernel has no such operator for these operands",
    label = "an operation of integers and truth values"
)]
pub trait Bits<M: Machine>: Component<M> {
    /// Applies the operator to every component.
    fn bits_each<O: Op<IntBinary>, const N: usize>(
        m: &M,
        op: O,
        a: [Self; N],
        b: [Self; N],
    ) -> [Self; N];
    /// Returns `!` of one component.
    fn not(m: &M, a: Self) -> Self;
}

/// The operation on floats, if it is not one of integers alone.
#[derive(Clone, Copy)]
struct OfFloats<O>(O);

impl<O: Op<IntBinary>> Op<F32Binary> for OfFloats<O> {
    const OP: F32Binary = match O::OP {
        IntBinary::Add => F32Binary::Add,
        IntBinary::Sub => F32Binary::Sub,
        IntBinary::Mul => F32Binary::Mul,
        IntBinary::Div => F32Binary::Div,
        _ => panic!("only integers have it"),
    };
}

/// The operation on truth values, if there is one.
#[derive(Clone, Copy)]
struct OfTruths<O>(O);

impl<O: Op<IntBinary>> Op<BoolBinary> for OfTruths<O> {
    const OP: BoolBinary = match O::OP {
        IntBinary::And => BoolBinary::And,
        IntBinary::Or => BoolBinary::Or,
        IntBinary::Xor => BoolBinary::Xor,
        _ => panic!("only integers have it"),
    };
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Arithmetic<M> for F<M> {
    #[inline(always)]
    fn binary<O: Op<IntBinary>>(m: &M, op: O, a: Self, b: Self) -> Self {
        F(m.f32_binary(OfFloats(op), a.0, b.0))
    }

    #[inline(always)]
    fn binary_each<O: Op<IntBinary>, const N: usize>(
        m: &M,
        op: O,
        a: [Self; N],
        b: [Self; N],
    ) -> [Self; N] {
        wrap_f32(m.vector_binary(OfFloats(op), unwrap_f32(a), unwrap_f32(b)))
    }

    #[inline(always)]
    fn compare<O: Op<Compare>>(m: &M, op: O, a: Self, b: Self) -> B<M> {
        B(m.f32_compare(op, a.0, b.0))
    }

    #[inline(always)]
    fn extreme_each<O: Op<F32Binary>, const N: usize>(
        m: &M,
        op: O,
        a: [Self; N],
        b: [Self; N],
    ) -> [Self; N] {
        wrap_f32(m.vector_binary(op, unwrap_f32(a), unwrap_f32(b)))
    }

    #[inline(always)]
    fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self {
        F(m.f32_binary(op, a.0, b.0))
    }

    #[inline(always)]
    fn neg(m: &M, a: Self) -> Self {
        F(m.f32_unary(op::Neg, a.0))
    }
}

#[inline(always)]
fn unwrap_f32<M: Machine, const N: usize>(a: [F<M>; N]) -> [M::F32; N] {
    fill(
        #[inline(always)]
        |i| a[i].0,
    )
}

#[inline(always)]
fn wrap_f32<M: Machine, const N: usize>(a: [M::F32; N]) -> [F<M>; N] {
    fill(
        #[inline(always)]
        |i| F(a[i]),
    )
}

macro_rules! integer {
    ($t:ident $signed:literal $binary:ident $each:ident $compare:ident $select:ident $not:ident;
     |$m:ident, $a:ident| neg $neg:expr; number |$v:ident| $number:expr;
     to $to:expr; from $from:expr) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> Arithmetic<M> for $t<M> {
            #[inline(always)]
            fn binary<O: Op<IntBinary>>(m: &M, op: O, a: Self, b: Self) -> Self {
                $t(m.$binary(op, a.0, b.0))
            }

            #[inline(always)]
            fn binary_each<O: Op<IntBinary>, const N: usize>(
                m: &M,
                op: O,
                a: [Self; N],
                b: [Self; N],
            ) -> [Self; N] {
                let all = m.$each::<_, N>(
                    op,
                    fill(
                        #[inline(always)]
                        |i| a[i].0,
                    ),
                    fill(
                        #[inline(always)]
                        |i| b[i].0,
                    ),
                );
                fill(
                    #[inline(always)]
                    |i: usize| $t(all[i]),
                )
            }

            #[inline(always)]
            fn compare<O: Op<Compare>>(m: &M, op: O, a: Self, b: Self) -> B<M> {
                B(m.$compare(op, a.0, b.0))
            }

            #[inline(always)]
            fn extreme_each<O: Op<F32Binary>, const N: usize>(
                m: &M,
                op: O,
                a: [Self; N],
                b: [Self; N],
            ) -> [Self; N] {
                fill(
                    #[inline(always)]
                    |i| Self::extreme(m, op, a[i], b[i]),
                )
            }

            #[inline(always)]
            fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self {
                let _ = op;
                let (x, y) = known!(O::OP; F32Binary::Max => (a, b), _ => (b, a),);
                $t(m.$select(m.$compare(op::Lt, x.0, y.0), b.0, a.0))
            }

            #[inline(always)]
            fn neg($m: &M, $a: Self) -> Self {
                $neg
            }
        }

        impl<M: Machine> Integer<M> for $t<M> {
            const SIGNED: bool = $signed;

            #[inline(always)]
            fn number($m: &M, $v: i32) -> Self {
                $number
            }

            #[inline(always)]
            fn choose(m: &M, c: B<M>, a: Self, b: Self) -> Self {
                $t(m.$select(c.0, a.0, b.0))
            }

            #[inline(always)]
            fn to_u32(self, $m: &M) -> U<M> {
                let $a = self;
                $to
            }

            #[inline(always)]
            fn from_u32($m: &M, $a: U<M>) -> Self {
                $from
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine> Bits<M> for $t<M> {
            #[inline(always)]
            fn bits_each<O: Op<IntBinary>, const N: usize>(
                m: &M,
                op: O,
                a: [Self; N],
                b: [Self; N],
            ) -> [Self; N] {
                Self::binary_each(m, op, a, b)
            }

            #[inline(always)]
            fn not(m: &M, a: Self) -> Self {
                $t(m.$not(a.0))
            }
        }
    };
}

integer!(I true i32_binary i32_vector_binary i32_compare i32_select i32_not;
    |m, a| neg I(m.i32_neg(a.0)); number |v| I(m.i32(v));
    to U(m.i32_to_u32(a.0)); from I(m.u32_to_i32(a.0)));
// A `u32` has no `-`: nothing calls this.
integer!(U false u32_binary u32_vector_binary u32_compare u32_select u32_not;
    |m, a| neg U(m.u32_binary(op::WrappingSub, m.u32(0), a.0)); number |v| U(m.u32(v as u32));
    to { let _ = m; a }; from { let _ = m; a });

#[diagnostic::do_not_recommend]
impl<M: Machine> Bits<M> for B<M> {
    #[inline(always)]
    fn bits_each<O: Op<IntBinary>, const N: usize>(
        m: &M,
        op: O,
        a: [Self; N],
        b: [Self; N],
    ) -> [Self; N] {
        fill(
            #[inline(always)]
            |i| B(m.bool_binary(OfTruths(op), a[i].0, b[i].0)),
        )
    }

    #[inline(always)]
    fn not(m: &M, a: Self) -> Self {
        B(m.bool_not(a.0))
    }
}

/// A vector on any machine. Without a parameter, so that rustc knows that a user's twin does not
/// implement it: then impls for all vectors and those of the derive do not overlap.
pub trait IsVector {}

/// A number or a truth value, of the host or a machine, and not a vector.
pub trait IsScalar {}

impl<M: Machine> IsScalar for F<M> {}
impl<M: Machine> IsScalar for I<M> {}
impl<M: Machine> IsScalar for U<M> {}
impl<M: Machine> IsScalar for B<M> {}
impl IsScalar for f32 {}
impl IsScalar for i32 {}
impl IsScalar for u32 {}
impl IsScalar for bool {}

/// A vector of any size.
///
/// Componentwise functions are written out, and their callbacks are `Copy`: a closure that is
/// dropped has a landing pad at each call, and arrays pass through memory. Both vanish in
/// optimisation, but a packet's operation is eight calls deep, and all of it is compiled first.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot call this method with these arguments",
    label = "not an operation of the kernel language"
)]
pub trait Vector<M: Machine>: Value<M> {
    /// The component type.
    type Component: Component<M>;
    /// The vector of the same size with another component type.
    type Of<E: Component<M>>: Vector<M, Component = E>;

    /// Returns `v` in every component.
    fn of_one(v: Self::Component) -> Self;
    /// Applies `f` to every component.
    fn each<E: Component<M>>(self, f: impl Fn(Self::Component) -> E + Copy) -> Self::Of<E>;
    /// Applies `f` to every pair of components.
    fn both<D: Component<M>, E: Component<M>>(
        self,
        b: Self::Of<D>,
        f: impl Fn(Self::Component, D) -> E + Copy,
    ) -> Self::Of<E>;
    /// Folds the components from the first to the last.
    fn fold(
        self,
        f: impl Fn(Self::Component, Self::Component) -> Self::Component + Copy,
    ) -> Self::Component;
    /// Folds the components from the last to the first.
    fn fold_back(
        self,
        f: impl Fn(Self::Component, Self::Component) -> Self::Component + Copy,
    ) -> Self::Component;
    /// Applies an arithmetic operation to every component.
    fn arithmetic<O: Op<IntBinary>>(m: &M, op: O, a: Self, b: Self) -> Self
    where
        Self::Component: Arithmetic<M>;
    /// Applies [`Arithmetic::extreme_each`].
    fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self
    where
        Self::Component: Arithmetic<M>;
}

/// A vector of floats.
pub trait Floats<M: Machine>: Vector<M, Component = F<M>, Of<F<M>> = Self> {
    /// Applies an operation to every component of two vectors.
    fn binary<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self;
    /// Applies an operation to every component.
    fn unary<O: Op<F32Unary>>(m: &M, op: O, a: Self) -> Self;
}

/// The right side of an operator as a vector: a vector, or one number for all components.
#[diagnostic::on_unimplemented(
    message = "a kernel has no operator for these operands",
    label = "not an operation of the kernel language"
)]
pub trait Broadcast<M: Machine, R>: Sized {
    /// Converts the operand.
    fn broadcast(m: &M, r: R) -> Self;
}

/// The right side of a shift, which may have another integer type, as a vector.
#[diagnostic::on_unimplemented(message = "a kernel cannot shift this by that")]
pub trait Amounts<M: Machine, R>: Sized {
    /// Converts the operand.
    fn amounts(m: &M, r: R) -> Self;
}

/// The amount by which to shift a number of type `E`.
pub trait Amount<M: Machine, E> {
    /// Converts the amount.
    fn amount(self, m: &M) -> E;
}

macro_rules! amount {
    ($($from:ty => $to:ident: |$m:ident, $a:ident| $e:expr),+ $(,)?) => {
        $(
            impl<M: Machine> Amount<M, $to<M>> for $from {
                #[inline(always)]
                fn amount(self, $m: &M) -> $to<M> {
                    let $a = self;
                    $e
                }
            }
        )+
    };
}

amount!(
    I<M> => I: |_m, a| a,
    U<M> => I: |m, a| I(m.u32_to_i32(a.0)),
    i32 => I: |m, a| I(m.i32(a)),
    U<M> => U: |_m, a| a,
    I<M> => U: |m, a| U(m.i32_to_u32(a.0)),
    u32 => U: |m, a| U(m.u32(a)),
);

macro_rules! vector {
    ($name:ident, $n:literal, $($c:ident $i:tt),+; $first:ident $($next:ident)+; $last:ident $($before:ident)+) => {
        #[doc = concat!("A vector of ", $n, " components on a machine.")]
        #[derive(Clone, Copy)]
        pub struct $name<E> {
            $(#[doc = concat!("Component ", stringify!($c), ".")] pub $c: E,)+
        }

        #[diagnostic::do_not_recommend]
        impl<E> IsVector for $name<E> {}

        impl<M: Machine, E: Component<M>> Value<M> for $name<E> {
            const SCHEMA: &'static Schema = &Schema::Vector(E::SCHEMA, $n);

            #[inline(always)]
            fn zero(m: &M) -> Self {
                Self { $($c: E::zero(m)),+ }
            }

            #[inline(always)]
            fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
                Self { $($c: E::zip(m, a.$c, b.$c, f)),+ }
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine, E: Component<M>> Varying<M> for $name<E> {
            type Value = Self;

            #[inline(always)]
            fn varying(self, _: &M) -> Self {
                self
            }
        }

        impl<E: Copy> $name<E> {
            #[inline(always)]
            pub(crate) fn components(self) -> [E; $n] {
                [$(self.$c),+]
            }

            #[inline(always)]
            pub(crate) fn of(a: [E; $n]) -> Self {
                Self { $($c: a[$i]),+ }
            }

            #[inline(always)]
            pub(crate) fn splat(v: E) -> Self {
                Self { $($c: v),+ }
            }
        }

        impl<M: Machine> $name<F<M>> {
            #[inline(always)]
            pub(crate) fn array(self) -> [M::F32; $n] {
                [$(self.$c.0),+]
            }

            #[inline(always)]
            pub(crate) fn from_array(a: [M::F32; $n]) -> Self {
                Self { $($c: F(a[$i])),+ }
            }
        }

        impl<M: Machine> Floats<M> for $name<F<M>> {
            #[inline(always)]
            fn binary<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self {
                if const { M::HAS_VECTORS } {
                    Self::from_array(m.vector_binary(op, a.array(), b.array()))
                } else {
                    Self { $($c: F(m.f32_binary(op, a.$c.0, b.$c.0))),+ }
                }
            }

            #[inline(always)]
            fn unary<O: Op<F32Unary>>(m: &M, op: O, a: Self) -> Self {
                if const { M::HAS_VECTORS } {
                    Self::from_array(m.vector_unary(op, a.array()))
                } else {
                    Self { $($c: F(m.f32_unary(op, a.$c.0))),+ }
                }
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine, C: Component<M>> Vector<M> for $name<C> {
            type Component = C;
            type Of<E: Component<M>> = $name<E>;

            #[inline(always)]
            fn of_one(v: C) -> Self {
                Self::splat(v)
            }

            #[inline(always)]
            fn each<E: Component<M>>(self, f: impl Fn(C) -> E + Copy) -> $name<E> {
                $name { $($c: f(self.$c)),+ }
            }

            #[inline(always)]
            fn both<D: Component<M>, E: Component<M>>(
                self,
                b: $name<D>,
                f: impl Fn(C, D) -> E + Copy,
            ) -> $name<E> {
                $name { $($c: f(self.$c, b.$c)),+ }
            }

            #[inline(always)]
            fn fold(self, f: impl Fn(C, C) -> C + Copy) -> C {
                let all = self.$first;
                $(let all = f(all, self.$next);)+
                all
            }

            #[inline(always)]
            fn fold_back(self, f: impl Fn(C, C) -> C + Copy) -> C {
                let all = self.$last;
                $(let all = f(all, self.$before);)+
                all
            }

            #[inline(always)]
            fn arithmetic<O: Op<IntBinary>>(m: &M, op: O, a: Self, b: Self) -> Self
            where
                C: Arithmetic<M>,
            {
                if const { M::HAS_VECTORS } {
                    Self::of(C::binary_each(m, op, a.components(), b.components()))
                } else {
                    Self { $($c: C::binary(m, op, a.$c, b.$c)),+ }
                }
            }

            #[inline(always)]
            fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self
            where
                C: Arithmetic<M>,
            {
                if const { M::HAS_VECTORS } {
                    Self::of(C::extreme_each(m, op, a.components(), b.components()))
                } else {
                    Self { $($c: C::extreme(m, op, a.$c, b.$c)),+ }
                }
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine, E: Component<M>> Broadcast<M, $name<E>> for $name<E> {
            #[inline(always)]
            fn broadcast(_: &M, r: Self) -> Self {
                r
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine, E: Component<M>, A: IsScalar + Coerce<M, E>> Broadcast<M, A> for $name<E> {
            #[inline(always)]
            fn broadcast(m: &M, r: A) -> Self {
                Self::splat(r.coerce(m))
            }
        }

        impl<M: Machine, E: Integer<M>, A: Amount<M, E>> Amounts<M, $name<A>> for $name<E> {
            #[inline(always)]
            fn amounts(m: &M, r: $name<A>) -> Self {
                Self { $($c: r.$c.amount(m)),+ }
            }
        }

        impl<M: Machine, E: Integer<M>, A: IsScalar + Amount<M, E>> Amounts<M, A> for $name<E> {
            #[inline(always)]
            fn amounts(m: &M, r: A) -> Self {
                Self::splat(r.amount(m))
            }
        }
    };
}

vector!(X2, 2, x 0, y 1; x y; y x);
vector!(X3, 3, x 0, y 1, z 2; x y z; z y x);
vector!(X4, 4, x 0, y 1, z 2, w 3; x y z w; w z y x);

/// Applies `as` to every component.
#[inline(always)]
pub(crate) fn cast_each<M, V, T>(m: &M, v: V) -> V::Of<T::On<M>>
where
    M: Machine,
    V: Vector<M>,
    T: super::Type<On<M>: Component<M>>,
    V::Component: OpCast<M, T>,
{
    v.each(
        #[inline(always)]
        |c| OpCast::<M, T>::cast(m, c),
    )
}
