//! B-spline prefilter: coefficients of interpolating splines.
//!
//! At the centre of a texel the cubic B-spline is `(a + 4 b + c) / 6` of it and its neighbours. To
//! interpolate, a system with that row for each texel is solved along each axis in turn (Unser,
//! "Splines: a perfect fit for signal and image processing", 1999): by elimination in `f64`, with
//! the ends given by the address mode, so the result is exact but for its rounding.

use std::borrow::Cow;

use super::config::{Address, ColorSpace, Filter, TextureConfig};
use super::error::TextureError;
use super::levels::{Grid, room};
use super::texel::Texel;
use super::texture::Texture;

impl<T: Texel, const D: usize> Texture<'_, T, D> {
    /// Creates a texture with [`Filter::BSpline`] that passes through the texels of this one: an
    /// interpolating B-spline. It has coefficients of `f32`, linear whatever the colour space of
    /// the texels, and no levels.
    ///
    /// The spline may overshoot between texels, like every smooth curve through given points.
    ///
    /// # Errors
    ///
    /// If there is no memory for the coefficients; while they are made, each channel of a texel
    /// takes 8 bytes more, and each texel along an axis at most 24.
    pub fn interpolating(&self) -> Result<Texture<'static, T::Value, D>, TextureError> {
        let mut grid = Grid::of(self)?;
        let config = self.config();
        let border = config.border.to_array().map(f64::from);
        for (axis, address) in config.address.into_iter().take(D).enumerate() {
            grid.solve(1 + axis, address, border)?;
        }
        let mut texels = room(grid.values.len() / grid.size[0])?;
        texels.extend(grid.texels::<T::Value>());
        let (filter, color_space) = (Filter::BSpline, ColorSpace::Linear);
        let config = TextureConfig { filter, color_space, ..*config };
        Ok(Texture::with_parts(Cow::Owned(texels), self.size(), 1, config))
    }
}

impl Grid {
    /// Replaces the values of every line along an axis with coefficients.
    fn solve(
        &mut self,
        axis: usize,
        address: Address,
        border: [f64; 4],
    ) -> Result<(), TextureError> {
        let n = self.size[axis];
        let system = System::new(n, address)?;
        let mut line = zeroes(n)?;
        let (step, lines) = self.lines(axis);
        for first in lines {
            for (i, v) in line.iter_mut().enumerate() {
                *v = 6.0 * self.values[first + i * step];
            }
            system.solve(&mut line, border[first % self.size[0]]);
            for (i, v) in line.iter().enumerate() {
                self.values[first + i * step] = *v;
            }
        }
        Ok(())
    }
}

/// Linear system `c[i - 1] + 4 c[i] + c[i + 1] = line[i]` of an axis.
enum System {
    /// A single texel is its own neighbour.
    Single,
    /// The neighbour outside is the texel at the edge, or the other one of two.
    Inside(Tridiagonal),
    /// The neighbour outside is the border.
    Border(Tridiagonal),
    /// The last texel is the neighbour of the first: a correction of the system without those
    /// corners (the Sherman-Morrison formula).
    Cyclic { without_corners: Tridiagonal, correction: Vec<f64> },
}

/// Corner element that [`System::Cyclic`] corrects; any other number would do.
const CORNER: f64 = -4.0;

impl System {
    fn new(n: usize, address: Address) -> Result<Self, TextureError> {
        Ok(match address {
            Address::Border => Self::Border(Tridiagonal::new(n, 4.0, 4.0, 1.0)?),
            _ if n == 1 => Self::Single,
            Address::Clamp | Address::Mirror => Self::Inside(Tridiagonal::new(n, 5.0, 5.0, 1.0)?),
            Address::Wrap if n == 2 => Self::Inside(Tridiagonal::new(n, 4.0, 4.0, 2.0)?),
            Address::Wrap => {
                let (first, last) = (4.0 - CORNER, 4.0 - 1.0 / CORNER);
                let without_corners = Tridiagonal::new(n, first, last, 1.0)?;
                let mut correction = zeroes(n)?;
                (correction[0], correction[n - 1]) = (CORNER, 1.0);
                without_corners.solve(&mut correction);
                Self::Cyclic { without_corners, correction }
            }
        })
    }

    fn solve(&self, line: &mut [f64], border: f64) {
        let n = line.len();
        match self {
            Self::Single => line[0] /= 6.0,
            Self::Inside(system) => system.solve(line),
            Self::Border(system) => {
                line[0] -= border;
                line[n - 1] -= border;
                system.solve(line);
            }
            Self::Cyclic { without_corners, correction } => {
                without_corners.solve(line);
                let end = |v: &[f64]| v[0] + v[n - 1] / CORNER;
                let factor = end(line) / (1.0 + end(correction));
                for (v, c) in line.iter_mut().zip(correction) {
                    *v -= factor * c;
                }
            }
        }
    }
}

/// Tridiagonal system with 4 on the diagonal except at its ends, and `beside` next to it,
/// eliminated once for all lines (Thomas' algorithm). It is diagonally dominant, so there is no
/// need to pivot.
struct Tridiagonal {
    beside: f64,
    /// Diagonal after elimination.
    pivots: Vec<f64>,
}

impl Tridiagonal {
    fn new(n: usize, first: f64, last: f64, beside: f64) -> Result<Self, TextureError> {
        let mut pivots = zeroes(n)?;
        pivots[0] = first;
        for i in 1..n {
            let diagonal = if i + 1 == n { last } else { 4.0 };
            pivots[i] = diagonal - beside / pivots[i - 1] * beside;
        }
        Ok(Self { beside, pivots })
    }

    fn solve(&self, line: &mut [f64]) {
        let Self { beside, pivots } = self;
        let n = line.len();
        for i in 1..n {
            line[i] -= beside / pivots[i - 1] * line[i - 1];
        }
        line[n - 1] /= pivots[n - 1];
        for i in (0..n - 1).rev() {
            line[i] = (line[i] - beside * line[i + 1]) / pivots[i];
        }
    }
}

/// Allocates so many zeroes.
fn zeroes(count: usize) -> Result<Vec<f64>, TextureError> {
    let mut list = room(count)?;
    list.resize(count, 0.0);
    Ok(list)
}
