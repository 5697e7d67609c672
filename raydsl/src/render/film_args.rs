//! Kernel arguments for a sample of a pixel.

use glam::UVec2;

use crate::geometry::{Ray, RayOn};
use crate::machine::{Machine, Type};
use crate::sampling::{Sampler, SamplerOn};

/// The parameters of a kernel for pictures: a ray, and optionally its pixel and a sampler for this
/// sample.
///
/// `kernel!(|ray: Ray| ..)`, `kernel!(|ray: Ray, sampler: Sampler| ..)`, `kernel!(|ray: Ray, pixel:
/// UVec2| ..)`, `kernel!(|ray: Ray, pixel: UVec2, sampler: Sampler| ..)`. Pixel (0, 0) is at the
/// lower left. Arguments that a kernel does not take are not computed.
pub trait FilmArgs: Type {
    /// Returns the arguments.
    fn of(ray: Ray, pixel: UVec2, sampler: impl FnOnce() -> Sampler) -> Self;

    /// Lifts [`FilmArgs::of`].
    #[doc(hidden)]
    fn on_film<M: Machine>(
        ray: RayOn<M>,
        pixel: <UVec2 as Type>::On<M>,
        sampler: impl FnOnce() -> SamplerOn<M>,
    ) -> Self::On<M>;
}

macro_rules! film_args {
    ($(($($ty:ty),+): $ray:ident, $pixel:pat, $sampler:pat => $args:expr;)+) => {
        $(
            impl FilmArgs for ($($ty,)+) {
                #[inline(always)]
                fn of($ray: Ray, $pixel: UVec2, $sampler: impl FnOnce() -> Sampler) -> Self {
                    $args
                }

                #[inline(always)]
                fn on_film<M: Machine>(
                    $ray: RayOn<M>,
                    $pixel: <UVec2 as Type>::On<M>,
                    $sampler: impl FnOnce() -> SamplerOn<M>,
                ) -> Self::On<M> {
                    $args
                }
            }
        )+
    };
}

film_args! {
    (Ray): ray, _, _ => (ray,);
    (Ray, Sampler): ray, _, sampler => (ray, sampler());
    (Ray, UVec2): ray, pixel, _ => (ray, pixel);
    (Ray, UVec2, Sampler): ray, pixel, sampler => (ray, pixel, sampler());
}
