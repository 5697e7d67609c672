//! Cones with a flat cap, given by the centre of the base, the apex and the radius of the base.

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

/// Error bound of a cone's hit, equal to a cylinder's: the ray is decomposed along the axis in the
/// same way, and the quadratic has no cancellation but that in its data, which is as small as the
/// ray's distance from the apex.
pub const SLACK: f32 = super::cylinder::SLACK;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// A leading coefficient below this counts as 0; it belongs to a ray along the surface.
const LEAST: f32 = 1e-12;

/// Intersection of a ray's line with a cone.
#[derive(Clone, Copy, Debug, Type)]
struct Meeting {
    line: Near,
    /// Decomposition from the apex, towards the base.
    view: Axial,
    /// Radius at distance 1 from the apex.
    slope: f32,
    /// Span within the infinite cone from the apex.
    side: Span,
    base: Span,
    inside: Span,
}

/// Returns the span of `line` within the infinite cone of this slope.
///
/// With `p` and `d` the parts across the axis and `z`, `w` those along it, the line is inside where
/// `a s² + 2 b s + c <= 0`: `a = d² - k²w²`, `b = p·d - k² z w`, `c = p² - k²z²`. The discriminant
/// `b² - a c` is `k² m² - a n²`, where `n` is the distance of the two lines across the axis and `m`
/// the remaining component along it: moments of the line, each computed on its own. The root
/// without cancellation yields the other one (Vieta).
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
    // The line's direction across the axis, and the offset's components along and beside it.
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
    // Next to the apex the two roots are close to each other, and to this point.
    let line = near(ray, apex - ray.origin);
    let view = axial(line, line.offset, axis);
    let slope = radius / view.length;
    let side = within(view, slope);
    let between = slab(view.along, view.step_along, 0.0, view.length);
    let meeting = both(side, between);
    let is_met = meeting.is_met && radius > 0.0 && view.length > 0.0;
    Meeting { line, view, slope, side, base: between, inside: Span { is_met, ..meeting } }
}

/// Intersects a ray with the cone: the nearer of the two intersections within the ray's range.
///
/// A cone whose radius or height is 0 is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, base: Vec3, apex: Vec3, radius: f32) -> Hit {
    let m = meet(ray, base, apex, radius);
    end_of(ray, m.line, m.inside)
}

/// Returns whether the ray enters or leaves through the base.
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

/// Returns the outward normal where `ray` hits the cone; at the apex that of the base, reversed.
///
/// Its error is at most 32 eps times the distance from the axis, over the distance to the ray's
/// origin or the height, whichever is larger.
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

/// Returns the coordinates of the hit: the share of a turn around the axis, and the height from 0
/// at the base to 1 at the apex. The turn begins at `axis.any_orthonormal_pair().0`, with the axis
/// pointing to the base.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, base: Vec3, apex: Vec3, radius: f32) -> Vec2 {
    let m = meet(ray, base, apex, radius);
    let s = if is_at_end(hit, m.line, m.inside) { m.inside.leave } else { m.inside.enter };
    let height = 1.0 - (m.view.along + m.view.step_along * s) / m.view.length;
    vec2(turn(m.view.axis, m.view.across + m.view.step_across * s), clamp(height, 0.0, 1.0))
}

/// Returns the slant height, from the apex to the rim of the base.
#[kernel]
#[inline]
fn slant(height: f32, radius: f32) -> f32 {
    (height * height + radius * radius).sqrt()
}

/// Returns the surface area of side and base.
#[kernel]
#[inline]
pub fn area(base: Vec3, apex: Vec3, radius: f32) -> f32 {
    PI * radius * (slant((base - apex).length(), radius) + radius)
}

/// Samples a point of the side or of the base, uniformly for a uniform `u` in the unit square.
#[kernel]
#[inline]
pub fn sample(u: Vec2, base: Vec3, apex: Vec3, radius: f32) -> SurfacePoint {
    let axis = base - apex;
    let height = axis.length();
    let unit = axis / height;
    let across = at_turn(unit, u.y);
    let slant = slant(height, radius);
    let part = choose(u.x, slant / (slant + radius));
    // On the side and on the base alike, a share `r` of the radius contains the share `r²` of the
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

/// Returns the point that `ray` hits.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, base: Vec3, apex: Vec3, radius: f32) -> SurfacePoint {
    let size = (base - apex).length() + radius;
    point_on_ray(ray, hit, normal(ray, hit, base, apex, radius), size, SLACK)
}

/// Returns the smallest box around the cone, that of its base and its apex; at most two ulp too
/// large.
pub fn get_bounds(base: Vec3, apex: Vec3, radius: f32) -> Aabb {
    around_disk(base, difference(apex, base), radius).union(Aabb::new(apex, apex))
}

/// Splits the cone's box at the plane `axis = at`; returns the parts below and above.
pub fn split_primitive(axis: usize, at: f32, base: Vec3, apex: Vec3, radius: f32) -> (Aabb, Aabb) {
    get_bounds(base, apex, radius).split(axis, at)
}
