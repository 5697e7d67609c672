//! Cones around normals.

use core::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI};

use glam::Vec3;

use crate::math::elementary::{SinCos, atan2, sincos_2pi};

/// What the rounding of one union does, at most, to an angle.
const ROUNDING: f32 = 2e-6;

/// Directions up to an angle from an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    /// Unit vector.
    pub(super) axis: Vec3,
    /// The angle, up to pi.
    pub(super) angle: f32,
}

/// Returns the sine and the cosine of an angle, the same on every computer.
pub(super) fn sin_cos(angle: f32) -> (f32, f32) {
    let SinCos { sin, cos } = sincos_2pi(angle * (0.5 * FRAC_1_PI));
    (sin, cos)
}

/// Returns the angle with a cosine.
pub(super) fn angle_of(cos: f32) -> f32 {
    let cos = cos.clamp(-1.0, 1.0);
    atan2(((1.0 - cos) * (1.0 + cos)).sqrt(), cos)
}

impl Cone {
    /// All directions.
    pub(super) const ALL: Self = Self { axis: Vec3::Z, angle: PI };

    /// Returns the least cone around two, or all directions.
    pub(super) fn union(self, other: Self) -> Self {
        let (wide, narrow) = if self.angle >= other.angle { (self, other) } else { (other, self) };
        if wide.angle >= PI {
            return Self::ALL;
        }
        let across = wide.axis.cross(narrow.axis);
        let sine = across.length();
        let between = atan2(sine, wide.axis.dot(narrow.axis));
        if between + narrow.angle <= wide.angle {
            return wide;
        }
        let angle = 0.5 * (wide.angle + between + narrow.angle) + ROUNDING;
        // Axes that are opposite have no plane in common.
        if angle >= PI || sine <= 1e-6 {
            let around = between + narrow.angle + ROUNDING;
            let is_one = angle < PI && around < PI && between < FRAC_PI_2;
            return if is_one { Self { angle: around, ..wide } } else { Self::ALL };
        }
        // Turn the axis of the wide one towards the other.
        let (sin, cos) = sin_cos(angle - wide.angle);
        let aside = across.cross(wide.axis) / sine;
        let axis = (wide.axis * cos + aside * sin).normalize_or(Vec3::Z);
        Self { axis, angle }
    }

    /// Returns the solid angle into which surfaces with these normals shine up to the angle
    /// `emitted` from them, at most a right one, weighted by the cosine beyond the normals.
    pub(super) fn measure(self, emitted: f32) -> f32 {
        let o = self.angle;
        let w = (o + emitted).min(PI);
        let ((sin, cos), (_, cos_beyond)) = (sin_cos(o), sin_cos(2.0 * w - o));
        let beyond = 2.0 * (w - o) * sin - cos_beyond + cos;
        2.0 * PI * (1.0 - cos) + FRAC_PI_2 * beyond.max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_are_those_of_known_lights() {
        let flat = Cone { axis: Vec3::Z, angle: 0.0 };
        assert!((flat.measure(FRAC_PI_2) - PI).abs() < 1e-5);
        assert!((Cone::ALL.measure(FRAC_PI_2) - 4.0 * PI).abs() < 1e-5);
        // A spot up to 60 degrees: the integral of the cosine.
        assert!((flat.measure(angle_of(0.5)) - PI * 0.75).abs() < 1e-5);
    }

    #[test]
    fn unions_have_the_cones_in_them() {
        let mut random = crate::sampling::Rng::new(glam::UVec2::ZERO, 0, 3);
        let mut direction = || {
            let u = random.next_2d();
            crate::sampling::sample_uniform_sphere(u)
        };
        for i in 0..2000 {
            let (a, b) = (direction(), direction());
            let near = (a + b * 10f32.powi(-(i % 8))).normalize();
            let angle = (i % 32) as f32 / 10.0;
            let (one, two) = (
                Cone { axis: a, angle: 0.1 * angle },
                Cone { axis: if i % 2 == 0 { b } else { near }, angle },
            );
            let both = one.union(two);
            for cone in [one, two] {
                let between = f64::from(both.axis.angle_between(cone.axis));
                let needed = (between + f64::from(cone.angle)).min(core::f64::consts::PI);
                assert!(needed <= f64::from(both.angle) + 4e-4, "{one:?} {two:?} {both:?}");
            }
            assert!((both.axis.length() - 1.0).abs() < 1e-6);
        }
    }
}
