//! Axial decomposition of lines, shared by cylinders and cones.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3, vec2};

use super::near::{Near, PARALLEL, Span, largest};
use crate::machine::functions::vec2;
use crate::machine::generic::max;
use crate::math::elementary::{atan2, sincos_2pi};
use crate::{Type, kernel};

/// Line decomposed into components along an axis and across it.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Axial {
    /// Unit direction of the axis.
    pub(super) axis: Vec3,
    /// Length of the axis; 0 if it has none.
    pub(super) length: f32,
    /// Component of the line's point along the axis, from the beginning of `offset`.
    pub(super) along: f32,
    /// Component of the line's direction along the axis.
    pub(super) step_along: f32,
    /// Perpendicular from the axis to the line's point.
    pub(super) across: Vec3,
    /// Component of the line's direction perpendicular to the axis.
    pub(super) step_across: Vec3,
}

/// Decomposes the line through the point `offset` from the beginning of `axis`.
#[kernel]
#[inline]
pub(super) fn axial(line: Near, offset: Vec3, axis: Vec3) -> Axial {
    // Scale first: the square of the axis's length may leave the range of `f32`.
    let size = largest(axis);
    let scaled = axis / size;
    let stretch = scaled.length();
    let unit = scaled / stretch;
    let along = offset.dot(unit);
    let step_along = line.direction.dot(unit);
    Axial {
        axis: unit,
        length: if size > 0.0 { size * stretch } else { 0.0 },
        along,
        step_along,
        across: offset - unit * along,
        step_across: line.direction - unit * step_along,
    }
}

/// Intersection of a line with an infinite cylinder.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Round {
    /// Span of the line within the radius.
    pub(super) span: Span,
    /// Perpendicular from the axis to the line at their closest approach.
    pub(super) aside: Vec3,
    /// Distance from there to the exit.
    pub(super) half: f32,
}

/// Intersects the line with an infinite cylinder: `sphere::intersect` in the plane across the axis.
#[kernel]
#[inline]
pub(super) fn round(line: Axial, radius: f32) -> Round {
    let step = line.step_across;
    let step2 = step.dot(step);
    if step2 < PARALLEL * PARALLEL {
        let is_met = line.across.length() <= radius;
        return Round {
            span: Span { is_met, enter: -f32::MAX, leave: f32::MAX },
            aside: line.across,
            half: f32::MAX,
        };
    }
    let closest = -line.across.dot(step) / step2;
    let aside = line.across + step * closest;
    let distance = aside.length();
    let radicand = (radius - distance) * (radius + distance);
    let half = (max(radicand, 0.0) / step2).sqrt();
    let span = Span { is_met: radicand >= 0.0, enter: closest - half, leave: closest + half };
    Round { span, aside, half }
}

/// Returns the angle of `v` around the unit vector `axis`, as a share of a turn from 0 to 1.
#[kernel]
#[inline]
pub(super) fn turn(axis: Vec3, v: Vec3) -> f32 {
    let (x, y) = axis.any_orthonormal_pair();
    let turn = atan2(v.dot(y), v.dot(x)) / TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// Returns the unit direction at this share of a turn around `axis`.
#[kernel]
#[inline]
pub(super) fn at_turn(axis: Vec3, share: f32) -> Vec3 {
    let (x, y) = axis.any_orthonormal_pair();
    let around = sincos_2pi(share);
    x * around.cos + y * around.sin
}

/// Chooses one of two parts by a uniform number, and rescales it for reuse within the part.
///
/// `first` is the first part's share. `y` is 0 for the first part, 1 for the second.
#[kernel]
#[inline]
pub(super) fn choose(u: f32, first: f32) -> Vec2 {
    if u < first { vec2(u / first, 0.0) } else { vec2((u - first) / (1.0 - first), 1.0) }
}
