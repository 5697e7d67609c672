//! Axis-aligned boxes, given by their lower and upper corners.

use glam::{Vec2, Vec3, vec2, vec3};

use super::near::{Near, Span, both, end_of, is_at_end, largest, slab};
use super::surface::{point_on_ray, rounded_point};
use super::{Aabb, Hit, Ray, SurfacePoint};
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::clamp;
use crate::{Type, kernel};

/// Error bound of a box's hit: the distance to each face takes four roundings, at most 4 eps of it.
pub const SLACK: f32 = 1.0 / 2_097_152.0;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 2;

/// Intersection of a ray's line with a box.
#[derive(Clone, Copy, Debug, Type)]
struct Meeting {
    line: Near,
    x: Span,
    y: Span,
    z: Span,
    inside: Span,
}

#[kernel]
#[inline]
fn meet(ray: Ray, min: Vec3, max: Vec3) -> Meeting {
    let scale = largest(ray.direction);
    let direction = ray.direction / scale;
    let line = Near { direction, offset: vec3(0.0, 0.0, 0.0), distance: 0.0, scale };
    let (low, high) = (min - ray.origin, max - ray.origin);
    let x = slab(0.0, direction.x, low.x, high.x);
    let y = slab(0.0, direction.y, low.y, high.y);
    let z = slab(0.0, direction.z, low.z, high.z);
    Meeting { line, x, y, z, inside: both(both(x, y), z) }
}

/// Intersects a ray with the box: at the entry or, from inside, at the exit.
///
/// A flat box is hit like a rectangle. A box with `min > max` on an axis is never hit.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, min: Vec3, max: Vec3) -> Hit {
    let m = meet(ray, min, max);
    end_of(ray, m.line, m.inside)
}

/// Returns the axis perpendicular to the face through which the ray enters or leaves.
#[kernel]
#[inline]
fn face(m: Meeting, is_leaving: bool) -> u32 {
    let (end, x, y) = if is_leaving {
        (m.inside.leave, m.x.leave, m.y.leave)
    } else {
        (m.inside.enter, m.x.enter, m.y.enter)
    };
    if x == end {
        0u32
    } else if y == end {
        1u32
    } else {
        2u32
    }
}

/// Returns the outward normal of the face that `ray` hits.
#[kernel]
#[inline]
pub fn normal(ray: Ray, hit: Hit, min: Vec3, max: Vec3) -> Vec3 {
    let m = meet(ray, min, max);
    let is_leaving = is_at_end(hit, m.line, m.inside);
    let face = face(m, is_leaving);
    let d = m.line.direction;
    let along = if face == 0 {
        d.x
    } else if face == 1 {
        d.y
    } else {
        d.z
    };
    let sign = if (along > 0.0) == is_leaving { 1.0 } else { -1.0 };
    if face == 0 {
        vec3(sign, 0.0, 0.0)
    } else if face == 1 {
        vec3(0.0, sign, 0.0)
    } else {
        vec3(0.0, 0.0, sign)
    }
}

/// Returns `x` as a share of the length `size`.
#[kernel]
#[inline]
fn share(x: f32, size: f32) -> f32 {
    if size > 0.0 { clamp(x / size, 0.0, 1.0) } else { 0.0 }
}

/// Returns the coordinates of the hit in its face, from 0 at `min` to 1 at `max`: along y and z in
/// a face across x, along z and x in one across y, along x and y in one across z.
#[kernel]
#[inline]
pub fn uv(ray: Ray, hit: Hit, min: Vec3, max: Vec3) -> Vec2 {
    let m = meet(ray, min, max);
    let is_leaving = is_at_end(hit, m.line, m.inside);
    let s = if is_leaving { m.inside.leave } else { m.inside.enter };
    let at = m.line.direction * s - (min - ray.origin);
    let size = max - min;
    let (x, y, z) = (share(at.x, size.x), share(at.y, size.y), share(at.z, size.z));
    let face = face(m, is_leaving);
    if face == 0 {
        vec2(y, z)
    } else if face == 1 {
        vec2(z, x)
    } else {
        vec2(x, y)
    }
}

/// Returns the surface area of the six faces.
#[kernel]
#[inline]
pub fn area(min: Vec3, max: Vec3) -> f32 {
    let size = max - min;
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
}

/// Samples a point of a face, uniformly for a uniform `u` in the unit square.
#[kernel]
#[inline]
pub fn sample(u: Vec2, min: Vec3, max: Vec3) -> SurfacePoint {
    let size = max - min;
    // Areas of the pairs of faces, halved.
    let (of_x, of_y, of_z) = (size.y * size.z, size.z * size.x, size.x * size.y);
    let at = u.x * (of_x + of_y + of_z);
    let is_x = at < of_x;
    let is_y = !is_x && at < of_x + of_y;
    let in_pair = if is_x {
        at / of_x
    } else if is_y {
        (at - of_x) / of_y
    } else {
        (at - of_x - of_y) / of_z
    };
    let is_upper = in_pair >= 0.5;
    let v = clamp(if is_upper { 2.0 * in_pair - 1.0 } else { 2.0 * in_pair }, 0.0, 1.0);
    let own_error = largest(size) * SLACK;
    let (end, sign) = if is_upper { (1.0, 1.0) } else { (0.0, -1.0) };
    if is_x {
        rounded_point(min + size * vec3(end, u.y, v), vec3(sign, 0.0, 0.0), own_error)
    } else if is_y {
        rounded_point(min + size * vec3(v, end, u.y), vec3(0.0, sign, 0.0), own_error)
    } else {
        rounded_point(min + size * vec3(u.y, v, end), vec3(0.0, 0.0, sign), own_error)
    }
}

/// Returns the point that `ray` hits.
#[kernel]
#[inline]
pub fn surface_point(ray: Ray, hit: Hit, min: Vec3, max: Vec3) -> SurfacePoint {
    point_on_ray(ray, hit, normal(ray, hit, min, max), largest(max - min), SLACK)
}

/// Returns the box itself.
pub fn get_bounds(min: Vec3, max: Vec3) -> Aabb {
    Aabb::new(min, max)
}

/// Splits the box exactly at the plane `axis = at`; returns the parts below and above.
pub fn split_primitive(axis: usize, at: f32, min: Vec3, max: Vec3) -> (Aabb, Aabb) {
    get_bounds(min, max).split(axis, at)
}
