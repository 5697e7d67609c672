//! Texture lookups in kernels: [`tex1()`], [`tex2()`], [`tex3()`] and their forms with a level of
//! detail.

#![allow(non_camel_case_types, reason = "they have the names of functions")]

use glam::{Vec2, Vec3};

use super::on::{Lookup, LookupAtLevel};
use super::sample;
use super::texel::Texel;
use super::texture::{AsTextureRef, TextureRef};
use crate::machine::{Coerce, F, Machine, Type, X2, X3};

macro_rules! functions {
    ($(
        $n:literal $at:ident: $coordinate:ty, $twin:ty, $components:expr;
        $(#[$doc:meta])* $tex:ident
        $(#[$level_doc:meta])* $tex_level:ident
    )+) => {
        $(
            $(#[$doc])*
            #[inline]
            pub fn $tex<X: AsTextureRef<$n> + ?Sized>(
                texture: &X,
                $at: $coordinate,
            ) -> <X::Texel as Texel>::Value {
                sample::$tex(&texture.as_texture_ref().texels, $at)
            }

            #[doc = concat!("The lifted form of [`", stringify!($tex), "()`].")]
            #[doc(hidden)]
            pub enum $tex {}

            impl $tex {
                #[doc(hidden)]
                #[inline(always)]
                pub fn on<M: Machine, T: Texel>(
                    m: &M,
                    texture: TextureRef<'_, T, $n>,
                    $at: impl Coerce<M, $twin>,
                ) -> <T::Value as Type>::On<M> {
                    m.perform(&Lookup(&texture.texels), $components($at.coerce(m)))
                }
            }

            $(#[$level_doc])*
            #[inline]
            pub fn $tex_level<X: AsTextureRef<$n> + ?Sized>(
                texture: &X,
                $at: $coordinate,
                level: f32,
            ) -> <X::Texel as Texel>::Value {
                sample::$tex_level(&texture.as_texture_ref().texels, $at, level)
            }

            #[doc = concat!("The lifted form of [`", stringify!($tex_level), "()`].")]
            #[doc(hidden)]
            pub enum $tex_level {}

            impl $tex_level {
                #[doc(hidden)]
                #[inline(always)]
                pub fn on<M: Machine, T: Texel>(
                    m: &M,
                    texture: TextureRef<'_, T, $n>,
                    $at: impl Coerce<M, $twin>,
                    level: impl Coerce<M, F<M>>,
                ) -> <T::Value as Type>::On<M> {
                    let level = level.coerce(m);
                    m.perform(&LookupAtLevel(&texture.texels), ($components($at.coerce(m)), level))
                }
            }
        )+
    };
}

functions! {
    1 u: f32, F<M>, |u: F<M>| [u];
    /// Returns the value of a 1-D texture at `u`; with levels, that of level 0. See [`tex2()`].
    tex1
    /// Returns the value of a 1-D texture at `u` and a level of detail. See [`tex2_level()`].
    tex1_level

    2 uv: Vec2, X2<F<M>>, |uv: X2<F<M>>| [uv.x, uv.y];
    /// Returns the value of a 2-D texture at `uv`; with levels, that of level 0.
    ///
    /// The texture covers `[0, 1)` along each axis, and texel `i` of `n` has its centre at
    /// `(i + 0.5) / n`. `u` runs along a row and `v` from row 0 on. The texture's
    /// [`TextureConfig`](super::TextureConfig) determines values outside, and between the centres.
    ///
    /// The position between two texels is at most `2^-20 n` texels off, for `u` within `[-1, 2]`;
    /// an `f32` is no more precise. From `2^23` on a coordinate is whole: its fraction is 0. Where
    /// the texture repeats, NaN and infinite coordinates count as 0; where it is clamped or has a
    /// border, an infinite one lies beyond that end, and a NaN before the beginning. No coordinate
    /// reads outside of the texels.
    tex2
    /// Returns the value of a 2-D texture at `uv` and a level of detail: 0 is the original texture,
    /// 1 half as large, and so on.
    ///
    /// The texture's [`LevelFilter`](super::LevelFilter) applies between two levels. A level below
    /// 0 and NaN count as 0, and one beyond the last as the last one; a texture without levels has
    /// level 0 alone. See [`Texture::with_levels`](super::Texture::with_levels).
    tex2_level

    3 uvw: Vec3, X3<F<M>>, |uvw: X3<F<M>>| [uvw.x, uvw.y, uvw.z];
    /// Returns the value of a 3-D texture at `uvw`; with levels, that of level 0. See [`tex2()`].
    tex3
    /// Returns the value of a 3-D texture at `uvw` and a level of detail. See [`tex2_level()`].
    tex3_level
}
