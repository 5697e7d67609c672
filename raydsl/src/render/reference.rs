//! Reference values of a film: single samples, and means in `f64`.

use core::marker::PhantomData;

use glam::{DVec4, UVec2, uvec2};

use super::shot::{Frame, Pass, Shot, places};
use super::{FilmArgs, Radiance, Sampling};
use crate::camera::{Camera, CameraRays};
use crate::geometry::Ray;
use crate::kernel::Kernel;
use crate::machine::{Machine, Outcomes, Rounding, Type, U, X2};
use crate::sampling::Sampler;

impl Sampling {
    /// Returns the ray of a pixel's sample `index`, and the sampler passed to the kernel: the same
    /// in every variant.
    pub fn sample<C: CameraRays>(&self, rays: &C, pixel: UVec2, index: u32) -> (Ray, Sampler) {
        let Self { pixels, method, seed, planned } = *self;
        let (at, lens, sampler) = places(pixel, seed, index, planned, pixels, method, C::HAS_LENS);
        (rays.lens_ray(at.x, at.y, lens), sampler)
    }

    /// Returns the mean of the first `samples` samples of every pixel, each computed in `f64`, the
    /// reference for a film's rounding errors. Pixels are row by row from the bottom. It takes some
    /// two hundred times as long as the film.
    pub fn means_in_f64<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        (width, height): (u32, u32),
        samples: u32,
    ) -> Vec<DVec4> {
        let rays = camera.begin_frame(width, height);
        let sample = |pixel: UVec2, first: u32| {
            let (count, allocation, kept) = (1, None, PhantomData::<fn()>);
            let pass = Pass { rays, kernel, sampling: *self, first, count, allocation, kept };
            let outcomes = Outcomes::of(Rounding::IEEE, 1, |m| {
                let pixel = X2 { x: U(m.u32(pixel.x)), y: U(m.u32(pixel.y)) };
                pass.pixel_on(m, pixel, &|m, args| kernel.on_margin(m, args))
            });
            // The leaves of moments: the count, then the mean.
            let mean = |i: usize| outcomes.reference()[1 + i].value();
            DVec4::new(mean(0), mean(1), mean(2), mean(3))
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| uvec2(x, y)));
        let mean = |pixel| {
            let sum: DVec4 = (0..samples).map(|i| sample(pixel, i)).sum();
            sum / f64::from(samples)
        };
        pixels.map(mean).collect()
    }
}

/// Returns the possible results of a frame's pixel under rounding, for the crate `raydsl-report`.
pub fn outcomes_of_frame<C: CameraRays, A: FilmArgs, R: Type>(
    rays: &C,
    kernel: &Kernel<'_, A, R>,
    pixel: UVec2,
    rounding: Rounding,
    limit: usize,
) -> Outcomes {
    let frame = Frame { rays: *rays, kernel };
    Outcomes::of(rounding, limit, |m| {
        let pixel = X2 { x: U(m.u32(pixel.x)), y: U(m.u32(pixel.y)) };
        frame.pixel_on(m, pixel, &|m, args| kernel.on_margin(m, args))
    })
}
