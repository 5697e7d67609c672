//! Levels of detail (mipmaps), made by the box filter.

use std::borrow::Cow;

use super::error::TextureError;
use super::texel::{Texel, TexelValue};
use super::texture::{Texture, count, within_limit};

/// Values of one level: axis 0 is that of the channels, the others are the texture's.
pub(super) struct Grid {
    pub(super) values: Vec<f64>,
    pub(super) size: [usize; 4],
}

impl Grid {
    /// Decodes the texels of level 0.
    pub(super) fn of<T: Texel, const D: usize>(
        texture: &Texture<'_, T, D>,
    ) -> Result<Self, TextureError> {
        let channels = T::Value::CHANNELS;
        let mut size = [channels, 1, 1, 1];
        for (n, of_texture) in size[1..].iter_mut().zip(texture.size()) {
            *n = of_texture as usize;
        }
        let mut values = room(size.iter().product())?;
        let base = &texture.texels()[..size[1..].iter().product()];
        let space = texture.config().color_space;
        for texel in base {
            let all = texel.decode(space).to_channels();
            values.extend(all[..channels].iter().map(|v| f64::from(*v)));
        }
        Ok(Self { values, size })
    }

    /// Iterates over the values of texels.
    pub(super) fn texels<V: TexelValue>(&self) -> impl Iterator<Item = V> {
        self.values.chunks_exact(self.size[0]).map(|texel| {
            let mut channels = [0.0; 4];
            for (channel, v) in channels.iter_mut().zip(texel) {
                *channel = *v as f32;
            }
            V::from_channels(channels)
        })
    }

    /// Returns the stride of an axis, and iterates over the first index of each line along it.
    pub(super) fn lines(&self, axis: usize) -> (usize, impl Iterator<Item = usize> + use<>) {
        let step: usize = self.size[..axis].iter().product();
        let n = self.size[axis];
        let count = self.values.len() / n;
        (step, (0..count).map(move |line| line / step * step * n + line % step))
    }

    /// Halves the number of texels along an axis, rounded down. Each is the mean over its share of
    /// the axis, so the overall mean stays, odd sizes or not.
    fn halve(&mut self, axis: usize) {
        let n = self.size[axis];
        if n == 1 {
            return;
        }
        let m = n / 2;
        let step: usize = self.size[..axis].iter().product();
        let slabs = self.values.len() / (step * n);
        // In this order a mean is written no further than its first operand, so unread values are
        // intact.
        let mut target = 0;
        for slab in 0..slabs {
            for i in 0..m {
                for first in slab * step * n..slab * step * n + step {
                    self.values[target] = self.mean(first, step, n, m, i);
                    target += 1;
                }
            }
        }
        self.values.truncate(target);
        self.size[axis] = m;
    }

    /// Returns the mean over part `i` of `m` of a line of `n` texels.
    fn mean(&self, first: usize, step: usize, n: usize, m: usize, i: usize) -> f64 {
        // In units of 1/m of a texel, which are whole.
        let (start, end) = (i * n, (i + 1) * n);
        let mut sum = 0.0;
        for j in start / m..end.div_ceil(m) {
            let covered = end.min((j + 1) * m) - start.max(j * m);
            sum += covered as f64 / n as f64 * self.values[first + j * step];
        }
        sum
    }
}

/// Allocates an empty list with room for so many values.
pub(super) fn room<T>(count: usize) -> Result<Vec<T>, TextureError> {
    let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
    let mut list = Vec::new();
    list.try_reserve_exact(count).map_err(|_| TextureError::OutOfMemory { bytes })?;
    Ok(list)
}

impl<T: Texel, const D: usize> Texture<'_, T, D> {
    /// Creates the texture with levels of detail down to a single texel, each half as large along
    /// every axis as the one before, rounded down. The texels are copied: levels follow level 0.
    ///
    /// A texel of a level is the mean over its share of the level before (the box filter), computed
    /// in linear space and `f64`, and encoded as texels of its type are.
    ///
    /// # Errors
    ///
    /// If all levels have more than [`MAX_TEXELS`](super::MAX_TEXELS) texels, or there is no memory
    /// for them; while they are made, each channel of a texel of level 0 takes 8 bytes more.
    pub fn with_levels(&self) -> Result<Texture<'static, T, D>, TextureError> {
        let levels = self.size().into_iter().fold(1, u32::max).ilog2() + 1;
        let sizes = (0..levels).map(|l| self.size().map(|n| (n >> l).max(1)));
        let total = within_limit(sizes.map(|size| count(&size)).sum())?;
        let mut texels = room(total as usize)?;
        let mut grid = Grid::of(self)?;
        texels.extend_from_slice(&self.texels()[..count(&self.size()) as usize]);
        let space = self.config().color_space;
        for _ in 1..levels {
            for axis in 1..=D {
                grid.halve(axis);
            }
            texels.extend(grid.texels().map(|v| T::encode(v, space)));
        }
        Ok(Texture::with_parts(Cow::Owned(texels), self.size(), levels, *self.config()))
    }
}
