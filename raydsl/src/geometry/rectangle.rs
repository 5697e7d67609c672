//! Rectangles and all other parallelograms, given by a corner and the two edges from it, which may
//! meet at any angle.

use glam::{Vec2, Vec3, vec2, vec3};

use super::edges::{across, spanned};
use super::near::largest;
use super::outwards::{around, sum, wide};
use super::surface::rounded_point;
use super::{Aabb, Hit, Ray, SurfacePoint, quad, triangle};
use crate::kernel;
use crate::machine::functions::{vec2, vec3};

/// Error bound of a rectangle's hit: a quad's, and two more roundings of each corner, within twice
/// a quad's.
pub const SLACK: f32 = 2.0 * quad::SLACK;

/// Maximum number of crossings of a ray; see
/// [`Primitive::MAX_CROSSINGS`](super::Primitive::MAX_CROSSINGS).
pub const MAX_CROSSINGS: u32 = 1;

/// Intersects a ray with the parallelogram: both sides, edges and corners included. `hit.u` runs
/// along `u_edge` and `hit.v` along `v_edge`.
///
/// It is a quad whose corners are summed relative to the ray's origin, so their error is relative
/// to the size of the rectangle and its distance, wherever in the world it is.
#[kernel]
#[inline]
pub fn intersect(ray: Ray, corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> Hit {
    let v0 = corner - ray.origin;
    let (v1, v3) = (v0 + u_edge, v0 + v_edge);
    let from_origin = Ray { origin: vec3(0.0, 0.0, 0.0), ..ray };
    quad::intersect(from_origin, v0, v1, v1 + v_edge, v3)
}

/// Returns the unit normal of `u_edge × v_edge`, whichever side `ray` hits.
#[kernel]
#[inline]
pub fn normal(_ray: Ray, _hit: Hit, _corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> Vec3 {
    across(u_edge, v_edge)
}

/// Returns the coordinates of the hit along the two edges, as shares.
#[kernel]
#[inline]
pub fn uv(_ray: Ray, hit: Hit, _corner: Vec3, _u_edge: Vec3, _v_edge: Vec3) -> Vec2 {
    vec2(hit.u, hit.v)
}

/// Returns the area of one side.
#[kernel]
#[inline]
pub fn area(_corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> f32 {
    spanned(u_edge, v_edge)
}

/// Samples the point at the shares `u` of the edges, uniformly for a uniform `u` in the unit
/// square.
#[kernel]
#[inline]
pub fn sample(u: Vec2, corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> SurfacePoint {
    at_shares(u.x, u.y, corner, u_edge, v_edge)
}

/// Returns the point that `ray` hits, from the shares of the edges.
#[kernel]
#[inline]
pub fn surface_point(
    _ray: Ray,
    hit: Hit,
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
) -> SurfacePoint {
    at_shares(hit.u, hit.v, corner, u_edge, v_edge)
}

/// Returns the point at these shares of the edges.
#[kernel]
#[inline]
fn at_shares(u: f32, v: f32, corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> SurfacePoint {
    let own_error = (largest(u_edge) + largest(v_edge)) * SLACK;
    rounded_point(corner + u_edge * u + v_edge * v, across(u_edge, v_edge), own_error)
}

/// Returns the four corners in order, and an error bound of each coordinate: 0, unless the corner
/// and the edges differ so much in size that `f64` cannot hold their sum.
fn corners(corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> ([[f64; 3]; 4], f64) {
    let (corner, u, v) = (wide(corner), wide(u_edge), wide(v_edge));
    let mut worst = 0.0_f64;
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| {
        core::array::from_fn(|i| {
            let (along_u, first) = sum(corner[i], a * u[i]);
            let (at, second) = sum(along_u, b * v[i]);
            worst = worst.max(first + second);
            at
        })
    });
    (corners, worst)
}

/// Returns the smallest box around the rectangle, at most two ulp too large.
pub fn get_bounds(corner: Vec3, u_edge: Vec3, v_edge: Vec3) -> Aabb {
    let (corners, error) = corners(corner, u_edge, v_edge);
    corners.into_iter().map(|c| around(c, error)).fold(Aabb::EMPTY, Aabb::union)
}

/// Splits the rectangle at the plane `axis = at`; returns boxes around the parts below and above.
/// The crossings of edges with the plane are computed in `f64` and rounded outwards.
pub fn split_primitive(
    axis: usize,
    at: f32,
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
) -> (Aabb, Aabb) {
    let whole = get_bounds(corner, u_edge, v_edge);
    let (corners, error) = corners(corner, u_edge, v_edge);
    triangle::split_polygon(axis, at, whole, &corners, error)
}
