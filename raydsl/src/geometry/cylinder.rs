//! Cylinders with a flat cap at each end, of the two ends of the axis and a radius.

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

/// What a cylinder's hit may be off by, as a sphere's.
///
/// The ray is moved by 4 eps of the distance to the cylinder's middle when it is taken to its
/// closest point (eps = 2^-24). From there on everything has the size of the cylinder. Taking the
/// ray apart at the axis is off by 4 eps of that, and turns the ray by 4 eps, which matters as far
/// as the cylinder is long; what follows has the form of `sphere::intersect`, without cancellation.
/// Below 32 eps together; twice that is allowed.
pub const SLACK: f32 = 1.0 / 262_144.0;

/// How often a ray crosses it at most; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// A ray and what it meets of a cylinder.
#[derive(Clone, Copy, Debug, Type)]
struct Meeting {
    line: Near,
    view: Axial,
    round: Round,
    caps: Span,
    inside: Span,
}

/// A convex body: the line is in it where it is in the endless cylinder and between the caps.
#[kernel]
#[inline]
fn meet(ray: Ray, p0: Vec3, p1: Vec3, radius: f32) -> Meeting {
    let axis = p1 - p0;
    let line = near(ray, (p0 - ray.origin) + axis * 0.5);
    // From the middle, so that the offset is no larger than it must be.
    let view = axial(line, line.offset, axis);
    let round = round(view, radius);
    let caps = slab(view.along, view.step_along, -0.5 * view.length, 0.5 * view.length);
    let meeting = both(round.span, caps);
    let is_met = meeting.is_met && radius > 0.0 && view.length > 0.0;
    Meeting { line, view, round, caps, inside: Span { is_met, ..meeting } }
}

/// Where a ray meets the cylinder: the nearer of its two intersections that lies in the ray's
/// range.
///
/// A cylinder whose radius is 0, or whose ends are one point, is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, p0: Vec3, p1: Vec3, radius: f32) -> Hit {
    let m = meet(ray, p0, p1, radius);
    end_of(ray, m.line, m.inside)
}

/// The normal where `ray` hits the cylinder, outwards.
///
/// As a sphere's it comes from the offset to the axis: it is off by at most 16 eps of what the
/// radius is to the distance, or to the length where that is larger.
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

/// Where `ray` hits: the share of a turn around the axis, and the height from 0 at `p0` to 1 at
/// `p1`. The turn begins at `axis.any_orthonormal_pair().0`. On the caps the height is 0 or 1.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> Vec2 {
    let m = meet(ray, p0, p1, radius);
    let s = if is_at_end(hit, m.line, m.inside) { m.inside.leave } else { m.inside.enter };
    let height = (m.view.along + m.view.step_along * s) / m.view.length + 0.5;
    vec2(turn(m.view.axis, m.view.across + m.view.step_across * s), clamp(height, 0.0, 1.0))
}

/// The area of the side and of both caps.
#[kernel]
#[inline]
pub fn area(p0: Vec3, p1: Vec3, radius: f32) -> f32 {
    2.0 * PI * radius * ((p1 - p0).length() + radius)
}

/// A point of the side or of a cap; a uniform `u` in the unit square gives a uniform one.
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

/// The point that `ray` hits.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, p0: Vec3, p1: Vec3, radius: f32) -> SurfacePoint {
    let size = (p1 - p0).length() + radius;
    point_on_ray(ray, hit, normal(ray, hit, p0, p1, radius), size, SLACK)
}

/// The smallest box around the cylinder, which is that of its caps; at most two ulp too large.
pub fn get_bounds(p0: Vec3, p1: Vec3, radius: f32) -> Aabb {
    let axis = difference(p1, p0);
    around_disk(p0, axis, radius).union(around_disk(p1, axis, radius))
}

/// The parts of the cylinder's box below and above the plane `axis = at`.
pub fn split_primitive(axis: usize, at: f32, p0: Vec3, p1: Vec3, radius: f32) -> (Aabb, Aabb) {
    get_bounds(p0, p1, radius).split(axis, at)
}
