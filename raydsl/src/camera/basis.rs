//! Orthonormal camera bases.

use core::f64::consts::PI;

use glam::{DVec3, Vec3};

/// Orthonormal basis of a camera.
pub(super) struct Basis {
    pub(super) right: Vec3,
    pub(super) up: Vec3,
    pub(super) forward: Vec3,
}

impl Basis {
    /// Creates the basis of a view from `eye` to `center`; defined for all finite input.
    pub(super) fn new(eye: Vec3, center: Vec3, up: Vec3) -> Self {
        let (view, up) = (center.as_dvec3() - eye.as_dvec3(), up.as_dvec3());
        let forward = view.try_normalize().unwrap_or(DVec3::NEG_Z);
        // The rounded product of two parallel vectors has no direction.
        let right = view.cross(up);
        let is_clear = right.length() > 1e-9 * view.length() * up.length();
        let right = if is_clear { right.normalize() } else { forward.any_orthonormal_vector() };
        let up = right.cross(forward);
        Self { right: right.as_vec3(), up: up.as_vec3(), forward: forward.as_vec3() }
    }
}

/// Returns the size of a pixel at distance 1, for a vertical field of view in radians.
pub(super) fn pixel_size(fov_y: f32, height: u32) -> f64 {
    let fov = f64::from(fov_y).clamp(1e-6, PI - 1e-6);
    2.0 * (fov * 0.5).tan() / f64::from(height.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn every_view_has_a_basis() {
        let views = [
            (Vec3::ZERO, Vec3::ZERO, Vec3::Y),
            (Vec3::ZERO, Vec3::Y, Vec3::Y),
            (Vec3::ZERO, vec3(0.0, -3.0, 0.0), Vec3::Y),
            (Vec3::ONE, Vec3::X, Vec3::ZERO),
            (vec3(1e6, 0.0, 1.0), vec3(1e6, 0.0, 1.0 + 1e-6), Vec3::Y),
            (Vec3::ZERO, vec3(1.0, 2.0, -3.0), vec3(1.0, 2.0, -3.0 + 1e-6)),
            (Vec3::ZERO, vec3(1.0, 2.0, -3.0), vec3(3.0, 6.0, -9.0)),
            (Vec3::ZERO, vec3(1e20, 2e20, 0.0), vec3(1e-23, 0.0, 1e-23)),
            (Vec3::ZERO, vec3(1e-30, 2e-30, 0.0), vec3(1e30, 0.0, 1e30)),
        ];
        for (eye, center, up) in views {
            let Basis { right, up, forward } = Basis::new(eye, center, up);
            let lengths = [right, up, forward].map(|v| (v.length() - 1.0).abs());
            let products = [right.dot(up), up.dot(forward), forward.dot(right)].map(f32::abs);
            assert!(lengths.into_iter().chain(products).all(|e| e < 3e-7), "{eye} {center}");
        }
        assert_eq!(Basis::new(Vec3::ONE, Vec3::ONE, Vec3::Y).forward, Vec3::NEG_Z);
    }

    #[test]
    fn fields_of_view_are_clamped() {
        assert!((pixel_size(core::f32::consts::FRAC_PI_2, 1) - 2.0).abs() < 1e-6);
        for fov in [0.0, -1.0, core::f32::consts::PI, 7.0, 179.9f32.to_radians()] {
            let size = pixel_size(fov, 0);
            assert!(size.is_finite() && size > 0.0, "{fov}: {size}");
        }
    }
}
