//! Triangles, given by three vertices.

use glam::{Vec2, Vec3, vec2, vec3};

use super::edges::{across, spanned};
use super::near::largest;
use super::outwards::{around, wide};
use super::surface::rounded_point;
use super::{Aabb, Hit, Ray, SurfacePoint};
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{max, min};
use crate::math::exact::{exact_cross, lost_by_difference};
use crate::{Type, kernel, primitive};

/// Error bound of a triangle's hit, like a sphere's 16 eps: the sheared vertices carry at most 6
/// eps of the farthest coordinate, and weights, depths and distance nine roundings more.
pub const SLACK: f32 = super::sphere::SLACK;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 1;

/// 8 eps (eps = 2^-24): error of a point and of `intersect` from there, relative to the longest
/// edge. Weighted edges lose 3 eps, sheared vertices 4.
const NEARBY: f32 = 1.0 / 2_097_152.0;

/// 2^-60: products below this have rounding errors that are denormal or nearly so.
const SMALL: f32 = 1.0 / 1_152_921_504_606_846_976.0;

/// Triangle of three vertices, 36 bytes.
///
/// Vertices rather than edges are stored: neighbours share them bit for bit, as watertightness
/// requires.
#[primitive(triangle(v0, v1, v2))]
#[derive(Debug, PartialEq)]
pub struct Triangle {
    /// First vertex.
    pub v0: Vec3,
    /// Second vertex.
    pub v1: Vec3,
    /// Third vertex.
    pub v2: Vec3,
}

/// Triangle of three indices into shared vertices, as in an index buffer: 12 bytes.
///
/// The vertices are the shared data of a tree; see
/// [`Bvh::build_sharing`](crate::bvh::Bvh::build_sharing).
#[primitive]
#[derive(Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct IndexedTriangle {
    /// Indices of the vertices.
    pub vertices: [u32; 3],
}

#[primitive]
impl IndexedTriangle {
    const SLACK: f32 = SLACK;
    const IS_SHORT: bool = true;
    const MAX_CROSSINGS: u32 = MAX_CROSSINGS;

    /// Intersects `ray` with the triangle.
    #[inline]
    pub fn intersect(&self, ray: Ray, vertices: &[Vec3]) -> Hit {
        let [v0, v1, v2] = self.vertices;
        intersect(ray, vertices[v0 as usize], vertices[v1 as usize], vertices[v2 as usize])
    }

    /// Returns the unit normal where `ray` hits it; see [`normal()`].
    #[inline]
    pub fn normal(&self, ray: Ray, hit: Hit, vertices: &[Vec3]) -> Vec3 {
        let [v0, v1, v2] = self.vertices;
        normal(ray, hit, vertices[v0 as usize], vertices[v1 as usize], vertices[v2 as usize])
    }

    /// Returns the surface coordinates where `ray` hits it; see [`uv()`].
    #[inline]
    pub fn uv(&self, ray: Ray, hit: Hit, vertices: &[Vec3]) -> Vec2 {
        let [v0, v1, v2] = self.vertices;
        uv(ray, hit, vertices[v0 as usize], vertices[v1 as usize], vertices[v2 as usize])
    }

    /// Returns the point that `ray` hits; see [`surface_point()`].
    #[inline]
    pub fn surface_point(&self, ray: Ray, hit: Hit, vertices: &[Vec3]) -> SurfacePoint {
        let [v0, v1, v2] = self.vertices;
        surface_point(ray, hit, vertices[v0 as usize], vertices[v1 as usize], vertices[v2 as usize])
    }

    /// Returns whether `ray`, which hits it, enters a closed mesh there or leaves it; see
    /// [`crossing()`].
    #[inline]
    pub fn crossing(&self, ray: Ray, hit: Hit, vertices: &[Vec3]) -> i32 {
        let [v0, v1, v2] = self.vertices;
        crossing(ray, hit, vertices[v0 as usize], vertices[v1 as usize], vertices[v2 as usize])
    }

