//! What a forwarded method calls where a kind lacks the method.

use glam::{Vec2, Vec3};

use super::{Hit, Ray, SurfacePoint};
use crate::machine::{Machine, Type};

macro_rules! lacking {
    ($(
        $name:ident $lifted:ident $has:ident
        ($($argument:ty),*; $($on:ident),*) -> $result:ty = $message:literal, $note:literal;
    )+) => {
        $(
            /// No type implements it: it makes the message. The method itself comes first.
            #[doc(hidden)]
            #[diagnostic::on_unimplemented(
                message = $message,
                label = "this kind has no such method",
                note = $note
            )]
            pub trait $has {}
        )+

        /// The methods that `#[primitive(..)] enum` forwards, for kinds that lack them.
        ///
        /// The source and the lifted code call a method by the path of the kind's type: there the
        /// kind's own comes before that of a trait. A kind without one is an error of the lifted
        /// code, by the bound here, and no second one of the source.
        #[doc(hidden)]
        pub trait Lacking: Sized {
            $(
                fn $name(&self, $(_: $argument),*) -> $result {
                    unreachable!("the lifted code is not compiled")
                }

                fn $lifted<M: Machine, T, $($on),*>(
                    _: &M,
                    _: T,
                    $(_: $on),*
                ) -> <$result as Type>::On<M>
                where
                    Self: $has,
                {
                    unreachable!("no type has the bound")
                }
            )+
        }
    };
}

lacking! {
    surface_point surface_point_on HasSurfacePoint (Ray, Hit; R, H) -> SurfacePoint =
        "the kind `{Self}` has no method `surface_point` for kernels",
        "write `fn surface_point(&self, ray: Ray, hit: Hit) -> SurfacePoint` in a `#[kernel] impl {Self}`, visible here";
    normal normal_on HasNormal (Ray, Hit; R, H) -> Vec3 =
        "the kind `{Self}` has no method `normal` for kernels",
        "write `fn normal(&self, ray: Ray, hit: Hit) -> Vec3` in a `#[kernel] impl {Self}`, visible here";
    uv uv_on HasUv (Ray, Hit; R, H) -> Vec2 =
        "the kind `{Self}` has no method `uv` for kernels",
        "write `fn uv(&self, ray: Ray, hit: Hit) -> Vec2` in a `#[kernel] impl {Self}`, visible here";
    area area_on HasArea (;) -> f32 =
        "the kind `{Self}` has no method `area` for kernels",
        "write `fn area(&self) -> f32` in a `#[kernel] impl {Self}`, visible here";
    sample sample_on HasSample (Vec2; U) -> SurfacePoint =
        "the kind `{Self}` has no method `sample` for kernels",
        "write `fn sample(&self, u: Vec2) -> SurfacePoint` in a `#[kernel] impl {Self}`, visible here";
}

impl<T> Lacking for T {}
