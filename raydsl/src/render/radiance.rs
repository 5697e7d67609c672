//! The colour of a kernel's result.

use glam::{Vec3, Vec4, vec4};

use super::Shaded;
use crate::integrators::PathSample;
use crate::kernel;
use crate::machine::functions::vec4;
use crate::machine::{Coerce, Machine, On, Type};

/// A result with a colour, whose samples can be averaged: the radiance along the camera's ray, as
/// red, green, blue and alpha.
///
/// For a type of your own, write `#[kernel] impl Radiance for MyPixel`. The colour of a tuple is that
/// of its first member. Other members (a distance, an albedo) are averaged by a film
/// [of channels](super::Film::of_channels); ids are those of a sample.
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
impl Radiance for PathSample {
    #[inline]
    fn rgba(&self) -> Vec4 {
        self.color
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

macro_rules! first_of_tuple {
    ($($other:ident),+) => {
        impl<R: Radiance, $($other: Type),+> Radiance for (R, $($other),+) {
            #[inline]
            fn rgba(&self) -> Vec4 {
                self.0.rgba()
            }

            #[inline(always)]
            fn rgba_on<M: Machine>(
                m: &M,
                this: impl Coerce<M, On<Self, M>>,
            ) -> On<Vec4, M> {
                R::rgba_on(m, this.coerce(m).0)
            }
        }
    };
}

first_of_tuple!(A);
first_of_tuple!(A, B);
first_of_tuple!(A, B, C);
first_of_tuple!(A, B, C, D);
first_of_tuple!(A, B, C, D, E);
first_of_tuple!(A, B, C, D, E, F);
first_of_tuple!(A, B, C, D, E, F, G);
