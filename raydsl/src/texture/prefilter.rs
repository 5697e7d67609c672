//! Coefficients whose B-spline goes through given values.
//!
//! At the centre of a texel the cubic B-spline is `(a + 4 b + c) / 6` of it and its neighbours. To
//! have the values there, a system with that row for each texel is solved along each axis in turn
//! (Unser, "Splines: a perfect fit for signal and image processing", 1999): by elimination in
//! `f64`, with the ends that the address mode says, so the result is exact but for its rounding.

use std::borrow::Cow;

use super::config::{Address, ColorSpace, Filter, TextureConfig};
use super::error::TextureError;
use super::levels::{Grid, room, value};
use super::texel::Texel;
use super::texture::Texture;

impl<T: Texel, const D: usize> Texture<'_, T, D> {
    /// A texture with [`Filter::BSpline`] that goes through the texels of this one: an
    /// interpolating B-spline. It has coefficients of `f32`, linear whatever the colour space of
    /// the texels, and no levels.
    ///
    /// The spline may overshoot between texels, like every smooth curve through given points.
    ///
    /// # Errors
    ///
    /// If there is no memory for the coefficients.
    pub fn interpolating(&self) -> Result<Texture<'static, T::Value, D>, TextureError> {
        let mut grid = Grid::of(self)?;
        let config = self.config();
        for axis in 0..D {
            let border = config.border.to_array().map(f64::from);
            grid.solve(axis, config.address[axis], border);
        }
        let mut texels = room(grid.values.len())?;
        texels.extend(grid.values.iter().map(|v| value::<T::Value>(*v)));
        let (filter, color_space) = (Filter::BSpline, ColorSpace::Linear);
        let config = TextureConfig { filter, color_space, ..*config };
        Ok(Texture::with_parts(Cow::Owned(texels), self.size(), 1, config))
    }
}

impl Grid {
    /// Replaces the values of every line along an axis by coefficients.
    fn solve(&mut self, axis: usize, address: Address, border: [f64; 4]) {
        let n = self.size[axis];
        let (step, lines) = self.lines(axis);
        let mut line = vec![0.0; n];
        for first in lines {
            for (channel, border) in border.into_iter().enumerate() {
                for (i, v) in line.iter_mut().enumerate() {
                    *v = 6.0 * self.values[first + i * step][channel];
                }
                solve(&mut line, address, border);
                for (i, v) in line.iter().enumerate() {
                    self.values[first + i * step][channel] = *v;
                }
            }
        }
    }
}

/// Solves `c[i - 1] + 4 c[i] + c[i + 1] = line[i]`.
fn solve(line: &mut [f64], address: Address, border: f64) {
    let n = line.len();
    match address {
        // The neighbour outside is the texel at the edge, or on the other side of it.
        _ if n == 1 && address != Address::Border => line[0] /= 6.0,
        Address::Clamp | Address::Mirror => eliminate(line, 5.0, 5.0, 1.0),
        Address::Border => {
            line[0] -= border;
            line[n - 1] -= border;
            eliminate(line, 4.0, 4.0, 1.0);
        }
        // Both neighbours of one texel are the other.
        Address::Wrap if n == 2 => eliminate(line, 4.0, 4.0, 2.0),
        Address::Wrap => eliminate_cyclic(line),
    }
}

/// Solves the system with 4 in the diagonal but for its ends, and `beside` next to it (Thomas'
/// algorithm). The diagonal outweighs the rest, so there is no need to pivot.
fn eliminate(line: &mut [f64], first: f64, last: f64, beside: f64) {
    let n = line.len();
    let mut pivots = vec![if n == 1 { first.min(last) } else { first }; n];
    for i in 1..n {
        let diagonal = if i + 1 == n { last } else { 4.0 };
        let factor = beside / pivots[i - 1];
        pivots[i] = diagonal - factor * beside;
        line[i] -= factor * line[i - 1];
    }
    line[n - 1] /= pivots[n - 1];
    for i in (0..n - 1).rev() {
        line[i] = (line[i] - beside * line[i + 1]) / pivots[i];
    }
}

/// Solves the system whose last texel is the neighbour of the first, as a correction of one without
/// those corners (the formula of Sherman and Morrison).
fn eliminate_cyclic(line: &mut [f64]) {
    let n = line.len();
    let corner = -4.0;
    let (first, last) = (4.0 - corner, 4.0 - 1.0 / corner);
    let mut correction = vec![0.0; n];
    (correction[0], correction[n - 1]) = (corner, 1.0);
    eliminate(line, first, last, 1.0);
    eliminate(&mut correction, first, last, 1.0);
    let end = |v: &[f64]| v[0] + v[n - 1] / corner;
    let factor = end(line) / (1.0 + end(&correction));
    for (v, c) in line.iter_mut().zip(&correction) {
        *v -= factor * c;
    }
}