    /// Returns the area of one side.
    #[inline]
    pub fn area(&self, vertices: &[Vec3]) -> f32 {
        let [v0, v1, v2] = self.vertices;
        area(vertices[v0 as usize], vertices[v1 as usize], vertices[v2 as usize])
    }

    /// Samples a point of it; see [`sample()`].
    #[inline]
    pub fn sample(&self, u: Vec2, vertices: &[Vec3]) -> SurfacePoint {
        let [v0, v1, v2] = self.vertices;
        sample(u, vertices[v0 as usize], vertices[v1 as usize], vertices[v2 as usize])
    }

    /// Returns the bounds of its vertices; not finite if an index is out of range.
    pub fn get_bounds(&self, vertices: &[Vec3]) -> Aabb {
        self.on(vertices).map_or(Aabb::new(Vec3::NAN, Vec3::NAN), |t| t.get_bounds())
    }

    /// Splits it at a plane; returns boxes around the parts below and above.
    pub fn split_primitive(&self, axis: usize, at: f32, vertices: &[Vec3]) -> (Aabb, Aabb) {
        self.on(vertices).map_or((Aabb::EMPTY, Aabb::EMPTY), |t| t.split_primitive(axis, at))
    }
}

impl IndexedTriangle {
    /// Looks up the vertices; `None` if an index is out of range.
    pub fn on(&self, vertices: &[Vec3]) -> Option<Triangle> {
        let [v0, v1, v2] = self.vertices.map(|i| vertices.get(i as usize).copied());
        Some(Triangle { v0: v0?, v1: v1?, v2: v2? })
    }
}

/// Swaps the components along the axis `k` (0, 1 or 2) and z: two selections fewer than a rotation,
/// which keeps all signs or flips them all.
#[kernel]
#[inline]
pub(crate) fn axis_last(v: Vec3, k: u32) -> Vec3 {
    let x = if k == 0 { v.z } else { v.x };
    let y = if k == 1 { v.z } else { v.y };
    let z = if k == 0 {
        v.x
    } else if k == 1 {
        v.y
    } else {
        v.z
    };
    vec3(x, y, z)
}

/// Returns whether three points whose edges have a rounded cross product of 0 are exactly
/// collinear. Where the edges themselves are rounded, nothing is known and the result is false.
#[kernel]
#[inline]
fn is_line(v0: Vec3, v1: Vec3, v2: Vec3) -> bool {
    let lost = lost_by_difference(v1, v0).abs() + lost_by_difference(v2, v0).abs();
    let lost = lost + exact_cross(v1 - v0, v2 - v0).abs();
    lost.x + lost.y + lost.z == 0.0
}

/// Returns whether a ray passes on one side of all edges, or through one.
#[kernel]
#[inline]
fn is_inside(sides: Vec3) -> bool {
    let least = min(min(sides.x, sides.y), sides.z);
    let greatest = max(max(sides.x, sides.y), sides.z);
    least >= 0.0 || greatest <= 0.0
}

/// Vertices as a ray sees them: relative to its origin, with it along the last axis.
#[derive(Clone, Copy, Debug, Type)]
struct Sheared {
    a: Vec3,
    b: Vec3,
    c: Vec3,
    /// The direction, with the axes swapped alike.
    d: Vec3,
    /// The axis along which the ray runs fastest, swapped with z.
    k: u32,
}

/// Returns the vertices as [`intersect`] sees them, bit for bit.
#[kernel]
#[inline]
fn sheared(ray: Ray, v0: Vec3, v1: Vec3, v2: Vec3) -> Sheared {
    // Make the axis along which the ray runs fastest z.
    let ax = ray.direction.x.abs();
    let ay = ray.direction.y.abs();
    let az = ray.direction.z.abs();
    let k = if ax > ay && ax > az {
        0u32
    } else if ay > az {
        1u32
    } else {
        2u32
    };
    let d = axis_last(ray.direction, k);
    let a = axis_last(v0 - ray.origin, k);
    let b = axis_last(v1 - ray.origin, k);
    let c = axis_last(v2 - ray.origin, k);
    // Shear the ray onto the z axis.
    let sx = d.x / d.z;
    let sy = d.y / d.z;
    Sheared {
        a: vec3(a.x - sx * a.z, a.y - sy * a.z, a.z),
        b: vec3(b.x - sx * b.z, b.y - sy * b.z, b.z),
        c: vec3(c.x - sx * c.z, c.y - sy * c.z, c.z),
        d,
        k,
    }
}

