//! Ideal specular reflection.

use glam::{Vec3, vec3};

use super::{Bsdf, BsdfSample};
use crate::machine::functions::vec3;
use crate::{Type, kernel};

/// Ideal specular reflection: a delta lobe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Mirror {
    /// Share of light that is reflected: red, green and blue, each from 0 to 1.
    pub color: Vec3,
}

#[kernel]
impl Bsdf for Mirror {
    #[inline]
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Vec3 {
        vec3(0.0, 0.0, 0.0)
    }

    #[inline]
    fn sample(&self, wo: Vec3, _u: Vec3) -> BsdfSample {
        BsdfSample::delta(vec3(-wo.x, -wo.y, wo.z), self.color, 1.0)
    }

    #[inline]
    fn pdf(&self, _wo: Vec3, _wi: Vec3) -> f32 {
        0.0
    }

    #[inline]
    fn albedo(&self, _wo: Vec3) -> Vec3 {
        self.color
    }
}
