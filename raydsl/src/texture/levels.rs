//! Levels of detail, made by the box filter.

use std::borrow::Cow;

use super::error::TextureError;
use super::texel::{Texel, TexelValue};
use super::texture::{Texture, count, within_limit};

/// A grid of values with up to four channels.
pub(super) struct Grid {
    pub(super) values: Vec<[f64; 4]>,
    pub(super) size: [usize; 3],
}

impl Grid {
    /// The decoded texels of level 0.
    pub(super) fn of<T: Texel, const D: usize>(
        texture: &Texture<'_, T, D>,
    ) -> Result<Self, TextureError> {
        let size = texture.size();
        let size = core::array::from_fn(|i| size.get(i).map_or(1, |n| *n as usize));
        let mut values = room(size.iter().product())?;
        let base = &texture.texels()[..size.iter().product()];
        let space = texture.config().color_space;
        values.extend(base.iter().map(|t| t.decode(space).to_channels().map(f64::from)));
        Ok(Self { values, size })
    }

    /// The places of texels that follow each other along an axis: how far apart they are, and the
    /// first of each line.
    pub(super) fn lines(&self, axis: usize) -> (usize, impl Iterator<Item = usize> + use<>) {
        let step: usize = self.size[..axis].iter().product();
        let n = self.size[axis];
        let count = self.values.len() / n;
        (step, (0..count).map(move |line| line / step * step * n + line % step))
    }

    /// Half as many texels along an axis, rounded down. Each is the mean over its share of the
    /// axis, so the mean of all stays, odd sizes or not.
    fn halved(&self, axis: usize) -> Result<Self, TextureError> {
        let n = self.size[axis];
        let mut size = self.size;
        size[axis] = (n / 2).max(1);
        let mut half = Self { values: room(size.iter().product())?, size };
        half.values.resize(size.iter().product(), [0.0; 4]);
        let ((step, sources), (_, targets)) = (self.lines(axis), half.lines(axis));
        for (source, target) in sources.zip(targets) {
            for i in 0..size[axis] {
                half.values[target + i * step] = self.mean(source, step, n, size[axis], i);
            }
        }
        Ok(half)
    }

    /// The mean over part `i` of `m` of a line of `n` texels.
    fn mean(&self, first: usize, step: usize, n: usize, m: usize, i: usize) -> [f64; 4] {
        // In units of 1/m of a texel, which are whole.
        let (start, end) = (i * n, (i + 1) * n);
        let mut sum = [0.0; 4];
        for j in start / m..end.div_ceil(m) {
            let covered = end.min((j + 1) * m) - start.max(j * m);
            let share = covered as f64 / n as f64;
            for (sum, v) in sum.iter_mut().zip(self.values[first + j * step]) {
                *sum += share * v;
            }
        }
        sum
    }

    /// The next level.
    fn next(&self) -> Result<Self, TextureError> {
        self.halved(0)?.halved(1)?.halved(2)
    }
}

/// An empty list with room for so many values.
pub(super) fn room<T>(count: usize) -> Result<Vec<T>, TextureError> {
    let bytes = (count as u64).saturating_mul(size_of::<T>() as u64);
    let mut list = Vec::new();
    list.try_reserve_exact(count).map_err(|_| TextureError::OutOfMemory { bytes })?;
    Ok(list)
}

/// A texel with these channels.
pub(super) fn value<V: TexelValue>(channels: [f64; 4]) -> V {
    V::from_channels(channels.map(|v| v as f32))
}

impl<T: Texel, const D: usize> Texture<'_, T, D> {
    /// The texture with levels of detail down to a single texel, each half as large along every
    /// axis as the one before, rounded down. Their texels are copied: levels lie behind level 0.
    ///
    /// A texel of a level is the mean over its share of the level before (the box filter), computed
    /// in linear space and `f64`, and encoded as texels of its type are.
    ///
    /// # Errors
    ///
    /// If all levels have more than [`MAX_TEXELS`](super::MAX_TEXELS) texels, or there is no memory
    /// for them; while they are made, a texel takes 32 bytes more.
    pub fn with_levels(&self) -> Result<Texture<'static, T, D>, TextureError> {
        let levels = self.size().into_iter().fold(1, u32::max).ilog2() + 1;
        let sizes = (0..levels).map(|l| self.size().map(|n| (n >> l).max(1)));
        let total = within_limit(sizes.map(|size| count(&size)).sum())?;
        let mut texels = room(total as usize)?;
        let mut grid = Grid::of(self)?;
        texels.extend_from_slice(&self.texels()[..grid.values.len()]);
        for _ in 1..levels {
            grid = grid.next()?;
            let space = self.config().color_space;
            texels.extend(grid.values.iter().map(|v| T::encode(value(*v), space)));
        }
        Ok(Texture::with_parts(Cow::Owned(texels), self.size(), levels, *self.config()))
    }
}