/// Intersects a ray with the triangle: both sides, edges and vertices included. A triangle with
/// collinear vertices is never hit.
///
/// The point at `t` lies on the triangle, to within [`SLACK`] of the farthest coordinate, even for
/// rays along its plane. So it lies in the box of one of the parts into which [`split_primitive`]
/// cuts the triangle, as trees with spatial splits require.
///
/// The watertight test of Woop, Benthin and Wald ("Watertight Ray/Triangle Intersection", JCGT
/// 2013), divided by the determinant before scaling, so that it holds for coordinates from 1e-18 to
/// 1e18 and directions of any usual length.
// Optimised code of the host has it in the loop over a leaf. `#[kernel]` does not read `cfg_attr`, so
// packets call it as before: in place, wide trees are slower.
#[kernel]
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn intersect(ray: Ray, v0: Vec3, v1: Vec3, v2: Vec3) -> Hit {
    // Make the axis along which the ray runs fastest z.
    let ax = ray.direction.x.abs();
    let ay = ray.direction.y.abs();
    let az = ray.direction.z.abs();
    let k = if ax > ay && ax > az {
        0u32
    } else if ay > az {
        1u32
    } else {
        2u32
    };
    let d = axis_last(ray.direction, k);
    let a = axis_last(v0 - ray.origin, k);
    let b = axis_last(v1 - ray.origin, k);
    let c = axis_last(v2 - ray.origin, k);
    // Shear the ray onto the z axis.
    let sx = d.x / d.z;
    let sy = d.y / d.z;
    let a_x = a.x - sx * a.z;
    let a_y = a.y - sy * a.z;
    let b_x = b.x - sx * b.z;
    let b_y = b.y - sy * b.z;
    let c_x = c.x - sx * c.z;
    let c_y = c.y - sy * c.z;
    // Test the side of each edge on which the ray passes. Rounding keeps the order of two products
    // or makes them equal, so a sign is right or zero, and zero counts as inside.
    let xs = vec3(a_x, b_x, c_x);
    let ys = vec3(a_y, b_y, c_y);
    let mut sides = ys.cross(xs);
    if !is_inside(sides) {
        return Hit::miss();
    }
    // Edge-on the signs are those of rounding errors: the ray must pass between the vertices all
    // the same.
    let left = min(min(a_x, b_x), c_x);
    let right = max(max(a_x, b_x), c_x);
    let low = min(min(a_y, b_y), c_y);
    let high = max(max(a_y, b_y), c_y);
    let between = left <= 0.0 && right >= 0.0 && low <= 0.0 && high >= 0.0;
    if !between {
        return Hit::miss();
    }
    let mut sum = sides.x + sides.y + sides.z;
    // A product loses eps of its size, and where products cancel, that may affect the depth more
    // than the vertices do: in a thin triangle with the ray in its plane. Then use exact products.
    // Signs stay right or zero, so no ray passes between a triangle with these signs and one with
    // those above; a sum of 0 alone would say nothing.
    let near = min(min(a.z, b.z), c.z);
    let far = max(max(a.z, b.z), c.z);
    let products = (c_x * b_y).abs() + (a_x * c_y).abs() + (b_x * a_y).abs();
    if 2.0 * sum.abs() <= products * ((far - near) / max(near.abs(), far.abs())) {
        // Exact; scale products whose own rounding errors would underflow.
        let scale = if products < SMALL { 1.0 / SMALL } else { 1.0 };
        sides = exact_cross(ys * scale, xs * scale);
        sum = if is_inside(sides) { sides.x + sides.y + sides.z } else { 0.0 };
    }
    if sum == 0.0 {
        return Hit::miss();
    }
    let (u, v, w) = (sides.x / sum, sides.y / sum, sides.z / sum);
    // Interpolate the vertices' depths to a distance.
    let t = (u * a.z + v * b.z + w * c.z) * (1.0 / d.z);
    // Collinear vertices have no inside: the signs are those of rounding errors. The area of a
    // sliver may be rounded to 0, but it must close its gap all the same.
    let n = (v1 - v0).cross(v2 - v0);
    let is_flat = n.x == 0.0 && n.y == 0.0 && n.z == 0.0;
    let is_surface = !(is_flat && is_line(v0, v1, v2));
    let is_hit = is_surface && t >= ray.t_min && t <= ray.t_max;
    Hit { u: v, v: w, ..Hit::new(is_hit, t) }
}

