//! Kernels as users write them, and how they are run.

use raydsl::kernel as kernel_fn;
use raydsl::prelude::*;
use raydsl::render::FilmArgs;
use raydsl_benches::clock::seconds_on;
use raydsl_benches::device::device_seconds;

use crate::rays::{SAMPLES, Workload, place_of, shadow_ray, sum_of_rays};

/// How many rays of a place meet something before `t_max`.
#[kernel_fn]
#[inline]
fn occluded(bvh: &Bvh<Triangle>, t_max: f32, origin: Vec3, normal: Vec3, seed: u32) -> u32 {
    let frame = Frame::around(normal);
    let hits =
        bvh.any_hit_each::<8>(|i: u32| shadow_ray(origin, frame, seed, i).with_range(0.0, t_max));
    let mut count = 0u32;
    for hit in hits {
        count += hit as u32;
    }
    count
}

/// What runs kernels.
#[derive(Clone, Copy)]
pub(super) enum Engine<'a> {
    /// A variant of the CPU, on so many threads.
    Cpu(TiledScheduler, usize),
    /// WGSL. What it takes is read off the device's clock: neither uploads nor readback count.
    Device(&'a GpuScheduler),
}

/// Who asks a tree, and about what. What is asked takes as long as is returned.
#[derive(Clone, Copy)]
pub(super) struct Ask<'a> {
    pub(super) bvh: &'a Bvh<'a, Triangle>,
    pub(super) work: &'a Workload,
    pub(super) engine: Engine<'a>,
}

impl Ask<'_> {
    fn frame<A: FilmArgs, R: Type>(self, kernel: &Kernel<'_, A, R>, image: &mut Image<R>) -> f64 {
        let camera = &self.work.camera;
        match self.engine {
            Engine::Cpu(scheduler, threads) => {
                seconds_on(threads, || scheduler.frame(camera, kernel, image)).1
            }
            Engine::Device(gpu) => device_seconds(|| gpu.frame(camera, kernel, image)),
        }
    }

    fn batch<A: Type, R: Type>(
        self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        found: &mut [R],
    ) -> f64 {
        match self.engine {
            Engine::Cpu(scheduler, threads) => {
                seconds_on(threads, || scheduler.batch(kernel, inputs, found)).1
            }
            Engine::Device(gpu) => device_seconds(|| gpu.batch(kernel, inputs, found)),
        }
    }

    pub(super) fn primary(self, image: &mut Image<Hit>) -> f64 {
        let bvh = self.bvh;
        self.frame(&kernel!(|ray: Ray| bvh.closest_hit(ray)), image)
    }

    /// Numbers of hits: of the ray itself, and of its shadow rays.
    pub(super) fn picture(self, image: &mut Image<u32>) -> f64 {
        let (bvh, t_max, size) = (self.bvh, self.work.short, self.work.size);
        let kernel = kernel!(|ray: Ray, pixel: UVec2| {
            let hit = bvh.closest_hit(ray);
            if !hit.is_hit {
                return 0u32;
            }
            let (origin, normal) = place_of(bvh.primitive(hit), ray, hit);
            1 + occluded(bvh, t_max, origin, normal, pixel.y * size + pixel.x)
        });
        self.frame(&kernel, image)
    }

    fn ambient(self, t_max: f32, found: &mut [u32]) -> f64 {
        let bvh = self.bvh;
        let kernel = kernel!(|origin: Vec3, normal: Vec3, seed: u32| {
            occluded(bvh, t_max, origin, normal, seed)
        });
        self.batch(&kernel, &self.work.places, found)
    }

    pub(super) fn short(self, found: &mut [u32]) -> f64 {
        self.ambient(self.work.short, found)
    }

    pub(super) fn unbounded(self, found: &mut [u32]) -> f64 {
        self.ambient(f32::MAX, found)
    }

    /// One shadow ray after another.
    pub(super) fn unbatched(self, found: &mut [u32]) -> f64 {
        let (bvh, t_max) = (self.bvh, self.work.short);
        let kernel = kernel!(|origin: Vec3, normal: Vec3, seed: u32| {
            let frame = Frame::around(normal);
            let mut count = 0u32;
            for i in 0..SAMPLES {
                let ray = shadow_ray(origin, frame, seed, i);
                count += bvh.any_hit(ray.with_range(0.0, t_max)) as u32;
            }
            count
        });
        self.batch(&kernel, &self.work.places, found)
    }

    /// Numbers of hits, and the sums of their distances.
    pub(super) fn bounce(self, found: &mut [(u32, f32)]) -> f64 {
        let bvh = self.bvh;
        let kernel = kernel!(|origin: Vec3, normal: Vec3, seed: u32| {
            let frame = Frame::around(normal);
            let hits = bvh.closest_hit_each::<8>(|i: u32| shadow_ray(origin, frame, seed, i));
            let mut count = 0u32;
            let mut distance = 0.0;
            for hit in hits {
                if hit.is_hit {
                    count += 1;
                    distance += hit.t;
                }
            }
            (count, distance)
        });
        self.batch(&kernel, &self.work.places, found)
    }

    /// Only makes the camera's rays.
    pub(super) fn make_primary(self, image: &mut Image<f32>) -> f64 {
        let kernel = kernel!(|ray: Ray| {
            let sum = ray.origin + ray.direction;
            sum.x + sum.y + sum.z
        });
        self.frame(&kernel, image)
    }

    /// Only makes the shadow rays.
    pub(super) fn make_shadow(self, found: &mut [f32]) -> f64 {
        let kernel =
            kernel!(|origin: Vec3, normal: Vec3, seed: u32| { sum_of_rays(origin, normal, seed) });
        self.batch(&kernel, &self.work.places, found)
    }

    /// Only makes the shadow rays of a frame, from what its camera rays meet.
    pub(super) fn make_frame(self, found: &mut [f32]) -> f64 {
        let bvh = self.bvh;
        let kernel = kernel!(|ray: Ray, hit: Hit, seed: u32| {
            if !hit.is_hit {
                return 0.0;
            }
            let (origin, normal) = place_of(bvh.primitive(hit), ray, hit);
            sum_of_rays(origin, normal, seed)
        });
        self.batch(&kernel, &self.work.hits, found)
    }
}
