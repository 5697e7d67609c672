//! Rays.

use glam::Vec3;

use crate::{Type, kernel};

/// Ray segment `origin + t * direction` for `t` in `[t_min, t_max]`.
///
/// The direction need not have unit length: `t` is in lengths of it. A ray with a NaN or an
/// infinite component misses everything.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct Ray {
    /// Origin.
    pub origin: Vec3,
    /// Direction; not zero.
    pub direction: Vec3,
    /// Minimum distance of a hit.
    pub t_min: f32,
    /// Maximum distance of a hit.
    pub t_max: f32,
}

#[kernel]
impl Ray {
    /// Creates a ray without limits in front of its origin: `t` in `[0, f32::MAX]`.
    pub const fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::MAX }
    }

    /// Returns the ray with `t` in `[t_min, t_max]`.
    pub const fn with_range(self, t_min: f32, t_max: f32) -> Self {
        Self { t_min, t_max, ..self }
    }

    /// Returns the point at distance `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
