//! Vectors of `f64`, in which differences of `f32` are exact or nearly so.

use raydsl::prelude::{Ray, Triangle, Vec3};

/// Three coordinates.
pub type D3 = [f64; 3];

/// The same numbers.
pub fn wide(v: Vec3) -> D3 {
    v.to_array().map(f64::from)
}

/// `a - b`.
pub fn minus(a: D3, b: D3) -> D3 {
    std::array::from_fn(|i| a[i] - b[i])
}

/// `a + b * s`.
pub fn plus(a: D3, b: D3, s: f64) -> D3 {
    std::array::from_fn(|i| a[i] + b[i] * s)
}

/// The dot product.
pub fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub fn cross(a: D3, b: D3) -> D3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Whether the ray meets the triangle in front of its origin, or within a millionth of its edges.
/// (Möller and Trumbore, 1997.)
pub fn meets_triangle(ray: &Ray, triangle: &Triangle) -> bool {
    let (a, d) = (wide(triangle.v0), wide(ray.direction));
    let (e1, e2) = (minus(wide(triangle.v1), a), minus(wide(triangle.v2), a));
    let across = cross(d, e2);
    let det = dot(e1, across);
    let from_a = minus(wide(ray.origin), a);
    let u = dot(from_a, across) / det;
    let q = cross(from_a, e1);
    let (v, t) = (dot(d, q) / det, dot(e2, q) / det);
    u >= -1e-6 && v >= -1e-6 && u + v <= 1.0 + 1e-6 && t >= 0.0
}
