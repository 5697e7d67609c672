//! Passes over a film one by one, for a device that is awaited in between.

use core::marker::PhantomData;

use super::channels::Kept;
use super::film_args::FilmArgs;
use super::renderer::LARGEST_PASS;
use super::shot::Pass;
use super::{Film, Image, Radiance, Sampling};
use crate::camera::Camera;
use crate::kernel::Kernel;

/// Returns the numbers of samples of the passes that add `samples`.
pub(crate) fn passes(samples: u32) -> impl Iterator<Item = u32> {
    let first = (0..samples).step_by(LARGEST_PASS as usize);
    first.map(move |first| LARGEST_PASS.min(samples - first))
}

impl<K> Film<K> {
    /// Returns the shot of the next `count` samples of each pixel.
    pub(crate) fn pass<'a, C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &'a Kernel<'a, A, R>,
        sampling: &Sampling,
        count: u32,
    ) -> Pass<'a, C::Rays, A, R, K> {
        let rays = camera.begin_frame(self.width(), self.height());
        let (sampling, first, kept) = (*sampling, self.samples(), PhantomData);
        Pass { rays, kernel, sampling, first, count, allocation: None, kept }
    }

    /// Adds the results of that shot.
    pub(crate) fn add_pass<R: Radiance>(&mut self, pass: &Image<K::Moments>, count: u32)
    where
        K: Kept<R>,
    {
        K::join(pass, count, &mut self.store);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_add_up() {
        for samples in [0, 1, 63, 64, 65, 128, 1000] {
            let counts: Vec<u32> = passes(samples).collect();
            assert_eq!(counts.iter().sum::<u32>(), samples);
            assert!(counts.iter().all(|count| (1..=LARGEST_PASS).contains(count)), "{counts:?}");
        }
    }
}
