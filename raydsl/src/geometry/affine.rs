//! Affine transforms of rays and boxes.

use glam::{Affine3, DAffine3, DMat3, DVec3, Vec3};

use super::{Aabb, Ray};
use crate::kernel;
use crate::machine::generic::{max, normalize, transform_point, transform_vector};

/// Transforms a ray by an affine map. Its direction is not normalized, so a hit has the same `t` on
/// both sides of the map.
#[kernel]
pub fn transform_ray(ray: Ray, map: Affine3) -> Ray {
    Ray {
        origin: transform_point(map, ray.origin),
        direction: transform_vector(map, ray.direction),
        ..ray
    }
}

/// Transforms a unit normal from the far side of a map to the near side: multiplies by the
/// transposed matrix, which is valid for any scale and shear, and normalizes.
#[kernel]
pub(crate) fn transform_normal_back(normal: Vec3, map: Affine3) -> Vec3 {
    let back = map.matrix3.transpose() * normal;
    // Squares of the components would leave the range of `f32` at scales beyond 1e19.
    normalize(back / max(max(back.x.abs(), back.y.abs()), back.z.abs()))
}

/// Affine map and its inverse, for placed geometry.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inverted {
    /// Transform from the outer space to that of the object, as applied to rays.
    pub(crate) to_object: Affine3,
    /// Exact inverse of `to_object`, up to the rounding of `f64`.
    pub(crate) to_outer: DAffine3,
    /// Largest factor by which `to_outer` stretches a direction.
    pub(crate) stretch: f64,
    /// Condition number: the largest stretch over the least one.
    pub(crate) condition: f64,
}

/// Returns the maps of an object placed by `to_outer`; `None` if it is not finite or flattens the
/// object.
pub(crate) fn inverted(to_outer: Affine3) -> Option<Inverted> {
    // Invert the rounded map of rays again, not the original: the boxes must contain the hits of
    // the transformed rays.
    let to_object = narrowed(wide(to_outer).inverse());
    let to_outer = wide(to_object).inverse();
    let stretch = stretch(to_outer.matrix3);
    let condition = stretch * self::stretch(wide(to_object).matrix3);
    let is_usable = to_object.is_finite() && to_outer.is_finite() && condition.is_finite();
    is_usable.then_some(Inverted { to_object, to_outer, stretch, condition })
}

fn wide(a: Affine3) -> DAffine3 {
    let m = a.matrix3;
    let matrix3 = DMat3::from_cols(m.x_axis.as_dvec3(), m.y_axis.as_dvec3(), m.z_axis.as_dvec3());
    DAffine3 { matrix3, translation: a.translation.as_dvec3() }
}

fn narrowed(a: DAffine3) -> Affine3 {
    let m = a.matrix3;
    let columns = [m.x_axis.as_vec3(), m.y_axis.as_vec3(), m.z_axis.as_vec3()];
    let matrix3 = glam::Mat3::from_cols(columns[0], columns[1], columns[2]);
    Affine3 { matrix3, translation: a.translation.as_vec3() }
}

/// Returns the largest singular value: the square root of the largest eigenvalue of `m^T m`, by
/// Jacobi rotations (Golub and Van Loan, *Matrix Computations*, section 8.5).
fn stretch(m: DMat3) -> f64 {
    // At this size squares neither overflow nor vanish.
    let size = m.to_cols_array().into_iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    if size == 0.0 || !size.is_finite() {
        return size;
    }
    let m = m * (1.0 / size);
    let mut a = m.transpose() * m;
    for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(30) {
        let by = rotation(&a, p, q);
        a = by.transpose() * a * by;
    }
    size * a.diagonal().max_element().sqrt()
}

/// Returns the rotation that zeroes element `(p, q)` of a symmetric matrix.
fn rotation(a: &DMat3, p: usize, q: usize) -> DMat3 {
    let mut by = DMat3::IDENTITY;
    if a.col(p)[q] != 0.0 {
        let theta = 0.5 * (a.col(q)[q] - a.col(p)[p]) / a.col(p)[q];
        let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
        let cos = 1.0 / t.hypot(1.0);
        (by.col_mut(p)[p], by.col_mut(q)[q]) = (cos, cos);
        (by.col_mut(q)[p], by.col_mut(p)[q]) = (t * cos, -t * cos);
    }
    by
}

/// Returns a box around the image of a box, widened by `margin` on all sides.
pub(crate) fn image(bounds: Aabb, map: &DAffine3, margin: f64) -> Aabb {
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let (center, half) = (0.5 * (low + high), 0.5 * (high - low));
    let m = map.matrix3;
    let reach = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z;
    let middle = map.transform_point3(center);
    // Add more than the `f64` rounding error of the formulas.
    let reach = reach + (middle.abs() + reach) * 1e-14 + DVec3::splat(margin);
    let outwards = |v: DVec3, to: fn(f32) -> f32| {
        let v = v.as_vec3();
        Vec3::new(to(v.x), to(v.y), to(v.z))
    };
    Aabb::new(outwards(middle - reach, f32::next_down), outwards(middle + reach, f32::next_up))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat3, Quat, vec3};

    #[test]
    fn conditions_are_those_of_the_stretches() {
        let turn = Mat3::from_quat(Quat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7));
        for (scale, condition) in [
            (vec3(1.0, 1.0, 1.0), 1.0),
            (vec3(2.0, 2.0, 2.0), 1.0),
            (vec3(1.0, 4.0, 0.5), 8.0),
            (vec3(1e-3, 1.0, 1e3), 1e6),
            (vec3(1e-20, 1e-20, 1e-20), 1.0),
        ] {
            let map = Affine3 {
                matrix3: turn * Mat3::from_diagonal(scale) * turn.transpose(),
                translation: vec3(5.0, -7.0, 1e3),
            };
            let found = inverted(map).expect("it can be inverted");
            let off = found.condition / condition;
            // Rounding of the matrix moves its least stretch by a few ulps of its largest.
            let tolerance = 1e-6 * condition;
            assert!((off - 1.0).abs() < tolerance, "{scale}: {}", found.condition);
            let off = found.stretch / f64::from(scale.max_element());
            assert!((off - 1.0).abs() < tolerance, "{scale}: {}", found.stretch);
        }
    }

    #[test]
    fn what_flattens_has_no_inverse() {
        for scale in [vec3(1.0, 0.0, 1.0), vec3(f32::NAN, 1.0, 1.0), vec3(1.0, f32::INFINITY, 1.0)]
        {
            assert!(inverted(Affine3::from_scale(scale)).is_none(), "{scale}");
        }
        assert!(inverted(Affine3::from_translation(vec3(f32::NAN, 0.0, 0.0))).is_none());
    }

    #[test]
    fn images_of_boxes_hold_their_corners() {
        let map = Affine3 {
            matrix3: Mat3::from_quat(Quat::from_rotation_z(0.5)) * 3.0,
            translation: vec3(1e4, 0.1, -3.0),
        };
        let map = wide(map);
        let bounds = Aabb::new(vec3(-1.0, 2.0, 0.0), vec3(1.5, 2.0, 7.0));
        let image = image(bounds, &map, 0.0);
        for k in 0..8 {
            let pick = |axis: usize| if k >> axis & 1 == 0 { bounds.min } else { bounds.max };
            let corner =
                DVec3::new(f64::from(pick(0).x), f64::from(pick(1).y), f64::from(pick(2).z));
            let corner = map.transform_point3(corner);
            let inside = image.min.as_dvec3().cmple(corner) & corner.cmple(image.max.as_dvec3());
            assert!(inside.all());
        }
    }
}
