//! Films by kernels that take one step of a longer computation.

use glam::{UVec2, uvec2};

use super::channels::Kept;
use super::renderer::LARGEST_PASS;
use super::shot::places;
use super::tile::Tile;
use super::{Film, Image, Radiance, Sampling, TiledScheduler};
use crate::camera::{Camera, CameraRays};
use crate::integrators::Stepped;
use crate::kernel::{Kernel, PacketKernel, PacketTask, Variant, run_in_gangs};
use crate::machine::{Lanes, Packet, Type, U, X2};

/// Number of samples that are stepped together: their packets are full until a tile's last ones, and
/// they fit into a core's cache.
const POOL: usize = 1024;

/// Number of samples that are kept until all of them are over, but for one row of a tile.
const MOST_SAMPLES: usize = 1 << 16;

impl TiledScheduler {
    /// Adds `samples` samples to every pixel of `film`, as
    /// [`accumulate`](super::Renderer::accumulate) does, by a kernel that takes one step of a sample:
    /// from [`Stepped::begin`] until [`Stepped::is_over`]. `sample` returns what the film gets of a
    /// state in the end.
    ///
    /// In packets, a lane whose sample is over gets the next one, so that lanes do not wait for the
    /// longest sample of their packet; the film has the same bits as one of whole samples. (Wald,
    /// "Active Thread Compaction for GPU Path Tracing", HPG 2011; Laine, Karras and Aila, "Megakernels
    /// Considered Harmful", HPG 2013.) It pays where samples differ in length, as paths do, and packets
    /// trace their rays together, as in binary trees. A sample that never ends never returns.
    ///
    /// A device runs the kernel of whole samples; there is no observer, and no target of an error.
    /// [`PathState`](crate::integrators::PathState) has the colour alone: denoisers' channels are in
    /// [`PathStep::seen`](crate::integrators::PathStep::seen), for a state of your own.
    ///
    /// # Panics
    ///
    /// If the variant is [`Variant::Wgsl`].
    ///
    /// ```
    /// use raydsl::bsdf::Lambert;
    /// use raydsl::integrators::{PathLimits, PathOptions, PathState, path, path_step};
    /// use raydsl::light::{AnyLight, Environment, Lights};
    /// use raydsl::prelude::*;
    ///
    /// let v = |x, y| vec3(x, y, 0.0);
    /// let triangles = [Triangle { v0: v(-1.0, -1.0), v1: v(3.0, -1.0), v2: v(-1.0, 3.0) }];
    /// let scene = Bvh::build(&triangles)?;
    /// let sky = Environment::constant(Vec3::ONE)?;
    /// let none: [AnyLight; 0] = [];
    /// let lights = Lights::new(&none, scene.bounds())?.with_environment(&sky);
    /// let (options, limits) = (PathOptions::new(), PathLimits::new(4));
    /// let step = kernel!(|state: PathState| {
    ///     let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
    ///     path_step::<_, _, Lambert>(&scene, surface, &lights, host(options), limits, state).next
    /// });
    /// let whole = kernel!(|ray: Ray, sampler: Sampler| {
    ///     let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
    ///     path::<_, _, Lambert>(&scene, surface, &lights, limits, ray, sampler).color
    /// });
    /// let camera = Pinhole::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 0.9);
    /// let (scheduler, sampling) = (TiledScheduler::new(), Sampling::new(8));
    /// let (mut a, mut b) = (Film::new(16, 16), Film::new(16, 16));
    /// scheduler.accumulate_steps(&camera, &step, |s| s.color, &sampling, &mut a, 8);
    /// scheduler.accumulate(&camera, &whole, &sampling, &mut b, 8);
    /// assert!(a == b);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn accumulate_steps<C, S, R, K>(
        &self,
        camera: &C,
        step: &Kernel<'_, (S,), S>,
        sample: impl Fn(&S) -> R + Sync,
        sampling: &Sampling,
        film: &mut Film<K>,
        samples: u32,
    ) where
        C: Camera,
        S: Stepped + Type,
        R: Radiance,
        K: Kept<R>,
    {
        let store = &mut film.store;
        let mut done = 0;
        while done < samples {
            let count = LARGEST_PASS.min(samples - done);
            let rays = camera.begin_frame(store.width(), store.height());
            let (sampling, first) = (*sampling, store.samples());
            let pass = StepsPass { rays, step, sample: &sample, sampling, first, count };
            let mut image = Image::filled(store.width(), store.height(), K::none());
            image.tiles(self.edge).for_each_parallel(|mut tile| {
                pass.render::<K, R>(&mut tile, self.variant, self.gang);
            });
            K::join(&image, count, store);
            done += count;
        }
    }
}

/// Some samples of each pixel.
struct StepsPass<'a, C, S: Type, F> {
    rays: C,
    step: &'a Kernel<'a, (S,), S>,
    sample: &'a F,
    sampling: Sampling,
    first: u32,
    count: u32,
}

