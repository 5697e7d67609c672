//! Windows of pictures: rectangles that are rendered by themselves, with the pixels of the whole.

use glam::{UVec2, uvec2};

use super::shot::{Body, Shot};
use crate::kernel;
use crate::kernel::Kernel;
use crate::machine::functions::uvec2;
use crate::machine::{Machine, Resource, Type, U, X2};

/// A shot for the pixels of a window, whose lower left one is `origin` in the whole picture.
pub(super) struct Windowed<S> {
    pub(super) shot: S,
    pub(super) origin: UVec2,
}

/// Returns the pixel of the whole picture.
#[kernel]
#[inline]
fn in_picture(pixel: UVec2, origin: UVec2) -> UVec2 {
    uvec2(pixel.x.wrapping_add(origin.x), pixel.y.wrapping_add(origin.y))
}

impl<S: Shot> Shot for Windowed<S> {
    type Args = S::Args;
    type Result = S::Result;
    type Output = S::Output;

    fn kernel(&self) -> &Kernel<'_, Self::Args, Self::Result> {
        self.shot.kernel()
    }

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.shot.resources(visit);
    }

    fn pixel(&self, pixel: UVec2) -> Self::Output {
        self.shot.pixel(in_picture(pixel, self.origin))
    }

    #[inline(always)]
    fn pixel_on<M: Machine>(
        &self,
        m: &M,
        pixel: X2<U<M>>,
        body: &Body<'_, M, Self>,
    ) -> <Self::Output as Type>::On<M> {
        let origin = m.capture("window", self.origin);
        self.shot.pixel_on(m, in_picture::on(m, pixel, origin), body)
    }
}
