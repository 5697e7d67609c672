//! Lines of rays near a shape: numerics shared by the shapes.

use glam::Vec3;

use super::{Hit, Ray};
use crate::machine::generic::{max, min};
use crate::{Type, kernel};

/// Steps across below this count as 0: `2^-30`, far below their rounding error.
pub(super) const PARALLEL: f32 = 1.0 / 1_073_741_824.0;

/// Line of a ray, parameterized from its point closest to the middle of a shape.
///
/// Far from a shape the coordinates along the ray are large, and their squares cancel. From this
/// point on everything has the size of the shape: the distance is rounded once, when it is
/// computed, which moves the ray by at most 4 eps of it (eps = 2^-24), as in `sphere::intersect`.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Near {
    /// Direction of the ray, scaled so that its largest component is 1.
    pub(super) direction: Vec3,
    /// Offset from the middle of the shape to the point.
    pub(super) offset: Vec3,
    /// Distance from the ray's origin to the point, in lengths of `direction`.
    pub(super) distance: f32,
    /// Length of the ray's own direction, in lengths of `direction`.
    pub(super) scale: f32,
}

/// Returns the largest absolute component.
#[kernel]
#[inline]
pub(super) fn largest(v: Vec3) -> f32 {
    max(max(v.x.abs(), v.y.abs()), v.z.abs())
}

/// Creates the line of `ray` near the point that lies `middle` from its origin.
#[kernel]
#[inline]
pub(super) fn near(ray: Ray, middle: Vec3) -> Near {
    let scale = largest(ray.direction);
    let direction = ray.direction / scale;
    let distance = middle.dot(direction) / direction.dot(direction);
    Near { direction, offset: direction * distance - middle, distance, scale }
}

/// Interval of a line between entry and exit.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Span {
    /// Whether the interval is not empty.
    pub(super) is_met: bool,
    /// Parameter of the entry.
    pub(super) enter: f32,
    /// Parameter of the exit.
    pub(super) leave: f32,
}

/// Returns the span where `at + s * step` lies between `low` and `high`; empty for NaN.
#[kernel]
#[inline]
pub(super) fn slab(at: f32, step: f32, low: f32, high: f32) -> Span {
    if step.abs() < PARALLEL {
        return Span { is_met: low <= at && at <= high, enter: -f32::MAX, leave: f32::MAX };
    }
    let a = (low - at) / step;
    let b = (high - at) / step;
    let (enter, leave) = (min(a, b), max(a, b));
    Span { is_met: low <= high && enter <= leave, enter, leave }
}

/// Returns the intersection of two spans.
#[kernel]
#[inline]
pub(super) fn both(a: Span, b: Span) -> Span {
    let (enter, leave) = (max(a.enter, b.enter), min(a.leave, b.leave));
    Span { is_met: a.is_met && b.is_met && enter <= leave, enter, leave }
}

/// Returns the distance along the ray of the point at `s`, in lengths of the ray's direction.
#[kernel]
#[inline]
pub(super) fn distance_of(line: Near, s: f32) -> f32 {
    (line.distance + s) / line.scale
}

/// Returns whether the ray hits the solid at the end of the span, since the entry is before
/// `t_min`.
#[kernel]
#[inline]
fn is_leaving(ray: Ray, line: Near, span: Span) -> bool {
    distance_of(line, span.enter) < ray.t_min
}

/// Returns whether a hit is at the end of the span, not at its beginning: the nearer of the two. A
/// ray may hit both.
#[kernel]
#[inline]
pub(super) fn is_at_end(hit: Hit, line: Near, span: Span) -> bool {
    let (enter, leave) = (distance_of(line, span.enter), distance_of(line, span.leave));
    (hit.t - enter).abs() > (leave - hit.t).abs()
}

/// Returns the hit of a solid that the line is in for `span`: the nearer end within the ray's
/// range.
#[kernel]
#[inline]
pub(super) fn end_of(ray: Ray, line: Near, span: Span) -> Hit {
    let s = if is_leaving(ray, line, span) { span.leave } else { span.enter };
    let t = distance_of(line, s);
    Hit::new(span.is_met && t >= ray.t_min && t <= ray.t_max, t)
}
