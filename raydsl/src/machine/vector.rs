//! The twins of glam's `Vec2`, `Vec3`, `Vec4`.

use super::{F, F32Binary, F32Unary, Leaves, Machine, Schema, Value};

macro_rules! vector {
    ($name:ident, $n:literal, $host:literal, $($c:ident $i:tt),+) => {
        #[doc = concat!("`", $host, "` on machine `M`.")]
        pub struct $name<M: Machine> {
            $(#[doc = concat!("Component ", stringify!($c), ".")] pub $c: F<M>,)+
        }

        impl<M: Machine> Clone for $name<M> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<M: Machine> Copy for $name<M> {}

        impl<M: Machine> Value<M> for $name<M> {
            const SCHEMA: &'static Schema = &Schema::Vector($n);

            #[inline(always)]
            fn zero(m: &M) -> Self {
                Self { $($c: F::zero(m)),+ }
            }

            #[inline(always)]
            fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
                Self { $($c: F::zip(m, a.$c, b.$c, f)),+ }
            }
        }

        impl<M: Machine> $name<M> {
            #[inline(always)]
            pub(crate) fn array(self) -> [M::F32; $n] {
                [$(self.$c.0),+]
            }

            #[inline(always)]
            pub(crate) fn from_array(a: [M::F32; $n]) -> Self {
                Self { $($c: F(a[$i])),+ }
            }

            #[inline(always)]
            pub(crate) fn splat(v: F<M>) -> Self {
                Self { $($c: v),+ }
            }

            #[inline(always)]
            pub(crate) fn binary(m: &M, op: F32Binary, a: Self, b: Self) -> Self {
                Self::from_array(m.vector_binary(op, a.array(), b.array()))
            }

            #[inline(always)]
            pub(crate) fn unary(m: &M, op: F32Unary, a: Self) -> Self {
                Self::from_array(m.vector_unary(op, a.array()))
            }
        }
    };
}

vector!(V2, 2, "Vec2", x 0, y 1);
vector!(V3, 3, "Vec3", x 0, y 1, z 2);
vector!(V4, 4, "Vec4", x 0, y 1, z 2, w 3);
