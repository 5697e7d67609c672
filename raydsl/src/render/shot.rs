//! The computation for each pixel of a film.

use core::marker::PhantomData;

use glam::{UVec2, Vec2, vec2};

use super::allocation::{Allocation, part_of};
use super::channels::Kept;
use super::film_args::FilmArgs;
use super::pixel_sampler::pixel_place;
use super::{PixelSampler, Radiance, Sampling};
use crate::camera::CameraRays;
use crate::kernel;
use crate::kernel::Kernel;
use crate::machine::functions::vec2;
use crate::machine::{
    Capture, Loop, Machine, Recorder, Resource, Steps, Stop, Type, U, Value, Var, X2,
};
use crate::sampling::{SampleMethod, Sampler};

/// The computation for each pixel of a film in every variant: a frame's ray, or the samples of a
/// pass.
///
/// A scheduler runs it; see [`Scheduler::run`](super::Scheduler::run). The scheduler's methods
/// create it.
pub trait Shot: Sync {
    /// The parameters of the kernel.
    type Args: FilmArgs;
    /// The result of the kernel.
    type Result: Type;
    /// The result for each pixel.
    type Output: Type;

    /// Returns the kernel.
    fn kernel(&self) -> &Kernel<'_, Self::Args, Self::Result>;

    /// Visits the buffers that it may read on a device.
    #[doc(hidden)]
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.kernel().resources(visit);
    }

    /// Computes a pixel by the user's own function.
    fn pixel(&self, pixel: UVec2) -> Self::Output;

    /// Computes a pixel on a machine, where `body` is the lifted body of the kernel.
    #[doc(hidden)]
    fn pixel_on<M: Machine>(
        &self,
        m: &M,
        pixel: X2<U<M>>,
        body: &Body<'_, M, Self>,
    ) -> <Self::Output as Type>::On<M>;
}

/// The lifted body of a shot's kernel.
pub type Body<'k, M, S> =
    dyn Fn(&M, <<S as Shot>::Args as Type>::On<M>) -> <<S as Shot>::Result as Type>::On<M> + 'k;

/// Returns the position of a sample on the film and on the lens, and the sampler after it.
#[kernel]
#[inline]
pub(crate) fn places(
    pixel: UVec2,
    seed: u32,
    index: u32,
    planned: u32,
    #[host] pixels: PixelSampler,
    method: SampleMethod,
    #[host] has_lens: bool,
) -> (Vec2, Vec2, Sampler) {
    let mut sampler = Sampler::new(pixel, seed, index, planned, method);
    let place = pixel_place(&mut sampler, pixels);
    let lens = if has_lens { sampler.next_2d() } else { vec2(0.5, 0.5) };
    (pixel.as_vec2() + place, lens, sampler)
}

/// The method of the samplers of pictures without [`Sampling`].
const METHOD: SampleMethod = SampleMethod::Sobol;

/// One ray through the centre of each pixel; a sampler, if used, is that of the first sample of
/// one.
pub(crate) struct Frame<'a, C, A: Type, R: Type> {
    pub(crate) rays: C,
    pub(crate) kernel: &'a Kernel<'a, A, R>,
}

impl<C: CameraRays, A: FilmArgs, R: Type> Shot for Frame<'_, C, A, R> {
    type Args = A;
    type Result = R;
    type Output = R;

    fn kernel(&self) -> &Kernel<'_, A, R> {
        self.kernel
    }

    fn pixel(&self, pixel: UVec2) -> R {
        let at = pixel_centre(pixel);
        let ray = self.rays.primary_ray(at.x, at.y);
        self.kernel.call(A::of(ray, pixel, || Sampler::new(pixel, 0, 0, 1, METHOD)))
    }

    #[inline(always)]
    fn pixel_on<M: Machine>(&self, m: &M, pixel: X2<U<M>>, body: &Body<'_, M, Self>) -> R::On<M> {
        let at = pixel_centre::on(m, pixel);
        let ray = C::primary_ray_on(m, m.capture("camera", self.rays), at.x, at.y);
        let method = Type::splat(m, METHOD);
        body(m, A::on_film(ray, pixel, || Sampler::new_on(m, pixel, 0u32, 0u32, 1u32, method)))
    }
}

/// Returns the centre of a pixel.
#[kernel]
#[inline]
fn pixel_centre(pixel: UVec2) -> Vec2 {
    pixel.as_vec2() + 0.5
}

/// Some samples of each pixel, of which a film keeps `K`.
pub(crate) struct Pass<'a, C, A: Type, R: Type, K = ()> {
    pub(crate) rays: C,
    pub(crate) kernel: &'a Kernel<'a, A, R>,
    pub(crate) sampling: Sampling,
    /// The index of the first sample.
    pub(crate) first: u32,
    /// The number of samples.
    pub(crate) count: u32,
    /// The allocation, if blocks differ: a pixel takes the samples whose index is below its number
    /// there.
    pub(crate) allocation: Option<&'a Allocation>,
    pub(crate) kept: PhantomData<fn() -> K>,
}