/// Returns the side of an edge on which a ray beside the sheared one passes: the ray is displaced by
/// less than any number, by still less along the second axis. Never 0 for two different points.
#[kernel]
#[inline]
fn side_beside(side: f32, from: Vec2, to: Vec2) -> f32 {
    let across = to.y - from.y;
    let tie = if across == 0.0 { from.x - to.x } else { across };
    if side == 0.0 { tie } else { side }
}

/// Returns 1 where a ray goes from the outside of a closed mesh to its inside, -1 where it goes the
/// other way, and 0 where it only touches the triangle: of all triangles around an edge or a vertex
/// that a ray passes through, those count that a ray beside it would hit, so that each crossing of
/// the mesh counts once. The outside is where the vertices run anticlockwise. `ray` hits the
/// triangle.
///
/// (Edelsbrunner and Mücke, "Simulation of Simplicity", ACM Transactions on Graphics 1990.)
#[kernel]
#[inline(never)]
pub fn crossing(ray: Ray, _hit: Hit, v0: Vec3, v1: Vec3, v2: Vec3) -> i32 {
    let Sheared { a, b, c, d, k } = sheared(ray, v0, v1, v2);
    let products = (c.x * b.y).abs() + (a.x * c.y).abs() + (b.x * a.y).abs();
    let scale = if products < SMALL { 1.0 / SMALL } else { 1.0 };
    let sides = exact_cross(vec3(a.y, b.y, c.y) * scale, vec3(a.x, b.x, c.x) * scale);
    let of_a = side_beside(sides.x, vec2(b.x, b.y), vec2(c.x, c.y));
    let of_b = side_beside(sides.y, vec2(c.x, c.y), vec2(a.x, a.y));
    let of_c = side_beside(sides.z, vec2(a.x, a.y), vec2(b.x, b.y));
    let enters = of_a > 0.0 && of_b > 0.0 && of_c > 0.0;
    let leaves = of_a < 0.0 && of_b < 0.0 && of_c < 0.0;
    let side = if enters {
        1
    } else if leaves {
        -1
    } else {
        0
    };
    // Swapping two axes turns the triangle over, and so does looking along -z.
    let is_turned = (k != 2) != (d.z < 0.0);
    if is_turned { -side } else { side }
}

/// Returns the unit normal on the side from which the vertices run anticlockwise, whichever side
/// `ray` hits.
#[kernel]
#[inline]
pub fn normal(_ray: Ray, _hit: Hit, v0: Vec3, v1: Vec3, v2: Vec3) -> Vec3 {
    across(v1 - v0, v2 - v0)
}

/// Returns the barycentric weights of the second and the third vertex.
#[kernel]
#[inline]
pub fn uv(_ray: Ray, hit: Hit, _v0: Vec3, _v1: Vec3, _v2: Vec3) -> Vec2 {
    vec2(hit.u, hit.v)
}

/// Returns the area of one side.
#[kernel]
#[inline]
pub fn area(v0: Vec3, v1: Vec3, v2: Vec3) -> f32 {
    0.5 * spanned(v1 - v0, v2 - v0)
}

/// Samples a point of the triangle, uniformly for a uniform `u` in the unit square. (Heitz, "A
/// Low-Distortion Map Between Triangle and Square", 2019.)
#[kernel]
#[inline]
pub fn sample(u: Vec2, v0: Vec3, v1: Vec3, v2: Vec3) -> SurfacePoint {
    let weights = sample_weights(u);
    weighted(weights.x, weights.y, v0, v1, v2)
}

