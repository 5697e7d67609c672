//! Keeping coordinates of any size inside the comfortable part of `f32`.
//!
//! The area of a box of size 1e30 overflows `f32`, that of one of size 1e-30 underflows, and
//! arithmetic on denormals is slow (see [`Reference`]). The builder guards against that twice:
//!
//! * For each node `binned_sah` measures boxes in units of the node's longest edge, so that areas
//!   lie between 0 and 3 and only their ratios, which are all that matters, remain. That copes
//!   with nodes of any size between `2^-100` and `2^121` at the cost of one multiplication.
//! * What is outside that range, which no ordinary scene is, is multiplied here by a power of two
//!   beforehand, and the boxes of the finished tree are taken from the primitives again, since
//!   scaling down may have rounded.
//!
//! Areas in `f64` would do instead of the first, at half the SIMD width in the hottest code after
//! the binning itself, and would not help with sums that overflow or with denormals.

use super::reference::{Reference, Span};
use super::tasks;
use crate::geometry::Aabb;

/// `2^120`: sums and differences of twice this are finite.
const LARGE: f32 = f32::from_bits((127 + 120) << 23);
/// `2^-60`: well above the numbers whose products are denormal.
const SMALL: f32 = f32::from_bits((127 - 60) << 23);
/// `2^-8`, which brings the largest `f32` below [`LARGE`].
const DOWN: f32 = f32::from_bits((127 - 8) << 23);
/// `2^100`, which makes the smallest denormal number an ordinary one.
const UP: f32 = f32::from_bits((127 + 100) << 23);

/// Pieces of references that are scaled at once.
const PIECE: usize = 1 << 14;

/// Scales everything where it is needed; returns whether it was.
pub(super) fn normalise(references: &mut [Reference], span: &mut Span) -> bool {
    let Aabb { min, max } = span.bounds.to_aabb();
    let largest = min.abs().max(max.abs()).max_element();
    let factor = match largest {
        x if x > LARGE => DOWN,
        x if x < SMALL && x > 0.0 => UP,
        _ => return false,
    };
    let spans = tasks::map_pieces_mut(references, PIECE, |_, piece| {
        piece.iter_mut().for_each(|reference| reference.scale(factor));
        Span::of(piece)
    });
    *span = spans.into_iter().fold(Span::EMPTY, Span::union);
    true
}