impl<C: CameraRays, S: Stepped + Type, F> StepsPass<'_, C, S, F> {
    fn render<K: Kept<R>, R: Radiance>(
        &self,
        tile: &mut Tile<'_, K::Moments>,
        variant: Variant,
        gang: usize,
    ) where
        F: Fn(&S) -> R,
    {
        let size = tile.size();
        let rows = (MOST_SAMPLES / (size.x as usize * self.count as usize)).max(1) as u32;
        for bottom in (0..size.y).step_by(rows as usize) {
            let origin = tile.origin() + uvec2(0, bottom);
            let part = uvec2(size.x, rows.min(size.y - bottom));
            let task = StepsTask { pass: self, gang, origin, size: part };
            let samples = match variant {
                Variant::Wgsl => panic!("WGSL runs on a device: use raydsl::gpu::GpuScheduler"),
                Variant::Scalar => task.one_by_one(&|(state,)| self.step.call((state,))),
                packet => self.step.with_packets(packet, task),
            };
            let mut of_pixels = samples.chunks(self.count as usize);
            for row in bottom..bottom + part.y {
                for (moments, samples) in tile.row(row).iter_mut().zip(&mut of_pixels) {
                    *moments = K::none();
                    samples.iter().for_each(|sample| K::add(moments, *sample));
                }
            }
        }
    }
}

/// All samples of some rows of a tile's pixels, row by row.
struct StepsTask<'a, C, S: Type, F> {
    pass: &'a StepsPass<'a, C, S, F>,
    gang: usize,
    origin: UVec2,
    size: UVec2,
}

impl<C: CameraRays, S: Stepped + Type, F: Fn(&S) -> R, R: Radiance> StepsTask<'_, C, S, F> {
    fn total(&self) -> usize {
        self.size.x as usize * self.size.y as usize * self.pass.count as usize
    }

    /// Returns the pixel and the index of a sample.
    fn place(&self, number: usize) -> (UVec2, u32) {
        let (count, width) = (self.pass.count as usize, self.size.x as usize);
        let (pixel, sample) = (number / count, (number % count) as u32);
        let place = uvec2((pixel % width) as u32, (pixel / width) as u32);
        (self.origin + place, self.pass.first.saturating_add(sample))
    }

    fn one_by_one(&self, step: &dyn Fn((S,)) -> S) -> Vec<R> {
        let Sampling { pixels, method, seed, planned } = self.pass.sampling;
        let whole = |number| {
            let (pixel, index) = self.place(number);
            let (at, lens, sampler) =
                places(pixel, seed, index, planned, pixels, method, C::HAS_LENS);
            let mut state = S::begin(self.pass.rays.lens_ray(at.x, at.y, lens), sampler);
            loop {
                state = step((state,));
                if state.is_over() {
                    return (self.pass.sample)(&state);
                }
            }
        };
        (0..self.total()).map(whole).collect()
    }

    /// Adds the states of samples before their first step.
    #[inline(always)]
    fn begin_on<L: Lanes>(&self, lanes: L, numbers: &[usize], states: &mut Vec<(S,)>) {
        let Sampling { pixels, method, seed, planned } = self.pass.sampling;
        let m = &Packet::with_count(lanes, numbers.len());
        let mut of_lanes = [(UVec2::ZERO, 0); 64];
        for (place, number) in of_lanes.iter_mut().zip(numbers) {
            *place = self.place(*number);
        }
        let pixel = X2 {
            x: U(lanes.u32_from_fn(|l| of_lanes[l].0.x)),
            y: U(lanes.u32_from_fn(|l| of_lanes[l].0.y)),
        };
        let index = U(lanes.u32_from_fn(|l| of_lanes[l].1));
        let [seed, planned] = [seed, planned].map(|n| U(lanes.u32(n)));
        let method = Type::splat(m, method);
        let (at, lens, sampler) =
            places::on(m, pixel, seed, index, planned, pixels, method, C::HAS_LENS);
        let ray = C::lens_ray_on(m, C::splat(m, self.pass.rays), at.x, at.y, lens);
        let state = S::begin_on(m, ray, sampler);
        states.extend((0..numbers.len()).map(|l| (S::lane(&state, l),)));
    }
}

impl<C, S, F, R> PacketTask<(S,), S> for StepsTask<'_, C, S, F>
where
    C: CameraRays,
    S: Stepped + Type,
    F: Fn(&S) -> R,
    R: Radiance,
{
    type Output = Vec<R>;

    fn run<L: Lanes>(self, lanes: L, kernel: &PacketKernel<'_, L, (S,), S>) -> Vec<R> {
        let total = self.total();
        let (mut samples, mut taken) = (Vec::new(), 0);
        let (mut states, mut after) = (Vec::with_capacity(POOL), Vec::with_capacity(POOL));
        let mut numbers: Vec<usize> = Vec::with_capacity(POOL);
        let mut begun = 0;
        loop {
            // New samples are behind the others, so that those in a packet are about as old as each
            // other, and their rays alike.
            while begun < total && numbers.len() + L::N <= POOL {
                let first = numbers.len();
                numbers.extend(begun..total.min(begun + L::N));
                begun += numbers.len() - first;
                lanes.vectorize(
                    #[inline(always)]
                    || self.begin_on(lanes, &numbers[first..], &mut states),
                );
            }
            let Some((first,)) = states.first() else { break };
            if samples.is_empty() {
                samples.resize(total, (self.pass.sample)(first));
            }

            // Make a step of all, and keep those that are not over.
            after.resize(states.len(), *first);
            run_in_gangs(lanes, self.gang, kernel, &states, &mut after);
            let mut kept = 0;
            for (i, state) in after.iter().enumerate() {
                if state.is_over() {
                    samples[numbers[i]] = (self.pass.sample)(state);
                    taken += 1;
                } else {
                    states[kept].0 = *state;
                    numbers[kept] = numbers[i];
                    kept += 1;
                }
            }
            states.truncate(kept);
            numbers.truncate(kept);
        }
        assert_eq!(taken, total, "each sample is over once");
        samples
    }

    fn scalar(self, kernel: &(dyn Fn((S,)) -> S + Send + Sync)) -> Vec<R> {
        self.one_by_one(kernel)
    }
}
