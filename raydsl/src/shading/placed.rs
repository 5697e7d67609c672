//! Points of instances, in the space of the scene.

use glam::{Affine3, Mat3};

use crate::geometry::{Hit, Ray, SurfacePoint};
use crate::kernel;
use crate::machine::generic::{max, transform_point};

/// 16 eps (eps = 2^-24): a coordinate that a transform of one level or several gives is rounded
/// fewer than eight times on the way there, and as often for the ray that leaves.
const OF_TRANSFORM: f32 = 16.0 / 16_777_216.0;

/// 3 eps: as for a point that is not placed.
const OF_COORDINATES: f32 = 3.0 / 16_777_216.0;

/// Returns the absolute value of each element.
#[kernel]
fn abs_matrix(m: Mat3) -> Mat3 {
    Mat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

/// Transforms a point on a surface of an instance to the space of the scene, in which `ray` hits it.
/// `to_object` is the transform from there to that of the instance's tree.
///
/// The ray's own point is moved along the normal until its image is in the plane of the surface: so
/// no map is inverted, and the error is that of one transform, however far the ray has come and
/// however ill-conditioned the map is across the normal. Distances between parallel planes grow by
/// `1 / |transpose(to_object) * normal|`.
#[kernel]
pub(super) fn placed_point(
    to_object: Affine3,
    ray: Ray,
    hit: Hit,
    point: SurfacePoint,
) -> SurfacePoint {
    let back = to_object.matrix3.transpose() * point.normal;
    // Squares of the components would leave the range of `f32` at scales beyond 1e19.
    let size = max(max(back.x.abs(), back.y.abs()), back.z.abs());
    let scaled = back / size;
    let length = scaled.length();
    let normal = scaled / length;
    let shrinks = size * length;
    let start = ray.origin + ray.direction * hit.t;
    let left = point.normal.dot(point.position - transform_point(to_object, start));
    let position = start + normal * (left / shrinks);
    let seen = abs_matrix(to_object.matrix3) * position.abs() + to_object.translation.abs();
    let of_transform = point.normal.abs().dot(seen) * OF_TRANSFORM;
    let of_coordinates = normal.abs().dot(position.abs()) * OF_COORDINATES;
    SurfacePoint {
        position,
        normal,
        error: (point.error + of_transform) / shrinks + of_coordinates,
    }
}
