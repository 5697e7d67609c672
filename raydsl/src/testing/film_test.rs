//! The inputs of a test of agreement: parameters, or the samples of a film.

use std::borrow::Cow;

use glam::uvec2;

use super::explain::spread;
use super::{MeansAgreement, MeansTest};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::machine::Type;
use crate::render::{FilmArgs, Radiance};

/// The number of samples that are compared one by one.
const SAMPLES: usize = 1024;

/// Compares means, if called.
#[doc(hidden)]
pub type MeansOf<'a> = Box<dyn Fn() -> Result<MeansAgreement, String> + 'a>;

/// The inputs on which variants are compared: a slice, a `Vec` or an array of the kernel's
/// parameters, tuples, or of the only parameter of one that has no other; or a [`FilmTest`].
pub trait Inputs<A: Type, R: Type> {
    /// Returns the parameters.
    fn inputs(&self) -> Cow<'_, [A]>;

    /// Returns a comparison of the variants' pictures, if there are some.
    #[doc(hidden)]
    fn means<'a>(&'a self, _kernel: &'a Kernel<'_, A, R>) -> Option<MeansOf<'a>> {
        None
    }
}

macro_rules! lists {
    ($([$($g:tt)*] $a:ident, $t:ty;)+) => {
        $(
            impl<$a: Type, R: Type, $($g)*> Inputs<$a, R> for $t {
                fn inputs(&self) -> Cow<'_, [$a]> {
                    Cow::Borrowed(self)
                }
            }

            impl<$a: Type, R: Type, $($g)*> Inputs<($a,), R> for $t {
                fn inputs(&self) -> Cow<'_, [($a,)]> {
                    self.iter().map(|a| (*a,)).collect()
                }
            }
        )+
    };
}

lists! {
    [] A, [A];
    [] A, Vec<A>;
    [const N: usize] A, [A; N];
}

/// The samples of a film, on which [`assert_variants_agree!`](crate::assert_variants_agree)
/// compares the variants of a kernel for pictures.
///
/// Single samples are compared as any parameters are: 1024 of them, spread over the pixels and the
/// replications, of whose differences up to 16 are explained. The means of the whole film are compared by a [`MeansTest`]; they decide where
/// rounding leaves so many decisions open that single samples say little, as in a path tracer.
///
/// ```
/// use raydsl::assert_variants_agree;
/// use raydsl::prelude::*;
/// use raydsl::testing::FilmTest;
///
/// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
/// let fog = kernel!(|ray: Ray, sampler: Sampler| {
///     let mut sampler = sampler;
///     let t = -2.0 * log2(1.0 - sampler.next_1d());
///     if ray.at(t).y < 0.0 { 0.2 } else { 1.0 }
/// });
/// assert_variants_agree!(&fog, &FilmTest::new(&camera, 32, 24));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FilmTest<'c, C> {
    camera: &'c C,
    size: (u32, u32),
    test: MeansTest,
}

impl<'c, C: Camera> FilmTest<'c, C> {
    /// Creates a test on a film of `width` by `height` pixels.
    pub const fn new(camera: &'c C, width: u32, height: u32) -> Self {
        Self { camera, size: (width, height), test: MeansTest::new() }
    }

    /// Sets the samples, and which bias is found: [`MeansTest::new`] unless set.
    #[must_use]
    pub const fn means(self, test: MeansTest) -> Self {
        Self { test, ..self }
    }
}

impl<C: Camera, A: FilmArgs, R: Radiance> Inputs<A, R> for FilmTest<'_, C> {
    fn inputs(&self) -> Cow<'_, [A]> {
        let (width, height) = self.size;
        let rays = self.camera.begin_frame(width, height);
        let replications: Vec<_> = self.test.replications().collect();
        let count = width as usize * height as usize * replications.len();
        let input = |i: usize| {
            let (pixel, sampling) = (i / replications.len(), &replications[i % replications.len()]);
            let pixel = uvec2(pixel as u32 % width, pixel as u32 / width);
            let (ray, sampler) = sampling.sample(&rays, pixel, 0);
            A::of(ray, pixel, || sampler)
        };
        spread(count, SAMPLES).into_iter().map(input).collect()
    }

    fn means<'a>(&'a self, kernel: &'a Kernel<'_, A, R>) -> Option<MeansOf<'a>> {
        Some(Box::new(|| on_device(self, kernel)))
    }
}

/// Compares the means of the device's films with those of the CPU's packets, which have the bits of
/// the scalar variant.
#[cfg(all(feature = "gpu", not(target_family = "wasm")))]
fn on_device<C: Camera, A: FilmArgs, R: Radiance>(
    film_test: &FilmTest<'_, C>,
    kernel: &Kernel<'_, A, R>,
) -> Result<MeansAgreement, String> {
    use super::PairedMeans;
    use crate::render::{Film, Renderer, TiledScheduler};
    let FilmTest { camera, size: (width, height), test } = film_test;
    let (cpu, gpu) = (TiledScheduler::new(), super::shared()?);
    let mut means = PairedMeans::new(test, *width, *height);
    let (mut expected, mut found) = (Film::new(*width, *height), Film::new(*width, *height));
    for sampling in test.replications() {
        expected.clear();
        found.clear();
        cpu.accumulate(*camera, kernel, &sampling, &mut expected, sampling.planned);
        gpu.accumulate(*camera, kernel, &sampling, &mut found, sampling.planned)
            .map_err(|e| e.to_string())?;
        means.add(&expected, &found);
    }
    Ok(means.agreement())
}

#[cfg(not(all(feature = "gpu", not(target_family = "wasm"))))]
fn on_device<C: Camera, A: FilmArgs, R: Radiance>(
    _: &FilmTest<'_, C>,
    _: &Kernel<'_, A, R>,
) -> Result<MeansAgreement, String> {
    Err(super::NO_DEVICE.to_owned())
}
