//! Cylinders with a flat cap at each end, given by the two ends of the axis and a radius.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec2};

use super::axial::{Axial, Round, at_turn, axial, choose, round, turn};
use super::near::{Near, Span, both, end_of, is_at_end, near, slab};
use super::outwards::{around_disk, difference};
use super::surface::{point_on_ray, rounded_point};
use super::{Aabb, Hit, Ray, SurfacePoint};
use crate::machine::functions::vec2;
use crate::machine::generic::clamp;
use crate::{Type, kernel};

/// Error bound of a cylinder's hit, relative as a sphere's.
///
/// Moving the ray to its closest point shifts it by 4 eps of the distance to the cylinder's middle
/// (eps = 2^-24). From there on everything has the size of the cylinder. The decomposition along
/// the axis is off by 4 eps of that, and turns the ray by 4 eps, which matters as far as the
/// cylinder is long; the rest has the form of `sphere::intersect`, without cancellation. Below 32
/// eps together; twice that is allowed.
pub const SLACK: f32 = 1.0 / 262_144.0;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// Intersection of a ray's line with a cylinder.
#[derive(Clone, Copy, Debug, Type)]
struct Meeting {
    line: Near,
    view: Axial,
    round: Round,
    caps: Span,
    inside: Span,
}

/// Intersects a convex body: the span of the infinite cylinder with that between the caps.
#[kernel]
#[inline]
fn meet(ray: Ray, p0: Vec3, p1: Vec3, radius: f32) -> Meeting {
    let axis = p1 - p0;
    let line = near(ray, (p0 - ray.origin) + axis * 0.5);
    // Measure from the middle, so that the offset is as small as possible.
    let view = axial(line, line.offset, axis);
    let round = round(view, radius);
    let caps = slab(view.along, view.step_along, -0.5 * view.length, 0.5 * view.length);
    let meeting = both(round.span, caps);
    let is_met = meeting.is_met && radius > 0.0 && view.length > 0.0;
    Meeting { line, view, round, caps, inside: Span { is_met, ..meeting } }
}

/// Intersects a ray with the cylinder: the nearer of the two intersections within the ray's range.
///
/// A cylinder whose radius is 0, or whose ends coincide, is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, p0: Vec3, p1: Vec3, radius: f32) -> Hit {
    let m = meet(ray, p0, p1, radius);
    end_of(ray, m.line, m.inside)
}

/// Returns the outward normal where `ray` hits the cylinder.
///
/// As for a sphere it comes from the offset to the axis: its error is at most 16 eps times the
/// radius, over the distance or the length, whichever is larger.
#[kernel]
#[inline]
pub fn normal(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> Vec3 {
    let m = meet(ray, p0, p1, radius);
    let is_leaving = is_at_end(hit, m.line, m.inside);
    let through_cap = if is_leaving {
        m.caps.leave < m.round.span.leave
    } else {
        m.caps.enter > m.round.span.enter
    };
    if through_cap {
        let is_ahead = (m.view.step_along > 0.0) == is_leaving;
        if is_ahead { m.view.axis } else { -m.view.axis }
    } else {
        let half = if is_leaving { m.round.half } else { -m.round.half };
        (m.round.aside + m.view.step_across * half).normalize()
    }
}

/// Returns the coordinates of the hit: the share of a turn around the axis, and the height from 0
/// at `p0` to 1 at `p1`. The turn begins at `axis.any_orthonormal_pair().0`. On the caps the height
/// is 0 or 1.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> Vec2 {
    let m = meet(ray, p0, p1, radius);
    let s = if is_at_end(hit, m.line, m.inside) { m.inside.leave } else { m.inside.enter };
    let height = (m.view.along + m.view.step_along * s) / m.view.length + 0.5;
    vec2(turn(m.view.axis, m.view.across + m.view.step_across * s), clamp(height, 0.0, 1.0))
}

/// Returns the surface area of side and caps.
#[kernel]
#[inline]
pub fn area(p0: Vec3, p1: Vec3, radius: f32) -> f32 {
    2.0 * PI * radius * ((p1 - p0).length() + radius)
}

/// Samples a point of the side or of a cap, uniformly for a uniform `u` in the unit square.
#[kernel]
#[inline]
pub fn sample(u: Vec2, p0: Vec3, p1: Vec3, radius: f32) -> SurfacePoint {
    let axis = p1 - p0;
    let length = axis.length();
    let unit = axis / length;
    let across = at_turn(unit, u.y);
    let own_error = (length + radius) * SLACK;
    let part = choose(u.x, length / (length + radius));
    if part.y == 0.0 {
        return rounded_point(p0 + (axis * part.x + across * radius), across, own_error);
    }
    let cap = choose(part.x, 0.5);
    let in_cap = across * (radius * cap.x.sqrt());
    if cap.y == 0.0 {
        rounded_point(p0 + in_cap, -unit, own_error)
    } else {
        rounded_point(p1 + in_cap, unit, own_error)
    }
}

/// Returns the point that `ray` hits.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> SurfacePoint {
    let size = (p1 - p0).length() + radius;
    point_on_ray(ray, hit, normal(ray, hit, p0, p1, radius), size, SLACK)
}

/// Returns the smallest box around the cylinder, that of its caps; at most two ulp too large.
pub fn get_bounds(p0: Vec3, p1: Vec3, radius: f32) -> Aabb {
    let axis = difference(p1, p0);
    around_disk(p0, axis, radius).union(around_disk(p1, axis, radius))
}

/// Splits the cylinder's box at the plane `axis = at`; returns the parts below and above.
pub fn split_primitive(axis: usize, at: f32, p0: Vec3, p1: Vec3, radius: f32) -> (Aabb, Aabb) {
    get_bounds(p0, p1, radius).split(axis, at)
}
