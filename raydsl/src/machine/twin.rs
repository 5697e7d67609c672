//! Type inference from twins: the host type of a value on a machine.
//!
//! `<T as Type>::On<M>` maps a type to its twin, and rustc cannot invert it: the type parameters of
//! a generic kernel are inferred from its arguments through [`Inferred`].

use glam::{
    Affine3, BVec2, BVec3, BVec4, IVec2, IVec3, IVec4, Mat3, Mat4, UVec2, UVec3, UVec4, Vec2, Vec3,
    Vec4,
};

use super::matrix::{A3, M3, M4};
use super::{B, F, I, Machine, Type, U, Usize, Value, Var, X2, X3, X4};

/// An argument with a known host type.
#[diagnostic::on_unimplemented(
    message = "the type parameters of this kernel cannot be inferred from its arguments",
    label = "of an unknown type",
    note = "name them, as in `f::<L>(light)`"
)]
pub trait Inferred<M: Machine> {
    /// The host type.
    type Host: Type;
    /// Returns the value on the machine.
    fn give(self, m: &M) -> <Self::Host as Type>::On<M>;
}

/// A value on a machine that is the twin of a host type: `<Host as Type>::On<M>` is `Self`.
pub trait Twin<M: Machine>: Value<M> + Inferred<M> {
    /// Converts the twin of the host type to `Self`, the same value.
    fn from_host(v: <Self::Host as Type>::On<M>) -> Self;
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Twin<M>> Inferred<M> for &Var<V> {
    type Host = V::Host;

    #[inline(always)]
    fn give(self, m: &M) -> <V::Host as Type>::On<M> {
        self.get(m).give(m)
    }
}

macro_rules! inferred_host {
    ($($host:ty),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Inferred<M> for $host {
                type Host = $host;

                #[inline(always)]
                fn give(self, m: &M) -> <$host as Type>::On<M> {
                    <$host as Type>::splat(m, self)
                }
            }
        )+
    };
}

inferred_host!(i32, u32, usize, bool);

macro_rules! twin {
    ($($host:ty => $twin:ty),+ $(,)?) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Inferred<M> for $twin {
                type Host = $host;

                #[inline(always)]
                fn give(self, _: &M) -> Self {
                    self
                }
            }

            impl<M: Machine> Twin<M> for $twin {
                #[inline(always)]
                fn from_host(v: Self) -> Self {
                    v
                }
            }
        )+
    };
}

twin!(
    f32 => F<M>, i32 => I<M>, u32 => U<M>, usize => Usize<M>, bool => B<M>,
    Vec2 => X2<F<M>>, Vec3 => X3<F<M>>, Vec4 => X4<F<M>>,
    IVec2 => X2<I<M>>, IVec3 => X3<I<M>>, IVec4 => X4<I<M>>,
    UVec2 => X2<U<M>>, UVec3 => X3<U<M>>, UVec4 => X4<U<M>>,
    BVec2 => X2<B<M>>, BVec3 => X3<B<M>>, BVec4 => X4<B<M>>,
    Mat3 => M3<M>, Mat4 => M4<M>, Affine3 => A3<M>,
);

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Inferred<M>, const N: usize> Inferred<M> for [V; N] {
    type Host = [V::Host; N];

    #[inline(always)]
    fn give(self, m: &M) -> <Self::Host as Type>::On<M> {
        self.map(|v| v.give(m))
    }
}

impl<M: Machine, V: Twin<M>, const N: usize> Twin<M> for [V; N] {
    #[inline(always)]
    fn from_host(v: <Self::Host as Type>::On<M>) -> Self {
        v.map(V::from_host)
    }
}

macro_rules! twin_tuple {
    ($($name:ident . $index:tt),+) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, $($name: Inferred<M>),+> Inferred<M> for ($($name,)+) {
            type Host = ($($name::Host,)+);

            #[inline(always)]
            fn give(self, m: &M) -> <Self::Host as Type>::On<M> {
                ($(self.$index.give(m),)+)
            }
        }

        impl<M: Machine, $($name: Twin<M>),+> Twin<M> for ($($name,)+) {
            #[inline(always)]
            fn from_host(v: <Self::Host as Type>::On<M>) -> Self {
                ($($name::from_host(v.$index),)+)
            }
        }
    };
}

twin_tuple!(A.0);
twin_tuple!(A.0, C.1);
twin_tuple!(A.0, C.1, D.2);
twin_tuple!(A.0, C.1, D.2, E.3);
