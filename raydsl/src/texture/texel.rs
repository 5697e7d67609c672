//! Texels and their values.

use glam::{Vec2, Vec3, Vec4};

use super::color::{linear_to_srgb, srgb_to_linear};
use super::config::ColorSpace;
use crate::kernel;
use crate::machine::wgsl::TexelFormat;
use crate::machine::{F, LaneMachine, Machine, Method, Type, U, X2, X3, X4, fill, name, op};
use crate::math::{F16, Unorm8, Unorm8On, Unorm16};

/// Blending of values in filters, as `a + w (b - a)`, so that a constant texture returns the same
/// bits.
#[kernel]
pub trait Blend {
    /// Returns `self + (to - self) * w`.
    fn blend(self, to: Self, w: f32) -> Self;

    /// Returns `self`, the second of four neighbours, plus the weighted differences to the others.
    fn blend4(self, first: Self, third: Self, fourth: Self, w1: f32, w3: f32, w4: f32) -> Self;
}

macro_rules! blend {
    ($($t:ident),+) => {
        $(
            #[kernel]
            impl Blend for $t {
                fn blend(self, to: Self, w: f32) -> Self {
                    self + (to - self) * w
                }

                fn blend4(
                    self,
                    first: Self,
                    third: Self,
                    fourth: Self,
                    w1: f32,
                    w3: f32,
                    w4: f32,
                ) -> Self {
                    self + ((first - self) * w1 + (third - self) * w3 + (fourth - self) * w4)
                }
            }
        )+
    };
}

blend!(f32, Vec2, Vec3, Vec4);

/// Value of a texture: `f32`, `Vec2`, `Vec3` or `Vec4`, by the number of channels.
pub trait TexelValue: Blend + Texel<Value = Self> {
    /// Number of channels.
    const CHANNELS: usize;

    /// Creates the value from the first of these channels.
    fn from_channels(channels: [f32; 4]) -> Self;

    /// Returns the channels; missing ones are 0.
    fn to_channels(self) -> [f32; 4];

    /// Lifted form of [`from_channels`](Self::from_channels).
    #[doc(hidden)]
    fn from_channels_on<M: Machine>(m: &M, channels: &[F<M>]) -> Self::On<M>;
}

macro_rules! value {
    ($($t:ident $n:literal $twin:ident ($($c:ident $i:literal)+);)+) => {
        $(
            impl TexelValue for $t {
                const CHANNELS: usize = $n;

                #[inline(always)]
                fn from_channels(channels: [f32; 4]) -> Self {
                    Self::new($(channels[$i]),+)
                }

                #[inline(always)]
                fn to_channels(self) -> [f32; 4] {
                    let mut all = [0.0; 4];
                    $(all[$i] = self.$c;)+
                    all
                }

                #[inline(always)]
                fn from_channels_on<M: Machine>(_: &M, channels: &[F<M>]) -> Self::On<M> {
                    $twin { $($c: channels[$i]),+ }
                }
            }
        )+
    };
}

value! {
    Vec2 2 X2 (x 0 y 1);
    Vec3 3 X3 (x 0 y 1 z 2);
    Vec4 4 X4 (x 0 y 1 z 2 w 3);
}

impl TexelValue for f32 {
    const CHANNELS: usize = 1;

    #[inline(always)]
    fn from_channels(channels: [f32; 4]) -> Self {
        channels[0]
    }

    #[inline(always)]
    fn to_channels(self) -> [f32; 4] {
        [self, 0.0, 0.0, 0.0]
    }

    #[inline(always)]
    fn from_channels_on<M: Machine>(_: &M, channels: &[F<M>]) -> F<M> {
        channels[0]
    }
}

/// Texel: one to four channels of [`Unorm8`], [`Unorm16`], [`F16`] or `f32`.
///
/// Arrays of one to four such numbers, the numbers themselves, and glam's vectors are texels. A
/// texel is stored as the application has it; a device pads it to whole words of 4 bytes.
pub trait Texel: Type {
    /// Value of a texel: a number for each channel.
    type Value: TexelValue;

    /// Decodes the texel.
    fn decode(self, space: ColorSpace) -> Self::Value;

