//! Tabulated distributions: piecewise constant densities.

use glam::{UVec2, Vec2, uvec2, vec2};

use super::rng::ONE_MINUS_EPSILON;
use crate::machine::functions::{uvec2, vec2};
use crate::machine::generic::{clamp, max, min};
use crate::{Type, kernel};

/// Error of creating a distribution from weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TableError {
    /// There are no weights.
    #[error("a distribution needs at least one weight")]
    Empty,
    /// There are more than 2^22 cells side by side, which an `f32` hardly resolves, or 2^31 in all,
    /// which a kernel cannot count.
    #[error("{count} cells are too many: at most {limit}")]
    TooMany {
        /// Number of cells, side by side or in all.
        count: usize,
        /// Maximum number of cells.
        limit: usize,
    },
    /// A weight is negative, infinite or NaN.
    #[error("weight number {0}, from 0 on, is negative or not finite")]
    NotAWeight(usize),
    /// All weights are 0.
    #[error("all weights are 0")]
    AllZero,
    /// The number of weights is not that of the cells.
    #[error("{found} weights for {} by {} cells", size.x, size.y)]
    Size {
        /// Cells per row, and rows.
        size: UVec2,
        /// Number of weights.
        found: usize,
    },
}

/// Distribution over the unit interval from tabulated weights.
///
/// Kernels capture [`cdf`](Self::cdf), a slice, and call [`sample_table()`] and [`table_pdf()`]
/// with it:
///
/// ```
/// use raydsl::prelude::*;
///
/// let table = Distribution1d::new(&[1.0, 0.0, 3.0])?;
/// let cdf = table.cdf();
/// let kernel = kernel!(|u: f32| sample_table(u, cdf));
/// let sample = kernel.call((0.5,));
/// assert_eq!((sample.cell, sample.pdf), (2, 2.25));
/// # Ok::<(), raydsl::sampling::TableError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1d {
    cdf: Vec<f32>,
    sum: f64,
}

impl Distribution1d {
    /// Creates a distribution from these weights, none negative; some may be 0.
    ///
    /// Sums are computed in `f64` and rounded once. A cell with less than 3e-8 of the total weight
    /// may end up with none.
    ///
    /// # Errors
    ///
    /// If there are no weights or too many, all are 0, or one is negative or not finite.
    pub fn new(weights: &[f32]) -> Result<Self, TableError> {
        check(weights, weights.len())?;
        let mut cdf = Vec::with_capacity(weights.len() + 1);
        let sum = append_cdf(weights.iter().copied().map(f64::from), &mut cdf);
        if sum > 0.0 { Ok(Self { cdf, sum }) } else { Err(TableError::AllZero) }
    }

    /// Returns the cumulative distribution for kernels to capture: the share before each cell, and
    /// 1.
    pub fn cdf(&self) -> &[f32] {
        &self.cdf
    }

    /// Returns the mean of the weights: the integral over the unit interval.
    pub fn integral(&self) -> f64 {
        self.sum / (self.cdf.len() - 1) as f64
    }
}

/// Distribution over the unit square from tabulated weights, such as the luminance of an image.
///
/// Kernels capture [`cdf`](Self::cdf) and [`size`](Self::size), and call [`sample_table_2d()`] and
/// [`table_2d_pdf()`] with them.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution2d {
    cdf: Vec<f32>,
    size: UVec2,
    sum: f64,
}

impl Distribution2d {
    /// Creates a distribution from `size.y` rows of `size.x` weights, from y = 0 on.
    ///
    /// Rounding is that of [`Distribution1d::new`], for rows and within each. A row of zeros is
    /// never sampled.
    ///
    /// # Errors
    ///
    /// If `weights` has another length, there are none or too many, all are 0, or one is negative
    /// or not finite.
    pub fn new(weights: &[f32], size: UVec2) -> Result<Self, TableError> {
        if weights.len() as u64 != u64::from(size.x) * u64::from(size.y) {
            return Err(TableError::Size { size, found: weights.len() });
        }
        check(weights, size.max_element() as usize)?;
        let (mut rows, mut cdf) = (Vec::new(), Vec::new());
        let sums = weights
            .chunks(size.x as usize)
            .map(|row| append_cdf(row.iter().copied().map(f64::from), &mut rows));
        let sums: Vec<f64> = sums.collect();
        let sum = append_cdf(sums.into_iter(), &mut cdf);
        cdf.append(&mut rows);
        if sum > 0.0 { Ok(Self { cdf, size, sum }) } else { Err(TableError::AllZero) }
    }

    /// Returns the cumulative distributions: the share before each row, and 1; then the same for
    /// the cells of each row.
    pub fn cdf(&self) -> &[f32] {
        &self.cdf
    }

