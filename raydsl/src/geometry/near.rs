//! A ray seen from close by: what the shapes have in common.

use glam::Vec3;

use super::{Hit, Ray};
use crate::machine::generic::{max, min};
use crate::{Type, kernel};

/// A step across smaller than this is none: `2^-30`, far below what rounding makes of it.
pub(super) const PARALLEL: f32 = 1.0 / 1_073_741_824.0;

/// The line of a ray, measured from its point that is closest to the middle of a shape.
///
/// Far from a shape the coordinates along the ray are large, and their squares cancel. From this
/// point on everything has the size of the shape: the distance is rounded once, when it is formed,
/// and that moves the ray by at most 4 eps of it (eps = 2^-24), as in `sphere::intersect`.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Near {
    /// The ray's direction, made so that its largest component is 1.
    pub(super) direction: Vec3,
    /// From the middle of the shape to the point.
    pub(super) offset: Vec3,
    /// From the ray's origin to the point, in lengths of `direction`.
    pub(super) distance: f32,
    /// How many lengths of `direction` the ray's own has.
    pub(super) scale: f32,
}

/// The largest of the components, without their signs.
#[kernel]
#[inline]
pub(super) fn largest(v: Vec3) -> f32 {
    max(max(v.x.abs(), v.y.abs()), v.z.abs())
}

/// The line of `ray` near the point that lies `middle` from its origin.
#[kernel]
#[inline]
pub(super) fn near(ray: Ray, middle: Vec3) -> Near {
    let scale = largest(ray.direction);
    let direction = ray.direction / scale;
    let distance = middle.dot(direction) / direction.dot(direction);
    Near { direction, offset: direction * distance - middle, distance, scale }
}

/// A part of a line, from where it enters something to where it leaves it.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Span {
    /// Whether there is such a part.
    pub(super) is_met: bool,
    /// Its beginning.
    pub(super) enter: f32,
    /// Its end.
    pub(super) leave: f32,
}

/// Where `at + s * step` lies from `low` to `high`. What is not a number gives nothing.
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

/// The common part.
#[kernel]
#[inline]
pub(super) fn both(a: Span, b: Span) -> Span {
    let (enter, leave) = (max(a.enter, b.enter), min(a.leave, b.leave));
    Span { is_met: a.is_met && b.is_met && enter <= leave, enter, leave }
}

/// The distance along the ray, in lengths of its direction, of the point at `s`.
#[kernel]
#[inline]
pub(super) fn distance_of(line: Near, s: f32) -> f32 {
    (line.distance + s) / line.scale
}

/// Whether it is the end of the span where the ray meets the solid: its beginning is before
/// `t_min`.
#[kernel]
#[inline]
fn is_leaving(ray: Ray, line: Near, span: Span) -> bool {
    distance_of(line, span.enter) < ray.t_min
}

/// Whether a hit is at the end of the span, not at its beginning: whichever is nearer to it. A ray may
/// have both for hits.
#[kernel]
#[inline]
pub(super) fn is_at_end(hit: Hit, line: Near, span: Span) -> bool {
    let (enter, leave) = (distance_of(line, span.enter), distance_of(line, span.leave));
    (hit.t - enter).abs() > (leave - hit.t).abs()
}

/// Where the ray meets a solid that its line is in for `span`: the nearer end of the two that lies
/// in the ray's range.
#[kernel]
#[inline]
pub(super) fn end_of(ray: Ray, line: Near, span: Span) -> Hit {
    let s = if is_leaving(ray, line, span) { span.leave } else { span.enter };
    let t = distance_of(line, s);
    Hit::new(span.is_met && t >= ray.t_min && t <= ray.t_max, t)
}
