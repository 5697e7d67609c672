//! One computation of a case.

use core::cell::Cell;
use std::time::{Duration, Instant};

use glam::{DVec4, Vec3, uvec2};

use super::case::{Backend, Method};
use super::work::Work;
use crate::Missing;
use raydsl::camera::{Camera, Orthographic};
use raydsl::geometry::Ray;
use raydsl::kernel::{Kernel, Variant};
use raydsl::render::{Film, FilmArgs, PixelSampler, Radiance, Renderer, Sampling, SimpleScheduler};
use raydsl::sampling::Sampler;

/// What a computation gave, and what it cost besides time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Estimates {
    /// The estimates: one for each pixel, row by row from the bottom, or however many there are.
    pub values: Vec<f64>,
    /// Samples taken in all.
    pub samples: u64,
    /// What the kernel counts itself, in all: steps, look-ups of a density.
    pub counted: Option<u64>,
    /// Rays and what else is known to have been done, in all.
    pub work: Work,
    /// Columns and rows, if the values are a picture's. Those of [`Run::film`] are.
    pub picture: Option<(u32, u32)>,
}

impl Estimates {
    /// Of numbers and the samples that they took in all.
    pub fn new(values: Vec<f64>, samples: u64) -> Self {
        Self { values, samples, counted: None, work: Work::default(), picture: None }
    }

    /// Every sample traces so many rays.
    #[must_use]
    pub fn rays_per_sample(self, rays: u64) -> Self {
        let rays = Some(self.samples.saturating_mul(rays));
        Self { work: Work { rays, ..self.work }, ..self }
    }
}

/// How a case is to be computed: by which method, on what, with which value of the knob and which
/// seed.
///
/// [`Run::film`] and [`Run::integral`] run a kernel so; a case that does something else asks for
/// the parts and makes [`Estimates`] of its own.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    pub(super) method: &'a Method,
    pub(super) backend: Backend,
    pub(super) knob: u32,
    /// Of each pixel, if the knob does not say it.
    pub(super) samples: Option<u32>,
    pub(super) seed: u32,
    pub(super) size: (u32, u32),
    /// Where to note the kernels' text, if it is asked for.
    pub(super) code: Option<&'a CodeHash>,
    #[cfg(feature = "gpu")]
    pub(super) gpu: Option<&'a raydsl::gpu::GpuScheduler>,
}

impl<'a> Run<'a> {
    /// A run of one pixel, with seed 0 and without a device.
    pub fn new(method: &'a Method, backend: Backend, knob: u32) -> Self {
        Self {
            method,
            backend,
            knob,
            samples: None,
            seed: 0,
            size: (1, 1),
            code: None,
            #[cfg(feature = "gpu")]
            gpu: None,
        }
    }

    /// With another seed.
    #[must_use]
    pub fn seeded(self, seed: u32) -> Self {
        Self { seed, ..self }
    }

    /// With a film of this size.
    #[must_use]
    pub fn sized(self, width: u32, height: u32) -> Self {
        Self { size: (width, height), ..self }
    }

    /// With so many samples of each pixel, at least one, whatever the knob says: for a knob that
    /// counts steps, and 1 for a method without random numbers.
    #[must_use]
    pub fn with_samples(self, samples: u32) -> Self {
        Self { samples: Some(samples.max(1)), ..self }
    }

    /// With a device for [`Variant::Wgsl`].
    #[cfg(feature = "gpu")]
    #[must_use]
    pub fn on(self, gpu: &'a raydsl::gpu::GpuScheduler) -> Self {
        Self { gpu: Some(gpu), ..self }
    }

    /// The method.
    pub fn method(&self) -> &Method {
        self.method
    }

    /// What runs it.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// The knob's value: samples of each pixel, steps ...
    pub fn knob(&self) -> u32 {
        self.knob
    }

    /// Each repetition has another one.
    pub fn seed(&self) -> u32 {
        self.seed
    }

