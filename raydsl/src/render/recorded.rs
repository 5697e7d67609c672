//! What a device runs for each pixel of a film, as a recording.

use core::marker::PhantomData;

use super::allocation::{Allocation, BLOCK};
use super::shot::{Frame, Pass, Shot};
use super::{FilmArgs, Radiance, Sampling};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::machine::{Recording, Type, X2};

/// Records a shot: the frame around the body of its kernel, and the body.
pub(crate) fn recorded<S: Shot>(shot: &S) -> Recording {
    shot.kernel().record_grid::<S::Output>(|m, x, y, body| {
        shot.pixel_on(m, X2 { x, y }, &|m, args| {
            m.begin_body();
            body(m, args)
        })
    })
}

impl<A: FilmArgs, R: Type> Kernel<'_, A, R> {
    /// Records what a device runs for each pixel of a frame: the ray of the camera, and the kernel.
    ///
    /// ```
    /// use raydsl::machine::wgsl::Limits;
    /// use raydsl::prelude::*;
    ///
    /// let sky = kernel!(|ray: Ray| ray.direction.y);
    /// let camera = Pinhole::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0);
    /// let text = sky.record_frame(&camera, (640, 480)).module(&Limits::default()).source;
    /// assert!(text.contains("fn kernel(ray: Ray) -> f32"));
    /// ```
    pub fn record_frame<C: Camera>(&self, camera: &C, (width, height): (u32, u32)) -> Recording {
        recorded(&Frame { rays: camera.begin_frame(width, height), kernel: self })
    }
}

impl<A: FilmArgs, R: Radiance> Kernel<'_, A, R> {
    /// Records what a device runs for each pixel of a [`Film`](super::Film): the loop over its
    /// samples, what they need of the camera and the sampler, and the kernel.
    pub fn record_pass<C: Camera>(
        &self,
        camera: &C,
        sampling: &Sampling,
        (width, height): (u32, u32),
    ) -> Recording {
        self.recorded_pass(camera, sampling, (width, height), None)
    }

    /// Records what a device runs for each pixel of a pass in which each block of 16 by 16 pixels has a
    /// number of samples of its own, as passes of [`Until::adaptive`](super::Until::adaptive) have after
    /// the pilots. The numbers are data: here each is that of `sampling`.
    pub fn record_adaptive_pass<C: Camera>(
        &self,
        camera: &C,
        sampling: &Sampling,
        (width, height): (u32, u32),
    ) -> Recording {
        let blocks = width.div_ceil(BLOCK) as usize * height.div_ceil(BLOCK) as usize;
        let allocation = Allocation::new(width, vec![sampling.planned; blocks]);
        self.recorded_pass(camera, sampling, (width, height), Some(&allocation))
    }

    fn recorded_pass<C: Camera>(
        &self,
        camera: &C,
        sampling: &Sampling,
        (width, height): (u32, u32),
        allocation: Option<&Allocation>,
    ) -> Recording {
        recorded(&Pass {
            rays: camera.begin_frame(width, height),
            kernel: self,
            sampling: *sampling,
            first: 0,
            count: sampling.planned,
            allocation,
            kept: PhantomData::<fn()>,
        })
    }
}
