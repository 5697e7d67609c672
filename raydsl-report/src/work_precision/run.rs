//! Runs: single computations of a case.

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

/// The result of a run, and its cost besides time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Estimates {
    /// The estimates: one for each pixel, row by row from the bottom, or any number of them.
    pub values: Vec<f64>,
    /// Samples taken in all.
    pub samples: u64,
    /// The kernel's own count, in all: steps, look-ups of a density.
    pub counted: Option<u64>,
    /// The rays and other known work, in all.
    pub work: Work,
    /// Columns and rows, if the values are a picture, as those of [`Run::film`] are.
    pub picture: Option<(u32, u32)>,
}

impl Estimates {
    /// Creates estimates from numbers and their total samples.
    pub fn new(values: Vec<f64>, samples: u64) -> Self {
        Self { values, samples, counted: None, work: Work::default(), picture: None }
    }

    /// Sets the number of rays that every sample traces.
    #[must_use]
    pub fn rays_per_sample(self, rays: u64) -> Self {
        let rays = Some(self.samples.saturating_mul(rays));
        Self { work: Work { rays, ..self.work }, ..self }
    }
}

/// The settings of a run: the method, the backend, the value of the knob and the seed.
///
/// [`Run::film`] and [`Run::integral`] run a kernel with them; a case of another kind reads the
/// settings and returns [`Estimates`] of its own.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    pub(super) method: &'a Method,
    pub(super) backend: Backend,
    pub(super) knob: u32,
    /// Samples per pixel, if the knob does not give them.
    pub(super) samples: Option<u32>,
    pub(super) seed: u32,
    pub(super) size: (u32, u32),
    /// The hash of the kernels' text, if it is wanted.
    pub(super) code: Option<&'a CodeHash>,
    #[cfg(feature = "gpu")]
    pub(super) gpu: Option<&'a raydsl::gpu::GpuScheduler>,
}

impl<'a> Run<'a> {
    /// Creates a run of one pixel, with seed 0 and without a device.
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

    /// Sets the seed.
    #[must_use]
    pub fn seeded(self, seed: u32) -> Self {
        Self { seed, ..self }
    }

    /// Sets the film's size.
    #[must_use]
    pub fn sized(self, width: u32, height: u32) -> Self {
        Self { size: (width, height), ..self }
    }

    /// Sets the samples per pixel, at least one, regardless of the knob: for a knob that counts
    /// steps, and 1 for a deterministic method.
    #[must_use]
    pub fn with_samples(self, samples: u32) -> Self {
        Self { samples: Some(samples.max(1)), ..self }
    }

    /// Sets a device for [`Variant::Wgsl`].
    #[cfg(feature = "gpu")]
    #[must_use]
    pub fn on(self, gpu: &'a raydsl::gpu::GpuScheduler) -> Self {
        Self { gpu: Some(gpu), ..self }
    }

    /// Returns the method.
    pub fn method(&self) -> &Method {
        self.method
    }

    /// Returns the backend.
    pub fn backend(&self) -> Backend {
        self.backend
    }

    /// Returns the knob's value: samples per pixel, steps ...
    pub fn knob(&self) -> u32 {
        self.knob
    }

    /// Returns the seed, different in each repetition.
    pub fn seed(&self) -> u32 {
        self.seed
    }

    /// Returns the device for [`Variant::Wgsl`], for cases that run it themselves.
    #[cfg(feature = "gpu")]
    pub fn device(&self) -> Option<&'a raydsl::gpu::GpuScheduler> {
        self.gpu
    }

    /// Returns the film's size.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Renders a film, with the samples per pixel of the knob, or of [`Run::with_samples`],
    /// jittered by the method, on one thread of the CPU or on the device. Estimates are the red
    /// channels of its pixels.
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

    /// Renders a film as [`Run::film`] does, with all rays through the centres of pixels: for
    /// methods without random numbers.
    ///
    /// # Errors
    ///
    /// If there is no device for WGSL, or it refuses.
    pub fn centers<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
    ) -> Result<Estimates, Missing> {
        Ok(self.picture(&self.means(camera, kernel, PixelSampler::Center)?))
    }

    /// Renders a film with a kernel that returns the light in red, and its own count in green:
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

    /// Runs a kernel that uses its sampler only: every pixel is an estimate of one integral from
    /// its own samples, all of whose dimensions the kernel gets. Its ray is the same everywhere.
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

    /// Counts the work of [`Run::film`]: runs `count` on the host for the ray and the sampler of
    /// each of its samples, and adds up. For work that a kernel cannot count itself, or should not
    /// while it is timed; see [`Case::counted`](super::Case::counted).
    pub fn film_work<C: Camera>(&self, camera: &C, count: impl Fn(Ray, Sampler) -> Work) -> Work {
        self.each_sample(camera, PixelSampler::Jittered, count)
    }

    /// Counts the work of [`Run::integral`], in the same way.
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

    /// Returns the samples per pixel.
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

    /// Returns the mean colour of each pixel.
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

/// Returns the camera of integrals, which ignore their ray.
fn integral_camera() -> Orthographic {
    Orthographic::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0)
}

/// The hash of the WGSL of all kernels that a run used: FNV-1a of 64 bits. (Fowler, Noll, Vo and
/// Eastlake, "The FNV Non-Cryptographic Hash Algorithm", RFC 9923.)
#[derive(Debug, Default)]
pub(super) struct CodeHash {
    hash: Cell<Option<u64>>,
    /// The time it took to write the text, which is no part of the run.
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

    /// Returns the hash; `None` if the run used no kernel.
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

    /// Tests values given by the algorithm's authors.
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
