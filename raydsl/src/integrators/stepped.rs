//! Samples that take several steps.

use super::path_tracing::PathState;
use crate::geometry::Ray;
use crate::kernel;
use crate::sampling::Sampler;

/// The state of a sample that takes several steps, each a call of a kernel from a state to the next:
/// see [`accumulate_steps`](crate::render::TiledScheduler::accumulate_steps).
///
/// ```
/// use raydsl::integrators::Stepped;
/// use raydsl::prelude::*;
/// use raydsl::{Type, kernel};
///
/// /// How many numbers it takes to draw one below 0.1.
/// #[derive(Clone, Copy, Type)]
/// struct Patience {
///     sampler: Sampler,
///     last: f32,
///     count: f32,
/// }
///
/// #[kernel]
/// impl Stepped for Patience {
///     fn begin(_ray: Ray, sampler: Sampler) -> Self {
///         Patience { sampler, last: 1.0, count: 0.0 }
///     }
///
///     fn is_over(&self) -> bool {
///         self.last < 0.1
///     }
/// }
///
/// let step = kernel!(|state: Patience| {
///     let mut sampler = state.sampler;
///     let last = sampler.next_1d();
///     Patience { sampler, last, count: state.count + 1.0 }
/// });
/// let camera = Pinhole::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 0.9);
/// let sampling = Sampling::new(64).method(SampleMethod::Random);
/// let (scheduler, mut film) = (TiledScheduler::new(), Film::new(16, 16));
/// scheduler.accumulate_steps(&camera, &step, |state| state.count, &sampling, &mut film, 64);
/// let mean = film.image().pixels().iter().map(|p| p.x).sum::<f32>() / 256.0;
/// assert!((mean - 10.0).abs() < 0.5, "{mean}");
/// ```
#[kernel]
pub trait Stepped {
    /// Returns the state of a sample before its first step.
    fn begin(ray: Ray, sampler: Sampler) -> Self;

    /// Returns whether the last step was made: every sample must come to that, after one step or
    /// more.
    fn is_over(&self) -> bool;
}

#[kernel]
impl Stepped for PathState {
    fn begin(ray: Ray, sampler: Sampler) -> Self {
        PathState::new(ray, sampler)
    }

    fn is_over(&self) -> bool {
        self.is_over
    }
}
