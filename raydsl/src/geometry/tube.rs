//! Tubes: cylinders open at both ends, given by the two ends of the axis and a radius.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec2};

use super::axial::{Axial, Round, at_turn, axial, round, turn};
use super::near::{Near, distance_of, is_at_end, near};
use super::surface::{point_on_ray, rounded_point};
use super::{Aabb, Hit, Ray, SurfacePoint, cylinder};
use crate::machine::functions::vec2;
use crate::machine::generic::clamp;
use crate::{Type, kernel};

/// Error bound of a tube's hit, computed like a cylinder's.
pub const SLACK: f32 = cylinder::SLACK;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// Intersection of a ray's line with a tube.
#[derive(Clone, Copy, Debug, Type)]
struct Meeting {
    line: Near,
    view: Axial,
    round: Round,
    is_met: bool,
    /// Parameter of the hit along the line.
    s: f32,
}

/// Returns whether the point at `s` lies between the ends, and in the ray's range.
#[kernel]
#[inline]
fn is_on(ray: Ray, line: Near, view: Axial, s: f32) -> bool {
    let height = (view.along + view.step_along * s).abs();
    let t = distance_of(line, s);
    height <= 0.5 * view.length && t >= ray.t_min && t <= ray.t_max
}

#[kernel]
#[inline]
fn meet(ray: Ray, p0: Vec3, p1: Vec3, radius: f32) -> Meeting {
    let axis = p1 - p0;
    let line = near(ray, (p0 - ray.origin) + axis * 0.5);
    let view = axial(line, line.offset, axis);
    let round = round(view, radius);
    let is_leaving = !is_on(ray, line, view, round.span.enter);
    let s = if is_leaving { round.span.leave } else { round.span.enter };
    let is_some = round.span.is_met && radius > 0.0 && view.length > 0.0;
    // A ray along the axis stays inside or outside.
    let is_met = is_some && round.half < f32::MAX && is_on(ray, line, view, s);
    Meeting { line, view, round, is_met, s }
}

/// Intersects a ray with the tube, from outside or inside: the nearest of its intersections within
/// the ray's range.
///
/// A tube whose radius is 0, or whose ends coincide, is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, p0: Vec3, p1: Vec3, radius: f32) -> Hit {
    let m = meet(ray, p0, p1, radius);
    Hit::new(m.is_met, distance_of(m.line, m.s))
}

/// Returns the normal where `ray` hits the tube, away from the axis; as precise as a cylinder's.
#[kernel]
#[inline]
pub fn normal(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> Vec3 {
    let m = meet(ray, p0, p1, radius);
    let is_far = is_at_end(hit, m.line, m.round.span);
    let half = if is_far { m.round.half } else { -m.round.half };
    (m.round.aside + m.view.step_across * half).normalize()
}

/// Returns the coordinates of the hit: the share of a turn around the axis, and the height from 0
/// at `p0` to 1 at `p1`. The turn begins at `axis.any_orthonormal_pair().0`.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> Vec2 {
    let m = meet(ray, p0, p1, radius);
    let is_far = is_at_end(hit, m.line, m.round.span);
    let s = if is_far { m.round.span.leave } else { m.round.span.enter };
    let height = (m.view.along + m.view.step_along * s) / m.view.length + 0.5;
    vec2(turn(m.view.axis, m.view.across + m.view.step_across * s), clamp(height, 0.0, 1.0))
}

/// Returns the area of the outer side.
#[kernel]
#[inline]
pub fn area(p0: Vec3, p1: Vec3, radius: f32) -> f32 {
    2.0 * PI * radius * (p1 - p0).length()
}

/// Samples a point of the tube, uniformly for a uniform `u` in the unit square.
#[kernel]
#[inline]
pub fn sample(u: Vec2, p0: Vec3, p1: Vec3, radius: f32) -> SurfacePoint {
    let axis = p1 - p0;
    let across = at_turn(axis.normalize(), u.y);
    let own_error = (axis.length() + radius) * SLACK;
    rounded_point(p0 + (axis * u.x + across * radius), across, own_error)
}

/// Returns the point that `ray` hits.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> SurfacePoint {
    let size = (p1 - p0).length() + radius;
    point_on_ray(ray, hit, normal(ray, hit, p0, p1, radius), size, SLACK)
}

/// Returns the smallest box around the tube, that of a cylinder.
pub fn get_bounds(p0: Vec3, p1: Vec3, radius: f32) -> Aabb {
    cylinder::get_bounds(p0, p1, radius)
}

/// Splits the tube's box at the plane `axis = at`; returns the parts below and above.
pub fn split_primitive(axis: usize, at: f32, p0: Vec3, p1: Vec3, radius: f32) -> (Aabb, Aabb) {
    get_bounds(p0, p1, radius).split(axis, at)
}