    /// Returns the cells per row, and the rows.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// Returns the mean of the weights: the integral over the unit square.
    pub fn integral(&self) -> f64 {
        self.sum / (f64::from(self.size.x) * f64::from(self.size.y))
    }
}

/// Maximum number of cells side by side.
const MOST_CELLS: usize = 1 << 22;

fn check(weights: &[f32], side: usize) -> Result<(), TableError> {
    if weights.is_empty() {
        return Err(TableError::Empty);
    }
    for (count, limit) in [(side, MOST_CELLS), (weights.len(), 1 << 31)] {
        if count > limit {
            return Err(TableError::TooMany { count, limit });
        }
    }
    match weights.iter().position(|w| !(w.is_finite() && *w >= 0.0)) {
        Some(i) => Err(TableError::NotAWeight(i)),
        None => Ok(()),
    }
}

/// Appends the share before each weight, and 1; returns the sum. Weights that are all 0 have equal
/// shares.
fn append_cdf(weights: impl ExactSizeIterator<Item = f64> + Clone, cdf: &mut Vec<f32>) -> f64 {
    let (count, sum) = (weights.len() as f64, weights.clone().sum::<f64>());
    let mut before = 0.0;
    for (i, w) in weights.enumerate() {
        let share = if sum > 0.0 { before / sum } else { i as f64 / count };
        cdf.push(share as f32);
        before += w;
    }
    cdf.push(1.0);
    sum
}

/// Sample of a [`Distribution1d`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct TableSample {
    /// Position, from 0 to below 1.
    pub x: f32,
    /// Density. It is that of the rounded table, so that estimates have no bias.
    pub pdf: f32,
    /// Index of its cell, whose weight is not 0.
    pub cell: u32,
}

/// Sample of a [`Distribution2d`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct TableSample2d {
    /// Position in the unit square.
    pub point: Vec2,
    /// Density per area of the square.
    pub pdf: f32,
    /// Column and row of its cell, whose weight is not 0.
    pub cell: UVec2,
}

