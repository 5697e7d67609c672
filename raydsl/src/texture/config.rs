//! Texture sampling settings.

use glam::Vec4;

pub use crate::machine::wgsl::Address;
use crate::machine::{Leaves, Machine, Schema, Value};

/// Filter between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// Nearest texel: the one that contains the coordinate.
    Nearest,
    /// Linear interpolation between the centres of neighbours: 2 texels an axis.
    #[default]
    Linear,
    /// Uniform cubic B-spline: 4 texels an axis. It is twice continuously differentiable and stays
    /// between the least and the largest texel, but smooths: it does not pass through the texels.
    /// [`Texture::interpolating`](super::Texture::interpolating) makes a texture whose spline does.
    BSpline,
    /// Catmull-Rom (cardinal) spline: 4 texels an axis. It passes through the texels and may
    /// overshoot between them.
    CatmullRom,
}

/// Colour space of texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// Linear: texels are stored as their values.
    #[default]
    Linear,
    /// Encoded as in IEC 61966-2-1. Texels are decoded before filtering. The second of two channels
    /// and the fourth of four is opacity, which is never encoded.
    Srgb,
}

/// Filter between levels of detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LevelFilter {
    /// Nearest level; of two equally near ones the coarser.
    #[default]
    Nearest,
    /// Both levels, blended: with [`Filter::Linear`] this is trilinear filtering.
    Linear,
}

/// Implementation of filtering on a GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filtering {
    /// The library's code, on texels in a buffer: the values are those of the CPU, within WGSL's
    /// rounding.
    #[default]
    Exact,
    /// The device's own sampler, where possible: fast, with as few as 8 bits of a coordinate
    /// between two texels, so that a value may be off by 2^-8 of the difference of its neighbours,
    /// and that of a texel of 8 bits by 2^-8 besides. `compare` measures the difference, and knows
    /// these bounds. The result for NaN and infinite coordinates depends on the device.
    ///
    /// Possible where the filter is [`Filter::Linear`], no axis has [`Address::Border`], texels are
    /// one, two or four [`Unorm8`](crate::math::Unorm8) or [`F16`](crate::math::F16) (in sRGB: four
    /// `Unorm8`), an image has at most 8192 texels along an axis and a volume 2048, and the kernel
    /// has no more than 16 such textures. Others are read as with `Exact`, and so are all on the
    /// CPU.
    Device,
}

macro_rules! host_value {
    ($($t:ty),+) => {
        $(
            /// Host value: it is known while a kernel is recorded.
            impl<M: Machine> Value<M> for $t {
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

host_value!(Filter, Address, ColorSpace, LevelFilter, Filtering);

/// Texture sampling settings; the default is [`Filter::Linear`], [`Address::Wrap`] along every
/// axis, [`ColorSpace::Linear`], [`LevelFilter::Nearest`], [`Filtering::Exact`] and a border of
/// zeroes.
///
/// ```
/// use raydsl::texture::{Address, ColorSpace, Filter, TextureConfig};
///
/// let photo = TextureConfig::new().color_space(ColorSpace::Srgb).address(Address::Clamp);
/// assert_eq!(photo.filter, Filter::Linear);
/// assert_eq!(photo.address, [Address::Clamp; 3]);
/// ```
///
/// All settings but the border's colour select the recorded code; the colour is a number of the
/// uniform block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureConfig {
    /// Filter between texels.
    pub filter: Filter,
    /// Address mode of each axis; a texture has as many axes as dimensions.
    pub address: [Address; 3],
    /// Colour of [`Address::Border`]: as many of the numbers as the texture has channels. They are
    /// linear, whatever the colour space of the texels.
    pub border: Vec4,
    /// Colour space of texels.
    pub color_space: ColorSpace,
    /// Filter between levels of detail.
    pub level_filter: LevelFilter,
    /// Implementation of filtering on a GPU.
    pub filtering: Filtering,
}

impl TextureConfig {
    /// Returns the default settings.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the filter.
    #[must_use]
    pub fn filter(self, filter: Filter) -> Self {
        Self { filter, ..self }
    }

    /// Sets the address mode along every axis.
    #[must_use]
    pub fn address(self, address: Address) -> Self {
        Self { address: [address; 3], ..self }
    }

    /// Sets the address modes along the first axes; the others stay.
    #[must_use]
    pub fn addresses<const D: usize>(self, addresses: [Address; D]) -> Self {
        let mut address = self.address;
        for (old, new) in address.iter_mut().zip(addresses) {
            *old = new;
        }
        Self { address, ..self }
    }

    /// Sets [`Address::Border`] along every axis, with this colour.
    #[must_use]
    pub fn border(self, color: Vec4) -> Self {
        Self { border: color, ..self.address(Address::Border) }
    }

    /// Sets the colour space of texels.
    #[must_use]
    pub fn color_space(self, color_space: ColorSpace) -> Self {
        Self { color_space, ..self }
    }

    /// Sets the implementation of filtering on a GPU.
    #[must_use]
    pub fn filtering(self, filtering: Filtering) -> Self {
        Self { filtering, ..self }
    }

    /// Sets the filter between levels of detail.
    #[must_use]
    pub fn level_filter(self, level_filter: LevelFilter) -> Self {
        Self { level_filter, ..self }
    }
}
