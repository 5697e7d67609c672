//! How a texture is read.

use glam::Vec4;

pub use crate::machine::wgsl::Address;
use crate::machine::{Leaves, Machine, Schema, Value};

/// How a value between texels is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The texel that the coordinate lies in.
    Nearest,
    /// A straight line between the centres of neighbours: 2 texels an axis.
    #[default]
    Linear,
    /// The uniform cubic B-spline: 4 texels an axis. It is twice continuously differentiable and
    /// stays between the least and the largest texel, but smooths: it does not go through the
    /// texels. [`Texture::interpolating`](super::Texture::interpolating) makes a texture whose
    /// spline does.
    BSpline,
    /// The Catmull-Rom (cardinal) spline: 4 texels an axis. It goes through the texels and may
    /// overshoot between them.
    CatmullRom,
}

/// What the numbers of texels mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// What is stored is the value.
    #[default]
    Linear,
    /// Encoded as IEC 61966-2-1 says. Texels are decoded before they are filtered. The second of
    /// two channels and the fourth of four is opacity, which is never encoded.
    Srgb,
}

/// Which level of detail is read where a level is asked for that lies between two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LevelFilter {
    /// The nearer one; of two equally near ones the coarser.
    #[default]
    Nearest,
    /// Both, blended: with [`Filter::Linear`] this is trilinear filtering.
    Linear,
}

/// Who filters on a GPU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filtering {
    /// The library's code, on texels in a buffer: the values are those of the CPU, within what WGSL
    /// may round.
    #[default]
    Exact,
    /// The device's own sampler, where it can: fast, with as few as 8 bits of a coordinate between
    /// two texels, so that a value may be off by 2^-8 of the difference of its neighbours, and
    /// that of a texel of 8 bits by 2^-8 besides. `compare` shows by how much, and knows these
    /// bounds. What NaN and infinite coordinates give, the device decides.
    ///
    /// It can where the filter is [`Filter::Linear`], no axis has [`Address::Border`], texels are
    /// one, two or four [`Unorm8`](crate::math::Unorm8) or [`F16`](crate::math::F16) (in sRGB: four
    /// `Unorm8`), an image has at most 8192 texels along an axis and a volume 2048, and the kernel
    /// has no more than 16 such textures. Others are read as with `Exact`, and so are all on the
    /// CPU.
    Device,
}

macro_rules! host_value {
    ($($t:ty),+) => {
        $(
            /// A value of the host: it is known while a kernel is recorded.
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

/// How a texture is read; the default is [`Filter::Linear`], [`Address::Wrap`] along every axis,
/// [`ColorSpace::Linear`], [`LevelFilter::Nearest`], [`Filtering::Exact`] and a border of zeroes.
///
/// ```
/// use raydsl::texture::{Address, ColorSpace, Filter, TextureConfig};
///
/// let photo = TextureConfig::new().color_space(ColorSpace::Srgb).address(Address::Clamp);
/// assert_eq!(photo.filter, Filter::Linear);
/// assert_eq!(photo.address, [Address::Clamp; 3]);
/// ```
///
/// All but the border's colour decides which code is recorded; the colour is a number of the
/// uniform block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TextureConfig {
    /// How a value between texels is made.
    pub filter: Filter,
    /// What lies outside, for each axis; a texture has as many axes as dimensions.
    pub address: [Address; 3],
    /// What [`Address::Border`] shows: as many of the numbers as the texture has channels. They are
    /// linear, whatever the colour space of the texels is.
    pub border: Vec4,
    /// What the numbers of texels mean.
    pub color_space: ColorSpace,
    /// How levels of detail are blended.
    pub level_filter: LevelFilter,
    /// Who filters on a GPU.
    pub filtering: Filtering,
}

impl TextureConfig {
    /// The default.
    pub fn new() -> Self {
        Self::default()
    }

    /// With this filter.
    #[must_use]
    pub fn filter(self, filter: Filter) -> Self {
        Self { filter, ..self }
    }

    /// With this address mode along every axis.
    #[must_use]
    pub fn address(self, address: Address) -> Self {
        Self { address: [address; 3], ..self }
    }

    /// With these address modes along the first axes; the others stay.
    #[must_use]
    pub fn addresses<const D: usize>(self, addresses: [Address; D]) -> Self {
        let mut address = self.address;
        for (old, new) in address.iter_mut().zip(addresses) {
            *old = new;
        }
        Self { address, ..self }
    }

    /// With [`Address::Border`] along every axis, of this colour.
    #[must_use]
    pub fn border(self, color: Vec4) -> Self {
        Self { border: color, ..self.address(Address::Border) }
    }

    /// With texels in this colour space.
    #[must_use]
    pub fn color_space(self, color_space: ColorSpace) -> Self {
        Self { color_space, ..self }
    }

    /// Filtered on a GPU by this.
    #[must_use]
    pub fn filtering(self, filtering: Filtering) -> Self {
        Self { filtering, ..self }
    }

    /// With this way from one level of detail to the next.
    #[must_use]
    pub fn level_filter(self, level_filter: LevelFilter) -> Self {
        Self { level_filter, ..self }
    }
}
