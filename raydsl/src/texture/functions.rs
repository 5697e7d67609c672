//! Texture lookups in kernels: [`tex1()`], [`tex2()`], [`tex3()`], their forms with a level of
//! detail, and single texels.

#![allow(non_camel_case_types, reason = "they have the names of functions")]

use glam::{IVec2, IVec3, UVec2, UVec3, Vec2, Vec3};

use super::on::{Fetch, Lookup, LookupAtLevel};
use super::sample;
use super::texel::Texel;
use super::texture::{AsTextureRef, TextureRef};
use crate::machine::{Coerce, F, I, Machine, Type, U, X2, X3};

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

/// Functions of texels by their places.
macro_rules! texels {
    ($(
        $n:literal $at:ty, $twin:ty, $components:expr; $count:ty, $count_twin:ty;
        $(#[$doc:meta])* $fetch:ident by $fetch_kernel:ident
        $(#[$texels_doc:meta])* $texels:ident by $texels_kernel:ident
    )+) => {
        $(
            $(#[$doc])*
            #[inline]
            pub fn $fetch<X: AsTextureRef<$n> + ?Sized>(
                texture: &X,
                at: $at,
                level: u32,
            ) -> <X::Texel as Texel>::Value {
                sample::$fetch_kernel(&texture.as_texture_ref().texels, at, level)
            }

            #[doc = concat!("The lifted form of [`", stringify!($fetch), "()`].")]
            #[doc(hidden)]
            pub enum $fetch {}

            impl $fetch {
                #[doc(hidden)]
                #[inline(always)]
                pub fn on<M: Machine, T: Texel>(
                    m: &M,
                    texture: TextureRef<'_, T, $n>,
                    at: impl Coerce<M, $twin>,
                    level: impl Coerce<M, U<M>>,
                ) -> <T::Value as Type>::On<M> {
                    let level = level.coerce(m);
                    m.perform(&Fetch(&texture.texels), ($components(at.coerce(m)), level))
                }
            }

            $(#[$texels_doc])*
            #[inline]
            pub fn $texels<X: AsTextureRef<$n> + ?Sized>(texture: &X, level: u32) -> $count {
                sample::$texels_kernel(&texture.as_texture_ref().texels, level)
            }

            #[doc = concat!("The lifted form of [`", stringify!($texels), "()`].")]
            #[doc(hidden)]
            pub enum $texels {}

            impl $texels {
                #[doc(hidden)]
                #[inline(always)]
                pub fn on<M: Machine, T: Texel>(
                    m: &M,
                    texture: TextureRef<'_, T, $n>,
                    level: impl Coerce<M, U<M>>,
                ) -> $count_twin {
                    sample::$texels_kernel::on(m, texture.texels, level)
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

texels! {
    1 i32, I<M>, |i: I<M>| [i]; u32, U<M>;
    /// Returns texel `at` of a level of a 1-D texture. See [`tex2_fetch()`].
    tex1_fetch by fetch1
    /// Returns the number of texels of a level of a 1-D texture. See [`tex2_texels()`].
    tex1_texels by texels1

    2 IVec2, X2<I<M>>, |at: X2<I<M>>| [at.x, at.y]; UVec2, X2<U<M>>;
    /// Returns the texel in column `at.x` and row `at.y` of a level of a 2-D texture: level 0 is the
    /// original texture.
    ///
    /// It is decoded and not filtered. Any place has a value: outside of the texture its address
    /// modes apply, so that `-1` is the last texel where it repeats, the first where it is clamped or
    /// mirrored, and else the border. A level beyond the last counts as the last one.
    ///
    /// Every variant reads the same texel. In WGSL it is read from a buffer, also with
    /// [`Filtering::Device`](super::Filtering::Device): a device that samples a texture and fetches
    /// its texels has them twice.
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let texels = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
    /// let heights = Texture2::new(&texels, [3, 2], TextureConfig::new())?;
    /// let slope = kernel!(|at: IVec2| {
    ///     tex2_fetch(&heights, at + ivec2(1, 0), 0) - tex2_fetch(&heights, at - ivec2(1, 0), 0)
    /// });
    /// assert_eq!(slope.call((ivec2(1, 0),)), 3.0);
    /// // Texel -1 of a row is its last one.
    /// assert_eq!(slope.call((ivec2(0, 1),)), -16.0);
    /// # Ok::<(), raydsl::texture::TextureError>(())
    /// ```
    tex2_fetch by fetch2
    /// Returns the number of texels along each axis of a level of a 2-D texture: a width and a
    /// height. A level beyond the last counts as the last one.
    ///
    /// On the host [`Texture::size`](super::Texture::size) is that of level 0. In WGSL they are
    /// numbers of the uniform block: a texture of another size compiles nothing.
    tex2_texels by texels2

    3 IVec3, X3<I<M>>, |at: X3<I<M>>| [at.x, at.y, at.z]; UVec3, X3<U<M>>;
    /// Returns texel `at` of a level of a 3-D texture. See [`tex2_fetch()`].
    tex3_fetch by fetch3
    /// Returns the number of texels along each axis of a level of a 3-D texture. See
    /// [`tex2_texels()`].
    tex3_texels by texels3
}
