//! What cylinders and cones have in common: an axis, and what is along it and across.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3, vec2};

use super::near::{Near, PARALLEL, Span, largest};
use crate::machine::functions::vec2;
use crate::machine::generic::max;
use crate::math::elementary::{atan2, sincos_2pi};
use crate::{Type, kernel};

/// A line, taken apart into what is along an axis and what is across.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Axial {
    /// The direction of the axis, with unit length.
    pub(super) axis: Vec3,
    /// Its length; 0 if it has none.
    pub(super) length: f32,
    /// How far along the axis the line's point is, from where `offset` is measured.
    pub(super) along: f32,
    /// The same of the line's direction.
    pub(super) step_along: f32,
    /// From the axis to the line's point.
    pub(super) across: Vec3,
    /// The part of the line's direction that is perpendicular to the axis.
    pub(super) step_across: Vec3,
}

/// The line through the point `offset` from the beginning of `axis`.
#[kernel]
#[inline]
pub(super) fn axial(line: Near, offset: Vec3, axis: Vec3) -> Axial {
    // The axis may have any length whose square has no place in an `f32`.
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

/// Where a line passes the axis at the distance of a radius or less.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Round {
    /// Where it does.
    pub(super) span: Span,
    /// From the axis to the line where the two are closest.
    pub(super) aside: Vec3,
    /// From there to where it leaves.
    pub(super) half: f32,
}

/// The line within an endless cylinder: `sphere::intersect` in the plane across the axis.
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

/// Which share of a turn around `axis`, of unit length, points at `v`: from 0 to 1.
#[kernel]
#[inline]
pub(super) fn turn(axis: Vec3, v: Vec3) -> f32 {
    let (x, y) = axis.any_orthonormal_pair();
    let turn = atan2(v.dot(y), v.dot(x)) / TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// The direction at this share of a turn around `axis`, with unit length.
#[kernel]
#[inline]
pub(super) fn at_turn(axis: Vec3, share: f32) -> Vec3 {
    let (x, y) = axis.any_orthonormal_pair();
    let around = sincos_2pi(share);
    x * around.cos + y * around.sin
}

/// Which of two parts a uniform number chooses, and what is left of it for the place there.
///
/// `first` is the first part's share of the whole. `y` is 0 for the first part, 1 for the second.
#[kernel]
#[inline]
pub(super) fn choose(u: f32, first: f32) -> Vec2 {
    if u < first { vec2(u / first, 0.0) } else { vec2((u - first) / (1.0 - first), 1.0) }
}