    /// The film's size.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Renders a film, with as many samples of each pixel as the knob says, or
    /// [`Run::with_samples`], jittered by the method, on one thread of the CPU or on the device.
    /// Estimates are the red channels of its pixels.
    ///
    /// # Errors
    ///
    /// If there is no device for WGSL, or it refuses.
    pub fn film<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
    ) -> Result<Estimates, Missing> {
        Ok(self.picture(&self.means(camera, kernel, PixelSampler::Jittered)?))
    }

    /// The same of a kernel that gives the light in red, and in green what it counted on the way:
    /// nodes visited, steps, look-ups.
    ///
    /// # Errors
    ///
    /// If there is no device for WGSL, or it refuses.
    pub fn film_counted<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
    ) -> Result<Estimates, Missing> {
        let means = self.means(camera, kernel, PixelSampler::Jittered)?;
        let counted: f64 = means.iter().map(|p| p.y * f64::from(self.samples())).sum();
        Ok(Estimates { counted: Some(counted.round() as u64), ..self.picture(&means) })
    }

    /// Runs a kernel that looks at nothing but its sampler: every pixel is an estimate of one
    /// integral of its own samples, which all go to the kernel. Its ray is the same everywhere.
    ///
    /// # Errors
    ///
    /// If there is no device for WGSL, or it refuses.
    pub fn integral<A: FilmArgs, R: Radiance>(
        &self,
        kernel: &Kernel<'_, A, R>,
    ) -> Result<Estimates, Missing> {
        Ok(self.red(&self.means(&integral_camera(), kernel, PixelSampler::Center)?))
    }

    /// Counts what [`Run::film`] does: runs `count` on the host for the ray and the sampler of each
    /// of its samples, and adds up. For what a kernel cannot count itself, or is not to count while
    /// it is timed; see [`Case::counted`](super::Case::counted).
    pub fn film_work<C: Camera>(&self, camera: &C, count: impl Fn(Ray, Sampler) -> Work) -> Work {
        self.each_sample(camera, PixelSampler::Jittered, count)
    }

    /// Counts what [`Run::integral`] does, in the same way.
    pub fn integral_work(&self, count: impl Fn(Sampler) -> Work) -> Work {
        self.each_sample(&integral_camera(), PixelSampler::Center, |_, sampler| count(sampler))
    }

    fn each_sample<C: Camera>(
        &self,
        camera: &C,
        pixels: PixelSampler,
        count: impl Fn(Ray, Sampler) -> Work,
    ) -> Work {
        let (width, height) = self.size;
        let rays = camera.begin_frame(width, height);
        let sampling = self.sampling(pixels);
        let one = |(x, y, index)| {
            let (ray, sampler) = sampling.sample(&rays, uvec2(x, y), index);
            count(ray, sampler)
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let samples = pixels.flat_map(|(x, y)| (0..self.samples()).map(move |i| (x, y, i)));
        samples.map(one).fold(Work::default(), |all, work| all + work)
    }

    /// Of each pixel.
    fn samples(&self) -> u32 {
        self.samples.unwrap_or(self.knob)
    }

    fn sampling(&self, pixels: PixelSampler) -> Sampling {
        Sampling::new(self.samples()).method(self.method.sampling).seed(self.seed).pixels(pixels)
    }

    fn red(&self, means: &[DVec4]) -> Estimates {
        let samples = means.len() as u64 * u64::from(self.samples());
        Estimates::new(means.iter().map(|p| p.x).collect(), samples)
    }

    fn picture(&self, means: &[DVec4]) -> Estimates {
        Estimates { picture: Some(self.size), ..self.red(means) }
    }

    /// The mean colour of each pixel.
    fn means<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        pixels: PixelSampler,
    ) -> Result<Vec<DVec4>, Missing> {
        if let Some(code) = self.code {
            code.add(|| kernel.wgsl());
        }
        let sampling = self.sampling(pixels);
        let mut film = Film::new(self.size.0, self.size.1);
        match self.backend {
            Backend::F64 => {
                return Ok(sampling.means_in_f64(camera, kernel, self.size, self.samples()));
            }
            Backend::Variant(Variant::Wgsl) => {
                self.on_device(camera, kernel, &sampling, &mut film)?;
            }
            Backend::Variant(cpu) => {
                let scheduler = SimpleScheduler::new().variant(cpu);
                scheduler.accumulate(camera, kernel, &sampling, &mut film, self.samples());
            }
        }
        Ok(film.means().collect())
    }

    #[cfg(feature = "gpu")]
    fn on_device<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
    ) -> Result<(), Missing> {
        let gpu = self.gpu.ok_or_else(|| Missing::NoDevice("there is no device".to_owned()))?;
        let done = gpu.accumulate(camera, kernel, sampling, film, self.samples());
        done.map(drop).map_err(|e| Missing::Refused(e.to_string()))
    }

    #[cfg(not(feature = "gpu"))]
    fn on_device<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        _: &C,
        _: &Kernel<'_, A, R>,
        _: &Sampling,
        _: &mut Film,
    ) -> Result<(), Missing> {
        Err(Missing::NoDevice("raydsl-report was built without the feature `gpu`".to_owned()))
    }
}

/// Of integrals, which do not look at their ray.
fn integral_camera() -> Orthographic {
    Orthographic::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0)
}

/// The hash of the WGSL of all kernels that a run used: FNV-1a of 64 bits. (Fowler, Noll, Vo and
/// Eastlake, "The FNV Non-Cryptographic Hash Algorithm", RFC 9923.)
#[derive(Debug, Default)]
pub(super) struct CodeHash {
    hash: Cell<Option<u64>>,
    /// How long it took to write the text, which is no part of the run.
    took: Cell<Duration>,
}

impl CodeHash {
    fn add(&self, text: impl FnOnce() -> String) {
        let start = Instant::now();
        let before = self.hash.get().unwrap_or(0xcbf2_9ce4_8422_2325);
        let step = |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        self.hash.set(Some(text().bytes().fold(before, step)));
        self.took.set(self.took.get() + start.elapsed());
    }

    /// None if the run used no kernel.
    pub(super) fn hash(&self) -> Option<u64> {
        self.hash.get()
    }

    pub(super) fn took(&self) -> Duration {
        self.took.get()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the algorithm's authors.
    #[test]
    fn hashes_are_fnv_1a() {
        let of = |texts: &[&str]| {
            let code = CodeHash::default();
            texts.iter().for_each(|t| code.add(|| (*t).to_owned()));
            code.hash()
        };
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[""]), Some(0xcbf2_9ce4_8422_2325));
        assert_eq!(of(&["a"]), Some(0xaf63_dc4c_8601_ec8c));
        assert_eq!(of(&["foobar"]), Some(0x8594_4171_f739_67e8));
        assert_eq!(of(&["foo", "bar"]), of(&["foobar"]));
    }
}