    /// Encodes a value as the nearest texel.
    fn encode(value: Self::Value, space: ColorSpace) -> Self;

    /// Returns the sampler format of such texels, if every device can filter it.
    #[doc(hidden)]
    fn format(_space: ColorSpace) -> Option<TexelFormat> {
        None
    }

    /// Gathers the texel that `f` returns for each lane.
    #[doc(hidden)]
    #[inline(always)]
    fn gather<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> Self::On<M> {
        Self::from_lanes(m, f)
    }

    /// Lifted form of [`decode`](Self::decode).
    #[doc(hidden)]
    fn decode_on<M: Machine>(
        m: &M,
        this: Self::On<M>,
        space: ColorSpace,
    ) -> <Self::Value as Type>::On<M>;
}

/// Channel of a texel.
pub trait Channel: Type {
    /// Returns the channel's number.
    fn number(self) -> f32;
    /// Returns the channel nearest to `v`.
    fn nearest(v: f32) -> Self;
    /// Returns [`Texel::format`] of this many channels.
    #[doc(hidden)]
    fn format(_channels: usize, _space: ColorSpace) -> Option<TexelFormat> {
        None
    }
    /// Gathers arrays, as [`Texel::gather`].
    #[doc(hidden)]
    #[inline(always)]
    fn gather<M: LaneMachine, const N: usize>(
        m: &M,
        f: impl Fn(usize) -> [Self; N] + Copy,
    ) -> [Self::On<M>; N] {
        <[Self; N]>::from_lanes(m, f)
    }
    /// Lifted form of [`number`](Self::number).
    #[doc(hidden)]
    fn number_on<M: Machine>(m: &M, this: Self::On<M>) -> F<M>;
}

impl Channel for f32 {
    #[inline(always)]
    fn number(self) -> f32 {
        self
    }

    fn nearest(v: f32) -> Self {
        v
    }

    #[inline(always)]
    fn number_on<M: Machine>(_: &M, this: F<M>) -> F<M> {
        this
    }
}

macro_rules! small_channel {
    ($(
        $t:ident $(($($n:literal $space:ident $format:ident),+))? $({ $($own:item)+ })?;
    )+) => {
        $(
            impl Channel for $t {
                $($($own)+)?

                #[inline(always)]
                fn number(self) -> f32 {
                    self.to_f32()
                }

                fn nearest(v: f32) -> Self {
                    Self::new(v)
                }

                $(fn format(channels: usize, space: ColorSpace) -> Option<TexelFormat> {
                    match (channels, space) {
                        $(($n, ColorSpace::$space) => Some(TexelFormat::$format),)+
                        _ => None,
                    }
                })?

                #[inline(always)]
                fn number_on<M: Machine>(m: &M, this: Self::On<M>) -> F<M> {
                    Method::<{ name("to_f32") }, M, ()>::call(this, m, ())
                }
            }
        )+
    };
}

small_channel! {
    Unorm8 (
        1 Linear R8Unorm, 2 Linear Rg8Unorm, 4 Linear Rgba8Unorm, 4 Srgb Rgba8UnormSrgb
    ) {
        /// Gathers whole words, which are then split in all lanes at once.
        #[inline(always)]
        fn gather<M: LaneMachine, const N: usize>(
            m: &M,
            f: impl Fn(usize) -> [Self; N] + Copy,
        ) -> [Self::On<M>; N] {
            const { assert!(N <= 4, "a texel has up to four channels") };
            let words = m.u32_from_fn(
                #[inline(always)]
                |lane| {
                    let mut word = [0; 4];
                    for (byte, channel) in word.iter_mut().zip(f(lane)) {
                        *byte = channel.to_bits();
                    }
                    u32::from_le_bytes(word)
                },
            );
            fill(
                #[inline(always)]
                |i| {
                    let above = m.u32_binary(op::Shr, words, m.u32(8 * i as u32));
                    Unorm8On { bits: U(m.u32_binary(op::And, above, m.u32(0xff))) }
                },
            )
        }
    };
    Unorm16;
    F16 (1 Linear R16Float, 2 Linear Rg16Float, 4 Linear Rgba16Float);
}

/// Returns whether channel `i` of `n` is opacity.
const fn is_opacity(i: usize, n: usize) -> bool {
    n.is_multiple_of(2) && i + 1 == n
}

