//! The value along a ray through a cell: a cubic of the distance.

use glam::{Vec3, vec2, vec3};

use super::voxel::Corners;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{clamp, max, min, select};
use crate::machine::margin::{Interval, Known};
use crate::machine::{KnownFunction, Margin};
use crate::{Type, kernel};

/// Cubic polynomial of a place from 0, where a ray enters a cell, to 1, where it leaves.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Cubic {
    pub(super) c0: f32,
    pub(super) c1: f32,
    pub(super) c2: f32,
    pub(super) c3: f32,
}

/// Extreme places of a cubic between 0 and 1, sorted; 2 in place of one that is not there.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Extremes {
    pub(super) first: f32,
    pub(super) second: f32,
}

/// Returns a root that may be an extreme place, or 2.
#[kernel]
#[inline(always)]
fn root_or_none(numerator: f32, denominator: f32) -> f32 {
    let root = numerator / select(denominator == 0.0, 1.0, denominator);
    let is_inside = (denominator != 0.0) & (root > 0.0) & (root < 1.0);
    select(is_inside, root, 2.0)
}

#[kernel]
impl Cubic {
    /// Returns the trilinear value between two places in a cell.
    ///
    /// It is affine in each coordinate, so its blossom, the mean over which coordinate is taken
    /// from which place, gives the Bézier points. (Ramshaw, "Blossoming", 1987.)
    #[inline(always)]
    pub(super) fn through(corners: Corners, from: Vec3, to: Vec3) -> Cubic {
        let Corners { near, far } = corners;
        // Interpolate along x, at both places; then along y, then along z.
        let (ab, cd) = (near.y - near.x, near.w - near.z);
        let (ef, gh) = (far.y - far.x, far.w - far.z);
        let (a0, a1) = (near.x + ab * from.x, near.x + ab * to.x);
        let (b0, b1) = (near.z + cd * from.x, near.z + cd * to.x);
        let (c0, c1) = (far.x + ef * from.x, far.x + ef * to.x);
        let (d0, d1) = (far.z + gh * from.x, far.z + gh * to.x);
        let (n00, n01) = (a0 + (b0 - a0) * from.y, a0 + (b0 - a0) * to.y);
        let (n10, n11) = (a1 + (b1 - a1) * from.y, a1 + (b1 - a1) * to.y);
        let (f00, f01) = (c0 + (d0 - c0) * from.y, c0 + (d0 - c0) * to.y);
        let (f10, f11) = (c1 + (d1 - c1) * from.y, c1 + (d1 - c1) * to.y);
        let (v000, v001) = (n00 + (f00 - n00) * from.z, n00 + (f00 - n00) * to.z);
        let (v010, v011) = (n01 + (f01 - n01) * from.z, n01 + (f01 - n01) * to.z);
        let (v100, v101) = (n10 + (f10 - n10) * from.z, n10 + (f10 - n10) * to.z);
        let (v110, v111) = (n11 + (f11 - n11) * from.z, n11 + (f11 - n11) * to.z);
        // Three times the differences of the inner Bézier points from the first one.
        let first = (v100 - v000) + (v010 - v000) + (v001 - v000);
        let second = (v110 - v000) + (v101 - v000) + (v011 - v000);
        Cubic {
            c0: v000,
            c1: first,
            c2: second - 2.0 * first,
            c3: (v111 - v000) + (first - second),
        }
    }

