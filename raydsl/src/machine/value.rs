//! Values on a machine: wrappers of the scalar types, and the operations of every twin.

use super::{Machine, Schema, fill};

macro_rules! scalar_wrapper {
    ($(#[$doc:meta])* $name:ident($repr:ident), $leaf:ident, $schema:ident) => {
        $(#[$doc])*
        pub struct $name<M: Machine>(pub M::$repr);

        impl<M: Machine> Clone for $name<M> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<M: Machine> Copy for $name<M> {}

        impl<M: Machine> Value<M> for $name<M> {
            const SCHEMA: &'static Schema = &Schema::$schema;

            #[inline(always)]
            fn zero(m: &M) -> Self {
                Self(m.$leaf(Default::default()))
            }

            #[inline(always)]
            fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
                Self(f.$leaf(m, a.0, b.0))
            }
        }
    };
}

scalar_wrapper!(
    /// An `f32` on machine `M`.
    F(F32), f32, F32
);
scalar_wrapper!(
    /// An `i32` on machine `M`.
    I(I32), i32, I32
);
scalar_wrapper!(
    /// A `u32` on machine `M`.
    U(U32), u32, U32
);
scalar_wrapper!(
    /// A `usize` on machine `M`, of 32 bits in a kernel.
    Usize(U32), u32, U32
);
scalar_wrapper!(
    /// A `bool` on machine `M`.
    B(Bool), bool, Bool
);

/// A value on machine `M`: the twin of a [`Type`](super::Type), or a host value carried along.
///
/// A twin is a tree whose leaves are scalars of the machine; a machine's operations on whole values
/// (blend, store, name) go through [`Value::zip`].
#[diagnostic::on_unimplemented(
    message = "a variable of a kernel cannot hold this",
    label = "not a value of the kernel language",
    note = "what a loop runs over stands in its head: `for hit in scene.hits(ray)`"
)]
pub trait Value<M: Machine>: Copy {
    /// The layout; [`Schema::Host`] if there are no leaves.
    const SCHEMA: &'static Schema;

    /// Returns a value with zero in every leaf.
    fn zero(m: &M) -> Self;

    /// Combines two values leaf by leaf, in order of declaration.
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self;
}

/// The operation of [`Value::zip`] at each leaf.
#[expect(missing_docs, reason = "one method a scalar type")]
pub trait Leaves<M: Machine> {
    fn f32(&mut self, m: &M, a: M::F32, b: M::F32) -> M::F32;
    fn i32(&mut self, m: &M, a: M::I32, b: M::I32) -> M::I32;
    fn u32(&mut self, m: &M, a: M::U32, b: M::U32) -> M::U32;
    fn bool(&mut self, m: &M, a: M::Bool, b: M::Bool) -> M::Bool;
}

/// Applies a function to the floats of values; other leaves stay those of the first value.
pub(crate) struct Floats<F>(pub(crate) F);

impl<M: Machine, F: FnMut(&M, M::F32, M::F32) -> M::F32> Leaves<M> for Floats<F> {
    #[inline(always)]
    fn f32(&mut self, m: &M, a: M::F32, b: M::F32) -> M::F32 {
        self.0(m, a, b)
    }
    #[inline(always)]
    fn i32(&mut self, _: &M, a: M::I32, _: M::I32) -> M::I32 {
        a
    }
    #[inline(always)]
    fn u32(&mut self, _: &M, a: M::U32, _: M::U32) -> M::U32 {
        a
    }
    #[inline(always)]
    fn bool(&mut self, _: &M, a: M::Bool, _: M::Bool) -> M::Bool {
        a
    }
}

impl<M: Machine> Value<M> for () {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(_: &M) -> Self {}

    #[inline(always)]
    fn zip(_: &M, (): Self, (): Self, _: &mut impl Leaves<M>) -> Self {}
}

macro_rules! host_value {
    ($($host:ty),+) => {
        $(
            /// A value of the host, known while a kernel is recorded.
            impl<M: Machine> Value<M> for $host {
                const SCHEMA: &'static Schema = &Schema::Host;

                #[inline(always)]
                fn zero(_: &M) -> Self {
                    Self::default()
                }

                #[inline(always)]
                fn zip(_: &M, a: Self, _: Self, _: &mut impl Leaves<M>) -> Self {
                    a
                }
            }
        )+
    };
}

host_value!(bool, i32, u32, usize);

/// Leaves the stride 0: an array's layout is described by its type.
impl<M: Machine, V: Value<M>, const N: usize> Value<M> for [V; N] {
    const SCHEMA: &'static Schema = &Schema::Array { element: V::SCHEMA, count: N, stride: 0 };

    #[inline(always)]
    fn zero(m: &M) -> Self {
        [V::zero(m); N]
    }

    #[inline(always)]
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
        fill(
            #[inline(always)]
            |i| V::zip(m, a[i], b[i], f),
        )
    }
}

macro_rules! tuple_value {
    ($($name:ident . $index:tt),+) => {
        impl<M: Machine, $($name: Value<M>),+> Value<M> for ($($name,)+) {
            const SCHEMA: &'static Schema = &Schema::Struct {
                name: "Tuple",
                fields: &[$(super::Field {
                    name: concat!("_", stringify!($index)),
                    offset: 0,
                    schema: $name::SCHEMA,
                }),+],
                size: 0,
            };

            #[inline(always)]
            fn zero(m: &M) -> Self {
                ($($name::zero(m),)+)
            }

            #[inline(always)]
            fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
                ($($name::zip(m, a.$index, b.$index, f),)+)
            }
        }
    };
}

tuple_value!(A.0);
tuple_value!(A.0, B.1);
tuple_value!(A.0, B.1, C.2);
tuple_value!(A.0, B.1, C.2, D.3);
tuple_value!(A.0, B.1, C.2, D.3, E.4);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7);
// Arguments of kernels that others call; a type of kernels has eight at most.
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8, N.9);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8, N.9, O.10);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8, N.9, O.10, P.11);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8, N.9, O.10, P.11, Q.12);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8, N.9, O.10, P.11, Q.12, S.13);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8, N.9, O.10, P.11, Q.12, S.13, T.14);
tuple_value!(A.0, B.1, C.2, D.3, E.4, G.5, H.6, J.7, L.8, N.9, O.10, P.11, Q.12, S.13, T.14, V.15);