#[inline(always)]
fn decoded<C: Channel>(c: C, is_encoded: bool) -> f32 {
    let v = c.number();
    if is_encoded { srgb_to_linear(v) } else { v }
}

fn encoded<C: Channel>(v: f32, is_encoded: bool) -> C {
    C::nearest(if is_encoded { linear_to_srgb(v) } else { v })
}

#[inline(always)]
fn decoded_on<M: Machine, C: Channel>(m: &M, c: C::On<M>, is_encoded: bool) -> F<M> {
    let v = C::number_on(m, c);
    if is_encoded { srgb_to_linear::on(m, v) } else { v }
}

/// Returns whether each channel of a texel is encoded.
#[inline(always)]
fn encodings(space: ColorSpace, n: usize) -> [bool; 4] {
    core::array::from_fn(
        #[inline(always)]
        |i| space == ColorSpace::Srgb && !is_opacity(i, n),
    )
}

macro_rules! array_texel {
    ($($n:literal $v:ident ($($i:literal)+);)+) => {
        $(
            impl<C: Channel> Texel for [C; $n] {
                type Value = $v;

                #[inline(always)]
                fn decode(self, space: ColorSpace) -> $v {
                    let is = encodings(space, $n);
                    let mut all = [0.0; 4];
                    $(all[$i] = decoded(self[$i], is[$i]);)+
                    $v::from_channels(all)
                }

                fn encode(value: $v, space: ColorSpace) -> Self {
                    let (is, all) = (encodings(space, $n), value.to_channels());
                    [$(encoded(all[$i], is[$i])),+]
                }

                fn format(space: ColorSpace) -> Option<TexelFormat> {
                    C::format($n, space)
                }

                #[inline(always)]
                fn gather<M: LaneMachine>(
                    m: &M,
                    f: impl Fn(usize) -> Self + Copy,
                ) -> Self::On<M> {
                    C::gather(m, f)
                }

                #[inline(always)]
                fn decode_on<M: Machine>(
                    m: &M,
                    this: Self::On<M>,
                    space: ColorSpace,
                ) -> <$v as Type>::On<M> {
                    let is = encodings(space, $n);
                    let all = [$(decoded_on::<M, C>(m, this[$i], is[$i])),+];
                    $v::from_channels_on(m, &all)
                }
            }
        )+
    };
}

array_texel! {
    1 f32 (0);
    2 Vec2 (0 1);
    3 Vec3 (0 1 2);
    4 Vec4 (0 1 2 3);
}

macro_rules! single_texel {
    ($($t:ty),+) => {
        $(
            impl Texel for $t {
                type Value = f32;

                #[inline(always)]
                fn decode(self, space: ColorSpace) -> f32 {
                    [self].decode(space)
                }

                fn encode(value: f32, space: ColorSpace) -> Self {
                    <[Self; 1]>::encode(value, space)[0]
                }

                fn format(space: ColorSpace) -> Option<TexelFormat> {
                    <[Self; 1]>::format(space)
                }

                #[inline(always)]
                fn decode_on<M: Machine>(m: &M, this: Self::On<M>, space: ColorSpace) -> F<M> {
                    <[Self; 1]>::decode_on(m, [this], space)
                }
            }
        )+
    };
}

single_texel!(f32, Unorm8, Unorm16, F16);

macro_rules! vector_texel {
    ($($t:ident $n:literal ($($c:ident)+);)+) => {
        $(
            impl Texel for $t {
                type Value = $t;

                #[inline(always)]
                fn decode(self, space: ColorSpace) -> $t {
                    self.to_array().decode(space)
                }

                fn encode(value: $t, space: ColorSpace) -> Self {
                    <[f32; $n]>::encode(value, space).into()
                }

                #[inline(always)]
                fn decode_on<M: Machine>(
                    m: &M,
                    this: Self::On<M>,
                    space: ColorSpace,
                ) -> Self::On<M> {
                    <[f32; $n]>::decode_on(m, [$(this.$c),+], space)
                }
            }
        )+
    };
}

vector_texel! {
    Vec2 2 (x y);
    Vec3 3 (x y z);
    Vec4 4 (x y z w);
}
