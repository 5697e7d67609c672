//! The mesh as a ray sees it: coordinates across the ray, and on which side of an edge it passes.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::geometry::Ray;
use crate::geometry::triangle::axis_last;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{clamp, max, min};
use crate::math::exact::exact_cross;
use crate::{Type, kernel};

/// 2^-60: products below this have rounding errors that are denormal or nearly so.
const SMALL: f32 = 1.0 / 1_152_921_504_606_846_976.0;

/// Coordinates in which a ray is the last axis: two across it, in world units along two axes of the
/// world, and the distance along it. They are right-handed for every ray.
///
/// A vertex has the same coordinates for all faces that share it, bit for bit. (Woop, Benthin and
/// Wald, "Watertight Ray/Triangle Intersection", JCGT 2013.)
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct RayFrame {
    origin: Vec3,
    /// Displacement across the ray per step along its fastest axis.
    shear: Vec2,
    /// Distance along the ray per step along that axis.
    per_step: f32,
    /// 1, or -1 to keep the coordinates right-handed.
    hand: f32,
    /// The axis along which the ray runs fastest, swapped with z.
    axis: u32,
}

#[kernel]
impl RayFrame {
    #[inline]
    pub(super) fn new(ray: Ray) -> RayFrame {
        let d = ray.direction;
        let (ax, ay, az) = (d.x.abs(), d.y.abs(), d.z.abs());
        let axis = if ax > ay && ax > az {
            0u32
        } else if ay > az {
            1u32
        } else {
            2u32
        };
        let d = axis_last(d, axis);
        // Swapping two axes turns triangles over, and so does looking along -z.
        let is_turned = (axis != 2) != (d.z < 0.0);
        RayFrame {
            origin: ray.origin,
            shear: vec2(d.x / d.z, d.y / d.z),
            per_step: 1.0 / d.z,
            hand: if is_turned { -1.0 } else { 1.0 },
            axis,
        }
    }

    /// Returns a point in these coordinates.
    #[inline]
    pub(super) fn seen(&self, point: Vec3) -> Vec3 {
        let p = axis_last(point - self.origin, self.axis);
        let x = (p.x - self.shear.x * p.z) * self.hand;
        vec3(x, p.y - self.shear.y * p.z, p.z * self.per_step)
    }
}

/// Returns whether the ray passes on the left of the edge from `a` to `b`: on exactly one of the
/// two sides, the other for the edge from `b` to `a`, whatever face the edge is of.
///
/// The sign is that of the exact cross product. A rounded product is not smaller than another one
/// that is smaller, so only equal ones are computed exactly. Where those are equal too, a ray
/// decides that is displaced by less than any number, and by still less along the second axis: it
/// meets no edge and no vertex. (Edelsbrunner and Mücke, "Simulation of Simplicity", ACM
/// Transactions on Graphics 1990.)
#[kernel]
#[inline]
pub(super) fn is_left(a: Vec3, b: Vec3) -> bool {
    let (p, q) = (a.x * b.y, a.y * b.x);
    let mut is_left = p > q;
    if p == q {
        is_left = is_left_beside(a, b);
    }
    is_left
}

/// Returns the same where both rounded products are equal.
#[kernel]
#[inline(never)]
fn is_left_beside(a: Vec3, b: Vec3) -> bool {
    // Scale products whose own rounding errors would underflow.
    let scale = if (a.x * b.y).abs() < SMALL { 1.0 / SMALL } else { 1.0 };
    let (from, to) = (vec3(a.x * scale, a.y * scale, 0.0), vec3(b.x * scale, b.y * scale, 0.0));
    let side = exact_cross(from, to).z;
    let is_tie_left = if a.y == b.y { a.x > b.x } else { b.y > a.y };
    if side == 0.0 { is_tie_left } else { side > 0.0 }
}

/// A vertex as a ray sees it, with what interpolation needs.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Corner {
    /// Coordinates of the frame.
    pub(super) at: Vec3,
    pub(super) value: f32,
    /// Index among the mesh's points.
    pub(super) index: u32,
}

/// Where a ray passes through a face.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Pierced {
    /// Distance along the ray.
    pub(super) t: f32,
    /// The linear interpolant there.
    pub(super) value: f32,
}

/// Returns twice the areas that a ray makes with the edges opposite of each vertex.
///
/// A rounded product loses eps of its size; in a face seen almost from its edge that moves the
/// point off the ray by many times as much. There products are exact.
#[kernel]
#[inline]
fn areas(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let (xs, ys) = (vec3(a.x, b.x, c.x), vec3(a.y, b.y, c.y));
    let mut areas = xs.cross(ys);
    let products = (b.x * c.y).abs() + (c.x * a.y).abs() + (a.x * b.y).abs();
    if (areas.x + areas.y + areas.z) * 16.0 < products {
        let scale = if products < SMALL { 1.0 / SMALL } else { 1.0 };
        areas = exact_cross(xs * scale, ys * scale);
    }
    // They are negative by rounding alone.
    areas.max(vec3(0.0, 0.0, 0.0))
}

/// Returns where the ray passes through the face, on whose inner side of all edges it is; within
/// what its vertices have, whatever rounding does.
#[kernel]
#[inline]
pub(super) fn pierced(a: Corner, b: Corner, c: Corner) -> Pierced {
    let areas = areas(a.at, b.at, c.at);
    let sum = areas.x + areas.y + areas.z;
    // A face along the ray, of no area but for rounding, is passed in its middle.
    let has_area = sum > 0.0;
    let third = vec3(1.0, 1.0, 1.0) / 3.0;
    let weights = if has_area { areas / sum } else { third };
    let depths = vec3(a.at.z, b.at.z, c.at.z);
    let values = vec3(a.value, b.value, c.value);
    let near = min(min(depths.x, depths.y), depths.z);
    let far = max(max(depths.x, depths.y), depths.z);
    let least = min(min(values.x, values.y), values.z);
    let most = max(max(values.x, values.y), values.z);
    Pierced {
        t: clamp(weights.dot(depths), near, far),
        value: clamp(weights.dot(values), least, most),
    }
}
