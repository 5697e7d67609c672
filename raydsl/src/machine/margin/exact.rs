//! What a cross product loses: known to be small, where intervals would only widen.

use super::Margin;
use super::arena::Known;
use super::interval::Interval;

/// By what a factor is multiplied to tell its halves apart, rounded up.
const SPLIT: f64 = 4098.0;
/// How many of the sums and products that find what one product loses may underflow.
const PARTS: f64 = 8.0;

impl Margin {
    /// [`lost_by_cross`](crate::math::exact::is_lost_by_cross): nothing in `f64`. Each product loses at most
    /// its rounding; a device that fuses or reorders what finds that may be off by as much again.
    pub(super) fn lost_by_cross(&self, args: &[Known]) -> Vec<Known> {
        let size = |i: usize| args[i].range.magnitude();
        let product = |i: usize, j: usize| {
            let (a, b) = (size(i), size(3 + j));
            // Halves of a factor are told apart by a multiple of it; beyond the largest number that
            // is infinite, and the rest of it is no number.
            let largest = (SPLIT * a).max(SPLIT * b).max(a * b);
            if largest > f64::from(f32::MAX) {
                return f64::INFINITY;
            }
            2.0 * (self.rounding.sum * a * b + PARTS * self.rounding.least)
        };
        let lost = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| product(i, j) + product(j, i));
        let nan = args.iter().any(|v| v.range.nan || v.range.is_nan());
        let within = |error: f64| {
            let nan = nan || !error.is_finite();
            self.bounded(0.0, Interval::new(-error, error, nan))
        };
        let rest = lost.map(|error| 2.0 * (self.rounding.sum * error + self.rounding.least));
        lost.into_iter().chain(rest).map(within).collect()
    }
}