impl<C: CameraRays, A: FilmArgs, R: Radiance, K: Kept<R>> Shot for Pass<'_, C, A, R, K> {
    type Args = A;
    type Result = R;
    type Output = K::Moments;

    fn kernel(&self) -> &Kernel<'_, A, R> {
        self.kernel
    }

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.kernel.resources(visit);
        if let Some(allocation) = self.allocation {
            Capture::<Recorder>::resources(allocation.samples(), "samples_of_blocks", visit);
        }
    }

    fn pixel(&self, pixel: UVec2) -> K::Moments {
        let Sampling { pixels, method, seed, planned } = self.sampling;
        let end = self.first.saturating_add(self.count);
        let (planned, end) = match self.allocation {
            Some(a) => part_of(a.samples(), a.columns(), pixel, end),
            None => (planned, end),
        };
        let mut moments = K::none();
        for index in self.first..end {
            let (at, lens, sampler) =
                places(pixel, seed, index, planned, pixels, method, C::HAS_LENS);
            let ray = self.rays.lens_ray(at.x, at.y, lens);
            K::add(&mut moments, self.kernel.call(A::of(ray, pixel, || sampler)));
        }
        moments
    }

    #[inline(always)]
    fn pixel_on<M: Machine>(
        &self,
        m: &M,
        pixel: X2<U<M>>,
        body: &Body<'_, M, Self>,
    ) -> <K::Moments as Type>::On<M> {
        let Sampling { pixels, method, seed, planned } = self.sampling;
        let rays = m.capture("camera", self.rays);
        let seed = m.capture("seed", seed);
        let method = Type::splat(m, method);
        let first = m.capture("first_sample", self.first);
        let end = m.capture("end_of_samples", self.first.saturating_add(self.count));
        let (planned, end) = match self.allocation {
            Some(a) => {
                let samples = Capture::capture(a.samples(), m, "samples_of_blocks");
                part_of::on(m, samples, m.capture("columns_of_blocks", a.columns()), pixel, end)
            }
            None => (m.capture("planned", planned), end),
        };
        let end = Stop::new(m, end);
        let moments = Var::new(m, "moments", Value::zero(m));
        let index = Steps::new(m, "sample", first, self.first);
        let samples = Loop::new(m);
        while end.is_after(m, &samples, &index) {
            let index_now = index.get(m);
            let (at, lens, sampler) =
                places::on(m, pixel, seed, index_now, planned, pixels, method, C::HAS_LENS);
            let ray = C::lens_ray_on(m, rays, at.x, at.y, lens);
            let result = body(m, A::on_film(ray, pixel, || sampler));
            K::add_on(m, &moments, result);
            samples.continuing(m);
            index.advance(m);
            if !samples.again(m) {
                break;
            }
        }
        samples.end(m);
        moments.get(m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Pinhole, ThinLens};
    use crate::machine::wgsl::Limits;
    use crate::prelude::{Ray, Vec3, kernel};
    use crate::render::recorded::recorded;

    fn wgsl<S: Shot>(shot: &S) -> String {
        recorded(shot).module(&Limits::default()).source
    }

    fn pass_of<'a, C, R: Type>(
        rays: C,
        kernel: &'a Kernel<'a, (Ray,), R>,
        sampling: Sampling,
    ) -> Pass<'a, C, (Ray,), R> {
        Pass { rays, kernel, sampling, first: 0, count: 8, allocation: None, kept: PhantomData }
    }

    /// The kernel draws in loops, by the method of the film, which it does not name.
    #[test]
    fn a_film_has_its_method_alone() {
        let pinhole = Pinhole::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0);
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            let mut sampler = sampler;
            let mut light = 0.0;
            for bounce in 0..8 {
                for _ in 0..bounce {
                    light += sampler.next_2d().x;
                }
                if sampler.next_1d() > 0.9 {
                    break;
                }
            }
            light * ray.direction.z
        });
        for (method, sobol, stratified) in [
            (SampleMethod::Random, false, false),
            (SampleMethod::Stratified, false, true),
            (SampleMethod::Sobol, true, false),
        ] {
            let sampling = Sampling::new(16).method(method);
            let (rays, allocation) = (pinhole.begin_frame(4, 4), None);
            let (first, count, kept) = (0, 8, PhantomData::<fn()>);
            let text =
                wgsl(&Pass { rays, kernel: &kernel, sampling, first, count, allocation, kept });
            let has = ["sobol", "stratified"].map(|name| text.contains(name));
            assert_eq!(has, [sobol, stratified], "{text}");
            assert_eq!(text.contains("fn random_"), !sobol, "{text}");
        }
        // A frame has no sampling.
        let frame = wgsl(&Frame { rays: pinhole.begin_frame(4, 4), kernel: &kernel });
        assert!(frame.contains("sobol") && !frame.contains("random_"), "{frame}");
    }

    #[test]
    fn what_is_not_asked_for_leaves_no_trace() {
        let pinhole = Pinhole::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0);
        let lens = ThinLens::new(pinhole, 0.1, 3.0);
        let kernel = kernel!(|ray: Ray| ray.direction.y);
        let frame = wgsl(&Frame { rays: pinhole.begin_frame(4, 4), kernel: &kernel });
        for word in ["Sampler", "pcg4d", "sobol", "lens", "loop"] {
            assert!(!frame.contains(word), "{word}\n{frame}");
        }
        let sampling = Sampling::new(16);
        let stratified = sampling.method(SampleMethod::Stratified);
        let centred = sampling.pixels(PixelSampler::Center);
        let pass = |sampling| {
            let rays = pinhole.begin_frame(4, 4);
            wgsl(&pass_of(rays, &kernel, sampling))
        };
        assert!(pass(sampling).contains("sobol") && !pass(sampling).contains("permuted"));
        assert!(pass(stratified).contains("permuted") && !pass(stratified).contains("sobol"));
        assert!(!pass(centred).contains("sobol") && !pass(centred).contains("disk"));
        let rays = lens.begin_frame(4, 4);
        let blurred = wgsl(&pass_of(rays, &kernel, centred));
        assert!(blurred.contains("sobol") && blurred.contains("disk"), "{blurred}");
    }
}
