//! Sums rounded outwards, for conservative boxes.

use glam::Vec3;

use super::Aabb;

/// Returns `a + b` and a bound of its error: 0 if it is exact.
pub(super) fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    // Subtracting the larger one is exact, so this tests the sum (Dekker, 1971).
    let is_exact = sum - a == b && sum - b == a;
    (sum, if is_exact { 0.0 } else { sum.abs() * f64::EPSILON })
}

/// Returns the largest `f32` that is at most `a + b`, or the one below it.
pub(super) fn below(a: f64, b: f64) -> f32 {
    let (sum, error) = sum(a, b);
    let bound = sum - error;
    let rounded = bound as f32;
    if f64::from(rounded) > bound { rounded.next_down() } else { rounded }
}

/// Returns the least `f32` that is at least `a + b`, or the one above it.
pub(super) fn above(a: f64, b: f64) -> f32 {
    -below(-a, -b)
}

/// Converts to `f64`.
pub(super) fn wide(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// Returns `b - a` in `f64`.
pub(super) fn difference(b: Vec3, a: Vec3) -> [f64; 3] {
    let (a, b) = (wide(a), wide(b));
    core::array::from_fn(|i| b[i] - a[i])
}

/// Returns the smallest box around a point that may be off by `error`.
pub(super) fn around(point: [f64; 3], error: f64) -> Aabb {
    let corner =
        |bound: fn(f64, f64) -> f32, error: f64| Vec3::from_array(point.map(|x| bound(x, error)));
    Aabb::new(corner(below, -error), corner(above, error))
}

/// Returns a box around the disk: along each axis it extends by `radius` times the sine of the
/// angle between the axis and the normal. Without a normal, around the sphere.
pub(super) fn around_disk(center: Vec3, normal: [f64; 3], radius: f32) -> Aabb {
    let square = normal.map(|n| n * n);
    let whole = square[0] + square[1] + square[2];
    let reach = |i: usize| {
        let across = square[(i + 1) % 3] + square[(i + 2) % 3];
        let sine = if whole == 0.0 { 1.0 } else { (across / whole).sqrt() };
        f64::from(radius) * sine * (1.0 + 4.0 * f64::EPSILON)
    };
    let corner = |bound: fn(f64, f64) -> f32, sign: f64| {
        Vec3::from_array(core::array::from_fn(|i| bound(f64::from(center[i]), sign * reach(i))))
    };
    Aabb::new(corner(below, -1.0), corner(above, 1.0))
}
