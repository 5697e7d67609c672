//! Orthonormal frames.

use glam::{Vec3, vec3};

use crate::machine::functions::vec3;
use crate::{Type, kernel};

/// Right-handed orthonormal frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Frame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent, perpendicular to `x`.
    pub y: Vec3,
    /// Direction that the frame was made around.
    pub z: Vec3,
}

#[kernel]
impl Frame {
    /// Creates a frame around a direction of unit length, off by at most 4e-7 whatever the
    /// direction.
    ///
    /// Duff, Burgess, Christensen, Hery, Kensler, Liani and Villemin, "Building an Orthonormal
    /// Basis, Revisited" (JCGT 2017). The sign is that of a comparison, so that -0 counts as 0 in
    /// every variant. A zero vector yields the axes `x` and `y`.
    #[inline]
    pub fn around(z: Vec3) -> Self {
        let sign = if z.z < 0.0 { -1.0 } else { 1.0 };
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: vec3(1.0 + sign * (z.x * z.x * a), sign * b, -sign * z.x),
            y: vec3(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// Transforms a vector from frame to world coordinates.
    #[inline]
    pub fn to_world(self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Transforms a vector from world to frame coordinates.
    #[inline]
    pub fn to_local(self, v: Vec3) -> Vec3 {
        vec3(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }
}
