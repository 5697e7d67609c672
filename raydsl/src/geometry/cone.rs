//! Cones with a flat cap, of the centre of the base, the apex and the radius of the base.

use core::f32::consts::PI;

use glam::{Vec2, Vec3, vec2};

use super::axial::{Axial, at_turn, axial, choose, turn};
use super::near::{Near, Span, both, end_of, is_at_end, near, slab};
use super::outwards::{around_disk, difference};
use super::surface::{point_on_ray, rounded_point};
use super::{Aabb, Hit, Ray, SurfacePoint};
use crate::machine::functions::vec2;
use crate::machine::generic::{clamp, max, min};
use crate::{Type, kernel};

/// What a cone's hit may be off by, as a cylinder's: the ray is taken apart at the axis in the same
/// way, and the quadratic has no cancellation but that in its data, which is as small as the ray's
/// distance from the apex.
pub const SLACK: f32 = super::cylinder::SLACK;

/// How often a ray crosses it at most; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// A leading coefficient below this is none; it belongs to a ray along the surface.
const LEAST: f32 = 1e-12;

/// A ray and what it meets of a cone.
#[derive(Clone, Copy, Debug, Type)]
struct Meeting {
    line: Near,
    /// From the apex, towards the base.
    view: Axial,
    /// The radius at the distance 1 from the apex.
    slope: f32,
    /// Within the cone that ends in the apex and has no base.
    side: Span,
    base: Span,
    inside: Span,
}

/// Where `line` is inside of the endless cone of this slope.
///
/// With `p` and `d` the parts across the axis and `z`, `w` those along it, the line is inside where
/// `a s² + 2 b s + c <= 0`: `a = d² - k²w²`, `b = p·d - k² z w`, `c = p² - k²z²`. The discriminant
/// `b² - a c` is `k² m² - a n²`, where `n` is the distance of the two lines across the axis and `m`
/// what is left of it along: moments of the line, of which each can be formed on its own. The
/// root without cancellation gives the other one (Vieta).
#[kernel]
#[inline]
fn within(line: Axial, slope: f32) -> Span {
    let step = line.step_across.length();
    let (rise, drop) = (slope * line.along, slope * line.step_along);
    let coefficient = (step - drop.abs()) * (step + drop.abs());
    let a = if coefficient.abs() < LEAST { LEAST } else { coefficient };
    let b = line.across.dot(line.step_across) - rise * drop;
    let from_axis = line.across.length();
    let c = (from_axis - rise.abs()) * (from_axis + rise.abs());
    // The line's direction across the axis, and what of the offset is along it and beside it.
    let ahead = if step > 0.0 { line.step_across / step } else { line.across * 0.0 };
    let beside = line.across - ahead * line.across.dot(ahead);
    let n = beside.length();
    let m = (rise * step - line.across.dot(ahead) * drop).abs();
    let steep = a.abs().sqrt() * n;
    let radicand = if a > 0.0 { (m - steep) * (m + steep) } else { m * m + steep * steep };
    let root = max(radicand, 0.0).sqrt();
    let q = if b > 0.0 { -b - root } else { root - b };
    let s0 = q / a;
    let s1 = if q == 0.0 { s0 } else { c / q };
    let (low, high) = (min(s0, s1), max(s0, s1));
    if a > 0.0 {
        Span { is_met: radicand >= 0.0, enter: low, leave: high }
    } else if line.step_along > 0.0 {
        // Inside from some point on, towards the base; the other half is beyond the apex.
        Span { is_met: true, enter: high, leave: f32::MAX }
    } else {
        Span { is_met: true, enter: -f32::MAX, leave: low }
    }
}

#[kernel]
#[inline]
fn meet(ray: Ray, base: Vec3, apex: Vec3, radius: f32) -> Meeting {
    let axis = base - apex;
    // Next to the apex the two roots are close to each other, and so they are to this point.
    let line = near(ray, apex - ray.origin);
    let view = axial(line, line.offset, axis);
    let slope = radius / view.length;
    let side = within(view, slope);
    let between = slab(view.along, view.step_along, 0.0, view.length);
    let meeting = both(side, between);
    let is_met = meeting.is_met && radius > 0.0 && view.length > 0.0;
    Meeting { line, view, slope, side, base: between, inside: Span { is_met, ..meeting } }
}

