//! Area sampling of triangles and quads.
//!
//! Shapes sample themselves: [`triangle::sample`](crate::geometry::triangle::sample()) and its like
//! return points with normals. This module has their inverses and densities.

use glam::{Vec2, Vec3, vec2};

use crate::geometry::{quad, triangle};
use crate::kernel;
use crate::machine::functions::vec2;
use crate::machine::generic::clamp;

use super::rng::ONE_MINUS_EPSILON;

pub use crate::geometry::triangle::sample_weights as sample_triangle;

/// Inverts [`sample_triangle()`]: returns the point of the unit square with these weights of the
/// second and the third vertex.
#[kernel]
#[inline]
pub fn invert_triangle(weights: Vec2) -> Vec2 {
    let sum = weights.x + weights.y;
    let is_low = weights.y < weights.x;
    let u = if is_low { vec2(sum, 2.0 * weights.y) } else { vec2(2.0 * weights.x, sum) };
    clamp(u, vec2(0.0, 0.0), vec2(ONE_MINUS_EPSILON, ONE_MINUS_EPSILON))
}

/// Returns the density of [`triangle::sample()`](crate::geometry::triangle::sample()), per area.
#[kernel]
#[inline]
pub fn triangle_pdf(v0: Vec3, v1: Vec3, v2: Vec3) -> f32 {
    1.0 / triangle::area(v0, v1, v2)
}

/// Returns the density of [`quad::sample()`](crate::geometry::quad::sample()), per area; the quad
/// may be bent.
#[kernel]
#[inline]
pub fn quad_pdf(v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3) -> f32 {
    1.0 / quad::area(v0, v1, v2, v3)
}

/// Converts a density per area to one per solid angle: along `way` from the lit point to the
/// surface, whose normal has unit length. Infinite where the surface is seen edge-on.
#[kernel]
#[inline]
pub fn solid_angle_pdf(per_area: f32, way: Vec3, normal: Vec3) -> f32 {
    let squared = way.dot(way);
    per_area * squared * squared.sqrt() / way.dot(normal).abs()
}