/// Returns the last of `count` cells, from `first` on, that begins at or before `u`.
#[kernel]
#[inline]
fn cell_of(u: f32, cdf: &[f32], first: u32, count: u32) -> u32 {
    let mut low = 0u32;
    let mut high = count;
    while low + 1 < high {
        let middle = (low + high) / 2;
        if cdf[(first + middle) as usize] <= u {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Samples `count` cells that begin at `first`.
#[kernel]
#[inline]
fn sample_cells(u: f32, cdf: &[f32], first: u32, count: u32) -> TableSample {
    let cell = cell_of(u, cdf, first, count);
    let start = cdf[(first + cell) as usize];
    let share = cdf[(first + cell + 1) as usize] - start;
    let x = (cell as f32 + (u - start) / share) / count as f32;
    // Rounding must not move the sample to the next cell, whose density differs.
    let end = edge(cell + 1, count);
    let below_end = f32::from_bits(end.to_bits() - 1);
    TableSample { x: min(x, below_end), pdf: share * count as f32, cell }
}

/// Returns the beginning of a cell.
#[kernel]
#[inline]
fn edge(cell: u32, count: u32) -> f32 {
    cell as f32 / count as f32
}

/// Returns the cell that contains `x`, clamped to the first or the last one.
#[kernel]
#[inline]
fn cell_at(x: f32, count: u32) -> u32 {
    // The product may be rounded to a neighbour's cell.
    let near = min((x * count as f32) as u32, count - 1);
    let low = if x < edge(near, count) { max(near, 1) - 1 } else { near };
    if x >= edge(low + 1, count) { min(low + 1, count - 1) } else { low }
}

/// Returns the density of the cell `cell` among `count` from `first` on.
#[kernel]
#[inline]
fn density(cell: u32, cdf: &[f32], first: u32, count: u32) -> f32 {
    (cdf[(first + cell + 1) as usize] - cdf[(first + cell) as usize]) * count as f32
}

/// Returns the number whose sample is `x`.
#[kernel]
#[inline]
fn invert_cells(x: f32, cdf: &[f32], first: u32, count: u32) -> f32 {
    let cell = cell_at(x, count);
    let start = cdf[(first + cell) as usize];
    let share = cdf[(first + cell + 1) as usize] - start;
    let within = clamp(x * count as f32 - cell as f32, 0.0, 1.0);
    min(start + within * share, ONE_MINUS_EPSILON)
}

/// Samples a [`Distribution1d`] in as many steps as the number of cells has bits.
#[kernel]
#[inline]
pub fn sample_table(u: f32, cdf: &[f32]) -> TableSample {
    sample_cells(u, cdf, 0, cdf.len() as u32 - 1)
}

/// Returns the density of a [`Distribution1d`] at `x`.
#[kernel]
#[inline]
pub fn table_pdf(x: f32, cdf: &[f32]) -> f32 {
    let count = cdf.len() as u32 - 1;
    density(cell_at(x, count), cdf, 0, count)
}

/// Inverts [`sample_table()`]: returns the number whose sample is at `x`.
#[kernel]
#[inline]
pub fn invert_table(x: f32, cdf: &[f32]) -> f32 {
    invert_cells(x, cdf, 0, cdf.len() as u32 - 1)
}

/// Returns the offset of a row's cells.
#[kernel]
#[inline]
fn row_start(row: u32, size: UVec2) -> u32 {
    size.y + 1 + row * (size.x + 1)
}

/// Samples a [`Distribution2d`]: `u.y` chooses the row, `u.x` the cell in it.
#[kernel]
#[inline]
pub fn sample_table_2d(u: Vec2, cdf: &[f32], size: UVec2) -> TableSample2d {
    let row = sample_cells(u.y, cdf, 0, size.y);
    let column = sample_cells(u.x, cdf, row_start(row.cell, size), size.x);
    TableSample2d {
        point: vec2(column.x, row.x),
        pdf: column.pdf * row.pdf,
        cell: uvec2(column.cell, row.cell),
    }
}

/// Returns the density of a [`Distribution2d`] at a point.
#[kernel]
#[inline]
pub fn table_2d_pdf(point: Vec2, cdf: &[f32], size: UVec2) -> f32 {
    let row = cell_at(point.y, size.y);
    let of_row = density(row, cdf, 0, size.y);
    of_row * density(cell_at(point.x, size.x), cdf, row_start(row, size), size.x)
}

/// Inverts [`sample_table_2d()`]: returns the point whose sample is at `point`.
#[kernel]
#[inline]
pub fn invert_table_2d(point: Vec2, cdf: &[f32], size: UVec2) -> Vec2 {
    let row = cell_at(point.y, size.y);
    let x = invert_cells(point.x, cdf, row_start(row, size), size.x);
    vec2(x, invert_cells(point.y, cdf, 0, size.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_makes_no_distribution_is_named() {
        let of = |weights: &[f32]| Distribution1d::new(weights).map(|d| d.integral());
        assert_eq!(of(&[]), Err(TableError::Empty));
        assert_eq!(of(&[0.0, 0.0]), Err(TableError::AllZero));
        assert_eq!(of(&[1.0, f32::NAN]), Err(TableError::NotAWeight(1)));
        assert_eq!(of(&[-1.0, 1.0]), Err(TableError::NotAWeight(0)));
        assert_eq!(of(&[1.0, 0.0, f32::INFINITY]), Err(TableError::NotAWeight(2)));
        assert_eq!(of(&[-0.0, 3.0]), Ok(1.5));
        assert_eq!(
            of(&vec![1.0; MOST_CELLS + 1]),
            Err(TableError::TooMany { count: MOST_CELLS + 1, limit: MOST_CELLS })
        );
        assert_eq!(of(&[f32::MAX; 4]), Ok(f64::from(f32::MAX)));
        let size = uvec2(2, 2);
        let error = Distribution2d::new(&[1.0; 3], size).unwrap_err();
        assert_eq!(error, TableError::Size { size, found: 3 });
        assert_eq!(error.to_string(), "3 weights for 2 by 2 cells");
        assert_eq!(Distribution2d::new(&[0.0; 4], size), Err(TableError::AllZero));
    }

    /// A cell without weight is never chosen, whatever the number, and a sample's density is that
    /// of its position.
    #[test]
    fn zeros_are_never_sampled() {
        let weights = [0.0, 0.0, 1.0, 0.0, 1e-30, 2.0, 0.0];
        let table = Distribution1d::new(&weights).expect("weights");
        for i in 0..=1000 {
            let u = (i as f32 / 1000.0).min(ONE_MINUS_EPSILON);
            let sample = sample_table(u, table.cdf());
            assert!(weights[sample.cell as usize] > 1e-20 && sample.pdf > 0.0, "{u}");
            assert_eq!(table_pdf(sample.x, table.cdf()), sample.pdf);
            assert!((invert_table(sample.x, table.cdf()) - u).abs() < 1e-6, "{u}");
        }
        let rows = [0.0, 0.0, 1.0, 3.0, 0.0, 0.0];
        let table = Distribution2d::new(&rows, uvec2(2, 3)).expect("weights");
        for i in 0..100 {
            let u = vec2(i as f32 / 100.0, (i * 37 % 100) as f32 / 100.0);
            let sample = sample_table_2d(u, table.cdf(), table.size());
            assert_eq!(sample.cell.y, 1);
            assert_eq!(table_2d_pdf(sample.point, table.cdf(), table.size()), sample.pdf);
            let back = invert_table_2d(sample.point, table.cdf(), table.size());
            assert!((back - u).abs().max_element() < 1e-6, "{u}");
        }
    }
}
