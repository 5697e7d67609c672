//! The colour of a kernel's result.

use glam::{Vec3, Vec4, vec4};

use super::Shaded;
use crate::kernel;
use crate::machine::functions::vec4;

/// A result with a colour, whose samples can be averaged.
///
/// For a type of your own, write `#[kernel] impl Radiance for MyPixel`. Members other than the
/// colour (a distance, an id) are not averaged: take them from a frame, whose rays go through the
/// centres of the pixels.
#[kernel]
pub trait Radiance {
    /// Returns red, green, blue and alpha.
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
