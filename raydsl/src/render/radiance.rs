//! What of a kernel's result is light.

use glam::{Vec3, Vec4, vec4};

use super::Shaded;
use crate::kernel;
use crate::machine::functions::vec4;

/// A result with a colour, whose samples can be averaged.
///
/// For one of your own, `#[kernel] impl Radiance for MyPixel`. What is no colour (a distance, an
/// id) is not averaged: take it from a frame, whose rays go through the middle of the pixels.
#[kernel]
pub trait Radiance {
    /// Red, green, blue and alpha.
    fn rgba(&self) -> Vec4;
}

#[kernel]
impl Radiance for Shaded {
    #[inline]
    fn rgba(&self) -> Vec4 {
        vec4(self.color.x, self.color.y, self.color.z, 1.0)
    }
}

#[kernel]
impl Radiance for Vec4 {
    #[inline]
    fn rgba(&self) -> Vec4 {
        *self
    }
}

#[kernel]
impl Radiance for Vec3 {
    #[inline]
    fn rgba(&self) -> Vec4 {
        vec4(self.x, self.y, self.z, 1.0)
    }
}

#[kernel]
impl Radiance for f32 {
    #[inline]
    fn rgba(&self) -> Vec4 {
        vec4(*self, *self, *self, 1.0)
    }
}
