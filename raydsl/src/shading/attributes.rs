//! What the attributes of a triangle's vertices say of a point between them.

#![allow(dead_code, reason = "a mesh calls the lifted forms alone")]

use glam::{Vec2, Vec3, Vec4, vec4};

use crate::geometry::{Hit, IndexedTriangle};
use crate::kernel;
use crate::machine::functions::vec4;
use crate::machine::generic::max;

/// Returns a unit vector, or `other` where `v` has no direction.
#[kernel]
pub(super) fn direction_or(v: Vec3, other: Vec3) -> Vec3 {
    // Squares of the components could leave the range of `f32`.
    let size = max(max(v.x.abs(), v.y.abs()), v.z.abs());
    let scaled = v / size;
    if size > 0.0 && size < f32::INFINITY { scaled / scaled.length() } else { other }
}

/// Returns the normal between those of a triangle's vertices, on the side of the geometric one.
#[kernel]
pub(super) fn smooth_normal(
    triangle: IndexedTriangle,
    normals: &[Vec3],
    geometric: Vec3,
    hit: Hit,
) -> Vec3 {
    let [a, b, c] = triangle.vertices;
    let rest = 1.0 - hit.u - hit.v;
    let sum =
        normals[a as usize] * rest + normals[b as usize] * hit.u + normals[c as usize] * hit.v;
    let smooth = direction_or(sum, geometric);
    if smooth.dot(geometric) < 0.0 { -smooth } else { smooth }
}

/// Returns the surface coordinates between those of a triangle's vertices.
#[kernel]
pub(super) fn uv_between(triangle: IndexedTriangle, uvs: &[Vec2], hit: Hit) -> Vec2 {
    let [a, b, c] = triangle.vertices;
    let rest = 1.0 - hit.u - hit.v;
    uvs[a as usize] * rest + uvs[b as usize] * hit.u + uvs[c as usize] * hit.v
}

/// Returns the tangent between those of a triangle's vertices.
#[kernel]
pub(super) fn tangent_between(triangle: IndexedTriangle, tangents: &[Vec4], hit: Hit) -> Vec4 {
    let [a, b, c] = triangle.vertices;
    let rest = 1.0 - hit.u - hit.v;
    // The sign is the same at all vertices of a triangle.
    let first = tangents[a as usize];
    let sum = first * rest + tangents[b as usize] * hit.u + tangents[c as usize] * hit.v;
    vec4(sum.x, sum.y, sum.z, first.w)
}

/// Returns the direction in which the first surface coordinate grows.
#[kernel]
pub(super) fn tangent_of_uvs(triangle: IndexedTriangle, vertices: &[Vec3], uvs: &[Vec2]) -> Vec4 {
    let [a, b, c] = triangle.vertices;
    let (u1, u2) = (uvs[b as usize] - uvs[a as usize], uvs[c as usize] - uvs[a as usize]);
    let e1 = vertices[b as usize] - vertices[a as usize];
    let e2 = vertices[c as usize] - vertices[a as usize];
    let sign = if u1.x * u2.y - u1.y * u2.x < 0.0 { -1.0 } else { 1.0 };
    let along = (e1 * u2.y - e2 * u1.y) * sign;
    vec4(along.x, along.y, along.z, sign)
}

/// Returns the colour between those of a triangle's vertices.
#[kernel]
pub(super) fn color_between(triangle: IndexedTriangle, colors: &[Vec3], hit: Hit) -> Vec3 {
    let [a, b, c] = triangle.vertices;
    let rest = 1.0 - hit.u - hit.v;
    colors[a as usize] * rest + colors[b as usize] * hit.u + colors[c as usize] * hit.v
}
