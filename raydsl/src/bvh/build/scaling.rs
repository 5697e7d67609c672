//! Scaling of coordinates into the safe range of `f32`.
//!
//! The area of a box of size 1e30 overflows `f32`, that of one of size 1e-30 underflows, and
//! arithmetic on denormals is slow (see [`Reference`]). The builder guards against that twice:
//!
//! * For each node `binned_sah` measures boxes in units of the node's longest edge, so that areas
//!   lie between 0 and 3 and only their ratios matter. That copes with nodes of any size between
//!   `2^-100` and `2^121` at the cost of one multiplication.
//! * Scenes outside that range, which no ordinary scene is, are multiplied here by a power of two
//!   beforehand. The boxes of the finished tree are taken from the primitives again, since scaling
//!   down may have rounded; boxes of cut primitives are scaled back instead, rounding outwards.
//!
//! Areas in `f64` could replace the first, at half the SIMD width in the hottest code after the
//! binning itself, but would not help with overflowing sums or denormals.

use glam::Vec3;

use super::reference::{Reference, Span};
use super::tasks;
use crate::geometry::Aabb;

/// `2^120`: sums and differences of twice this are finite.
const LARGE: f32 = f32::from_bits((127 + 120) << 23);
/// `2^-60`: well above numbers with denormal products.
const SMALL: f32 = f32::from_bits((127 - 60) << 23);
/// `2^-8`: brings the largest `f32` below [`LARGE`].
const DOWN: f32 = f32::from_bits((127 - 8) << 23);
/// `2^100`: makes the smallest denormal a normal number.
const UP: f32 = f32::from_bits((127 + 100) << 23);

/// References per piece of parallel work.
const PIECE: usize = 1 << 14;

/// Scale of lengths while building: a power of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale(f32);

impl Scale {
    /// Returns whether lengths are unscaled.
    pub(super) fn is_one(self) -> bool {
        self.0 == 1.0
    }

    /// Converts a scaled coordinate to the application's units.
    pub(super) fn outside(self, x: f32) -> f32 {
        x / self.0
    }

    /// Scales a box in the application's units. Coordinates next to 0 may be rounded towards or
    /// away from it.
    pub(super) fn inside(self, bounds: Aabb) -> Aabb {
        Aabb::new(bounds.min * self.0, bounds.max * self.0)
    }

    /// Returns the plane nearest to a scaled coordinate that is exact in the application's units,
    /// too.
    pub(super) fn plane(self, at: f32) -> f32 {
        self.outside(at) * self.0
    }

    /// Converts a scaled box to the application's units, rounding outwards by the error of scaling
    /// down.
    pub(super) fn back(self, bounds: Aabb) -> Aabb {
        let lost = f32::MIN_POSITIVE * f32::EPSILON;
        let wider = |x: f32, by: f32| {
            let was_exact = self.0 >= 1.0 || x.abs() > f32::MIN_POSITIVE;
            self.outside(if was_exact { x } else { x + by })
        };
        let min = bounds.min.to_array().map(|x| wider(x, -lost));
        let max = bounds.max.to_array().map(|x| wider(x, lost));
        Aabb::new(Vec3::from_array(min), Vec3::from_array(max))
    }
}

/// Scales references and span where needed; returns the scale.
pub(super) fn normalise(references: &mut [Reference], span: &mut Span) -> Scale {
    let Aabb { min, max } = span.bounds.to_aabb();
    let largest = min.abs().max(max.abs()).max_element();
    let factor = match largest {
        x if x > LARGE => DOWN,
        x if x < SMALL && x > 0.0 => UP,
        _ => return Scale(1.0),
    };
    let spans = tasks::map_pieces_mut(references, PIECE, |_, piece| {
        piece.iter_mut().for_each(|reference| reference.scale(factor));
        Span::of(piece)
    });
    *span = spans.into_iter().fold(Span::EMPTY, Span::union);
    Scale(factor)
}