/// Where a ray meets the cone: the nearer of its two intersections that lies in the ray's range.
///
/// A cone whose radius or height is 0 is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, base: Vec3, apex: Vec3, radius: f32) -> Hit {
    let m = meet(ray, base, apex, radius);
    end_of(ray, m.line, m.inside)
}

/// Whether it is the base through which the ray enters or leaves.
#[kernel]
#[inline]
fn is_through_base(m: Meeting, is_leaving: bool) -> bool {
    // The slab's other end is the apex, which belongs to the side.
    if (m.view.step_along > 0.0) != is_leaving {
        false
    } else if is_leaving {
        m.base.leave < m.side.leave
    } else {
        m.base.enter > m.side.enter
    }
}

/// The normal where `ray` hits the cone, outwards; at the apex that of the base, turned round.
///
/// It is off by at most 32 eps of what the distance from the axis is to the distance from the
/// ray's origin, or to the height where that is larger.
#[kernel]
#[inline]
pub fn normal(ray: Ray, hit: Hit, base: Vec3, apex: Vec3, radius: f32) -> Vec3 {
    let m = meet(ray, base, apex, radius);
    let is_leaving = is_at_end(hit, m.line, m.inside);
    if is_through_base(m, is_leaving) {
        m.view.axis
    } else {
        let s = if is_leaving { m.inside.leave } else { m.inside.enter };
        let across = m.view.across + m.view.step_across * s;
        let distance = across.length();
        let outwards = if distance > 0.0 { across / distance } else { across * 0.0 };
        (outwards - m.view.axis * m.slope).normalize()
    }
}

/// Where `ray` hits: the share of a turn around the axis, and the height from 0 at the base to 1 at
/// the apex. The turn begins at `axis.any_orthonormal_pair().0`, where the axis points to the base.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, base: Vec3, apex: Vec3, radius: f32) -> Vec2 {
    let m = meet(ray, base, apex, radius);
    let s = if is_at_end(hit, m.line, m.inside) { m.inside.leave } else { m.inside.enter };
    let height = 1.0 - (m.view.along + m.view.step_along * s) / m.view.length;
    vec2(turn(m.view.axis, m.view.across + m.view.step_across * s), clamp(height, 0.0, 1.0))
}

/// From the apex to the rim of the base.
#[kernel]
#[inline]
fn slant(height: f32, radius: f32) -> f32 {
    (height * height + radius * radius).sqrt()
}

/// The area of the side and of the base.
#[kernel]
#[inline]
pub fn area(base: Vec3, apex: Vec3, radius: f32) -> f32 {
    PI * radius * (slant((base - apex).length(), radius) + radius)
}

/// A point of the side or of the base; a uniform `u` in the unit square gives a uniform one.
#[kernel]
#[inline]
pub fn sample(u: Vec2, base: Vec3, apex: Vec3, radius: f32) -> SurfacePoint {
    let axis = base - apex;
    let height = axis.length();
    let unit = axis / height;
    let across = at_turn(unit, u.y);
    let slant = slant(height, radius);
    let part = choose(u.x, slant / (slant + radius));
    // Of the side and of the base alike, a share `r` of the radius holds the share `r²` of the
    // area.
    let share = part.x.sqrt();
    let own_error = (height + radius) * SLACK;
    if part.y == 0.0 {
        let position = apex + (axis + across * radius) * share;
        rounded_point(position, (across * height - unit * radius) / slant, own_error)
    } else {
        rounded_point(base + across * (radius * share), unit, own_error)
    }
}

/// The point that `ray` hits.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, base: Vec3, apex: Vec3, radius: f32) -> SurfacePoint {
    let size = (base - apex).length() + radius;
    point_on_ray(ray, hit, normal(ray, hit, base, apex, radius), size, SLACK)
}

/// The smallest box around the cone, which is that of its base and its apex; at most two ulp too
/// large.
pub fn get_bounds(base: Vec3, apex: Vec3, radius: f32) -> Aabb {
    around_disk(base, difference(apex, base), radius).union(Aabb::new(apex, apex))
}

/// The parts of the cone's box below and above the plane `axis = at`.
pub fn split_primitive(axis: usize, at: f32, base: Vec3, apex: Vec3, radius: f32) -> (Aabb, Aabb) {
    get_bounds(base, apex, radius).split(axis, at)
}