/// Samples the barycentric weights of the second and the third vertex of such a point.
#[kernel]
#[inline]
pub fn sample_weights(u: Vec2) -> Vec2 {
    let is_low = u.y < u.x;
    let least = 0.5 * if is_low { u.y } else { u.x };
    let b1 = if is_low { u.x - least } else { least };
    let b2 = if is_low { least } else { u.y - least };
    vec2(b1, b2)
}

/// Returns the point that `ray` hits, from its barycentric weights.
///
/// Its error does not grow with the distance from the ray's origin. In all, the origin of a ray
/// from here is moved by at most 4 ulp of the position and 8 eps of the longest edge (eps = 2^-24).
#[kernel]
#[inline]
pub fn surface_point(_ray: Ray, hit: Hit, v0: Vec3, v1: Vec3, v2: Vec3) -> SurfacePoint {
    weighted(hit.u, hit.v, v0, v1, v2)
}

/// Returns the point with the weights `b1` and `b2` of the second and the third vertex. The edges
/// are summed first, so that their sum is added to the larger world coordinates once.
#[kernel]
#[inline]
pub(crate) fn weighted(b1: f32, b2: f32, v0: Vec3, v1: Vec3, v2: Vec3) -> SurfacePoint {
    let (e1, e2) = (v1 - v0, v2 - v0);
    let size = max(max(largest(e1), largest(e2)), largest(e2 - e1));
    rounded_point(v0 + (e1 * b1 + e2 * b2), across(e1, e2), size * NEARBY)
}

/// Returns the bounds of the vertices.
pub fn get_bounds(v0: Vec3, v1: Vec3, v2: Vec3) -> Aabb {
    Aabb::from_points([v0, v1, v2])
}

/// Splits the triangle at the plane `axis = at`; returns boxes around the parts below and above.
/// The crossings of edges with the plane are computed in `f64` and rounded outwards.
pub fn split_primitive(axis: usize, at: f32, v0: Vec3, v1: Vec3, v2: Vec3) -> (Aabb, Aabb) {
    split_polygon(axis, at, get_bounds(v0, v1, v2), &[v0, v1, v2].map(wide), 0.0)
}

/// Splits any flat polygon in the box `whole`, with vertices that may be off by `error`, as
/// [`split_primitive`] does.
pub(super) fn split_polygon(
    axis: usize,
    at: f32,
    whole: Aabb,
    vertices: &[[f64; 3]],
    error: f64,
) -> (Aabb, Aabb) {
    let (mut below, mut above) = (Aabb::EMPTY, Aabb::EMPTY);
    let plane = f64::from(at);
    for (i, &a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        if a[axis] - error <= plane {
            below = below.union(around(a, error));
        }
        if a[axis] + error >= plane {
            above = above.union(around(a, error));
        }
        if (a[axis] < plane && b[axis] > plane) || (a[axis] > plane && b[axis] < plane) {
            let crossing = on_edge(axis, at, a, b, error);
            below = below.union(crossing);
            above = above.union(crossing);
        }
    }
    // Clip parts that the error has moved across the plane.
    (whole.split(axis, at).0.intersection(below), whole.split(axis, at).1.intersection(above))
}

/// Returns a box around the intersection of the edge with the plane.
fn on_edge(axis: usize, at: f32, a: [f64; 3], b: [f64; 3], error: f64) -> Aabb {
    let s = (f64::from(at) - a[axis]) / (b[axis] - a[axis]);
    let bounds = |sign: f64, step: fn(f32) -> f32| {
        let mut bound = core::array::from_fn(|i| {
            // Error bound of `f64`; next to 0 more than an ulp of `f32`.
            let error = error + (a[i].abs() + b[i].abs()) * f64::EPSILON * 4.0;
            step((a[i] + (b[i] - a[i]) * s + sign * error) as f32)
        });
        bound[axis] = at;
        Vec3::from_array(bound)
    };
    Aabb::new(bounds(-1.0, f32::next_down), bounds(1.0, f32::next_up))
}
