//! Area sampling.
//!
//! Shapes sample themselves: [`triangle::sample`](crate::geometry::triangle::sample()) and its like
//! return points with normals, whose density per area is 1 over the shape's `area(..)`. This module
//! has the weights of a triangle's vertices, and the conversion to solid angles.

use glam::{Vec2, Vec3, vec2};

use crate::kernel;
use crate::machine::functions::vec2;
use crate::machine::generic::clamp;

use super::rng::ONE_MINUS_EPSILON;

pub use crate::geometry::triangle::sample_weights as sample_triangle;

/// Density of [`sample_triangle()`]: all weights are equally likely, and their area is one half.
/// That of the points with these weights, per area of the triangle, is 1 over
/// [`triangle::area()`](crate::geometry::triangle::area()).
pub const TRIANGLE_PDF: f32 = 2.0;

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

/// Converts a density per area, such as `1.0 / lamp.area()`, to one per solid angle: along `way` from the lit point to the
/// surface, whose normal has unit length. Infinite where the surface is seen edge-on.
#[kernel]
#[inline]
pub fn solid_angle_pdf(per_area: f32, way: Vec3, normal: Vec3) -> f32 {
    let squared = way.dot(way);
    per_area * squared * squared.sqrt() / way.dot(normal).abs()
}
