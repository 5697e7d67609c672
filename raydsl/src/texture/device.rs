//! Textures read by device samplers.

use super::config::{Filter, Filtering};
use super::texel::Texel;
use super::view::Texels;
use crate::machine::wgsl::{TexelFormat, TextureLayout};
use crate::machine::{F, Floats, Machine, Method, Type, Value, name};

/// Maximum texels along an axis of an image, and of a volume, that WebGPU guarantees.
const MAX_IMAGE: u32 = 8192;
const MAX_VOLUME: u32 = 2048;
/// Resolution of a coordinate between two texels: at least 8 bits.
const WEIGHT: f32 = 1.0 / 256.0;

impl<T: Texel> Texels<'_, T> {
    /// Returns the sampler format of the texels, if a device is to sample them and can.
    fn format(&self) -> Option<TexelFormat> {
        let config = &self.config;
        if config.filtering == Filtering::Exact {
            return None;
        }
        let is_linear = config.filter == Filter::Linear;
        let longest = if self.is_volume() { MAX_VOLUME } else { MAX_IMAGE };
        let is_small = self.size.iter().all(|&n| n <= longest);
        let is_fit = is_linear && is_small && !self.has_border() && !self.all.is_empty();
        is_fit.then(|| T::format(config.color_space)).flatten()
    }

    /// Returns whether the texels are a volume. Others are images: a row of texels is one of height
    /// 1.
    fn is_volume(&self) -> bool {
        self.size[2] > 1
    }

    /// Returns the sampler layout of the texels, if a device is to sample them and can.
    pub(crate) fn layout(&self) -> Option<TextureLayout> {
        Some(TextureLayout {
            is_volume: self.is_volume(),
            size: self.size,
            levels: self.levels,
            format: self.format()?,
            stride: size_of::<T>().next_multiple_of(4) as u32,
            address: self.config.address,
            blends_levels: self.blends_levels(),
        })
    }

    /// Returns a weight of the host unchanged.
    #[inline(always)]
    pub(super) fn near(&self, weight: f32) -> f32 {
        weight
    }

    /// Widens a value read from the texture by a sampler's error.
    #[inline(always)]
    pub(super) fn as_read<M: Machine>(
        &self,
        m: &M,
        v: <T::Value as Type>::On<M>,
    ) -> <T::Value as Type>::On<M> {
        // Every float may be off by this absolute and relative error.
        let (absolute, relative) = match self.format() {
            None => return v,
            // Halves are rounded once more.
            Some(TexelFormat::R16Float | TexelFormat::Rg16Float | TexelFormat::Rgba16Float) => {
                (0.0, 1.0 / 2048.0)
            }
            Some(_) => (WEIGHT, 0.0),
        };
        Value::zip(
            m,
            v,
            v,
            &mut Floats(
                #[inline(always)]
                |m: &M, a, _| m.off_by(a, absolute, relative),
            ),
        )
    }
}

/// Widens a weight by a sampler's error.
#[diagnostic::do_not_recommend]
impl<M: Machine, T: Texel> Method<{ name("near") }, M, (F<M>,)> for Texels<'_, T> {
    type Output = F<M>;

    #[inline(always)]
    fn call(self, m: &M, (weight,): (F<M>,)) -> F<M> {
        match self.format() {
            None => weight,
            Some(_) => F(m.off_by(weight.0, WEIGHT, 0.0)),
        }
    }
}