    /// Returns the cubic with other units of its values.
    #[inline(always)]
    pub(super) fn rescaled(self, scale: f32, offset: f32) -> Cubic {
        Cubic {
            c0: self.c0 * scale + offset,
            c1: self.c1 * scale,
            c2: self.c2 * scale,
            c3: self.c3 * scale,
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, x: f32) -> f32 {
        self.c0 + x * (self.c1 + x * (self.c2 + x * self.c3))
    }

    #[inline(always)]
    pub(super) fn slope(&self, x: f32) -> f32 {
        self.c1 + x * (2.0 * self.c2 + x * (3.0 * self.c3))
    }

    /// Returns a bound on the size of the slope between two places: the largest Bézier point of the
    /// derivative.
    #[inline(always)]
    pub(super) fn steepest(&self, from: f32, to: f32) -> f32 {
        let bend = 2.0 * self.c2 + from * (6.0 * self.c3);
        let (first, last) = (self.slope(from), self.slope(to));
        let middle = first + bend * ((to - from) * 0.5);
        max(max(first.abs(), last.abs()), middle.abs())
    }

    /// Returns where the slope is 0.
    #[inline(always)]
    pub(super) fn extremes(&self) -> Extremes {
        // In units of the largest: squares of values themselves may be infinite, or vanish.
        let size = max(max(self.c1.abs(), self.c2.abs()), max(self.c3.abs(), f32::MIN_POSITIVE));
        let one = vec3(1.0, 1.0, 1.0);
        // The bounds of the reference do not know that a quotient is at most 1.
        let scaled = clamp(vec3(self.c1, self.c2, self.c3) / size, -one, one);
        let (c1, c2, c3) = (scaled.x, scaled.y, scaled.z);
        let square = c2 * c2 - 3.0 * c3 * c1;
        let root = max(square, 0.0).sqrt();
        // Both roots without a difference of like numbers (Press et al., "Numerical Recipes", 5.6).
        let sum = -(c2 + root.copysign(c2));
        let roots = vec2(root_or_none(sum, 3.0 * c3), root_or_none(c1, sum));
        let first = if square > 0.0 { min(roots.x, roots.y) } else { 2.0 };
        let second = if square > 0.0 { max(roots.x, roots.y) } else { 2.0 };
        Extremes { first, second }
    }
}

/// Returns the first extreme place behind `x`, or 1.
#[kernel]
#[inline]
pub(super) fn next_extreme(extremes: Extremes, x: f32) -> f32 {
    let Extremes { first, second } = extremes;
    if x < first { min(first, 1.0) } else { if x < second { min(second, 1.0) } else { 1.0 } }
}

/// Returns where a cubic that is monotone between two places has a value between theirs: by
/// Newton's method within a bracket.
#[kernel(known = PlaceOf)]
#[inline(always)]
pub(super) fn place_of(cubic: Cubic, value: f32, from: f32, to: f32) -> f32 {
    let (at_from, at_to) = (cubic.at(from) - value, cubic.at(to) - value);
    let is_rising = at_to > at_from;
    let (mut low, mut high) = (from, to);
    let across = at_from - at_to;
    let share = at_from / select(across == 0.0, 1.0, across);
    let mut x = from + (to - from) * clamp(share, 0.0, 1.0);
    let mut i = 0u32;
    let mut is_done = false;
    while i < 24 && !is_done {
        let off = cubic.at(x) - value;
        if (off > 0.0) == is_rising {
            high = x;
        } else {
            low = x;
        }
        let slope = cubic.slope(x);
        let next = x - off / select(slope == 0.0, 1.0, slope);
        let is_good = (slope != 0.0) & (next > low) & (next < high);
        let chosen = if is_good { next } else { 0.5 * (low + high) };
        is_done = (off == 0.0) | ((chosen - x).abs() <= 1e-7);
        x = if off == 0.0 { x } else { chosen };
        i += 1;
    }
    x
}

/// Bounds of [`place_of()`] from the cubic itself, not from the steps that lead to its root.
#[derive(Debug)]
struct PlaceOf;

impl KnownFunction for PlaceOf {
    fn bound(&self, m: &Margin, args: &[Known]) -> Option<Vec<Known>> {
        let [c0, c1, c2, c3, value, from, to] = args else { return None };
        let at = |x: f64| c0.value + x * (c1.value + x * (c2.value + x * c3.value));
        // How far the value of any variant may be from that in `f64`, for a place from 0 to 1.
        let terms = [c0, c1, c2, c3, value];
        let width = |v: &Known| (v.range.high - v.range.low).abs();
        let size = |v: &Known| v.range.magnitude();
        let off = terms.iter().map(|v| width(v) + 8.0 * m.rounding().sum * size(v)).sum::<f64>();
        let is_rising = at(to.value) > at(from.value);
        let place = |value: f64| {
            let (mut low, mut high) = (from.value, to.value);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (at(middle) > value) == is_rising { high = middle } else { low = middle }
            }
            0.5 * (low + high)
        };
        let ends = [place(value.value - off), place(value.value + off)];
        // The last step is as long as a bracket that is not narrowed any further.
        let slack = 2.5e-7 + width(from).max(width(to));
        let (low, high) = (ends[0].min(ends[1]) - slack, ends[0].max(ends[1]) + slack);
        let nan = args.iter().any(|v| v.range.nan || v.range.is_nan()) || !off.is_finite();
        Some(vec![m.bounded(place(value.value), Interval::new(low, high, nan))])
    }
}
