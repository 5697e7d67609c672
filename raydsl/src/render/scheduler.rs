//! Schedulers: kernels over films and batches on the CPU.

use core::convert::Infallible;
use core::ops::ControlFlow;

use super::renderer::{Effort, Renderer};
use super::shot::Shot;
use super::watch::{Observer, Watch};
use super::{Image, UntilError};
use crate::kernel::Kernel;
use crate::machine::Type;

/// A scheduler, which runs a kernel on the CPU for every pixel of a film, or for every element of a
/// batch.
///
/// The result is the same for every scheduler, number of threads and CPU variant. A scheduler of
/// your own implements [`Scheduler::run`], which distributes tiles, and [`Scheduler::run_batch`];
/// it is then a [`Renderer`]:
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::render::{Shot, Watch};
///
/// /// Four threads, each with every fourth tile.
/// struct Four;
///
/// impl Scheduler for Four {
///     fn run<S: Shot>(&self, shot: &S, image: &mut Image<S::Output>, watch: &Watch<'_>) {
///         let mut shares = [const { Vec::new() }; 4];
///         for (i, tile) in image.tiles(32).enumerate() {
///             shares[i % 4].push(tile);
///         }
///         std::thread::scope(|scope| {
///             for share in shares {
///                 scope.spawn(|| {
///                     for mut tile in share {
///                         if !watch.is_stopped() {
///                             tile.render(shot, Variant::widest());
///                             watch.advance(tile.area());
///                         }
///                     }
///                 });
///             }
///         });
///     }
///
///     fn run_batch<A: raydsl::Type, R: raydsl::Type>(
///         &self,
///         kernel: &Kernel<'_, A, R>,
///         inputs: &[A],
///         outputs: &mut [R],
///     ) {
///         kernel.run(Variant::widest(), inputs, outputs);
///     }
/// }
///
/// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
/// let sky = kernel!(|ray: Ray| ray.direction.y);
/// let (mut a, mut b) = (Image::filled(100, 70, 0.0), Image::filled(100, 70, 0.0));
/// Four.frame(&camera, &sky, &mut a);
/// SimpleScheduler::new().frame(&camera, &sky, &mut b);
/// assert_eq!(a, b);
/// ```
pub trait Scheduler {
    /// Runs `shot` for every pixel of `image`, reports completed pixels to `watch` and returns
    /// early when it is stopped.
    fn run<S: Shot>(&self, shot: &S, image: &mut Image<S::Output>, watch: &Watch<'_>);

    /// Runs a kernel over `inputs`; `outputs` has the same length.
    ///
    /// # Panics
    ///
    /// If the lengths differ.
    fn run_batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    );
}

/// On the CPU nothing fails, and no time is measured.
impl<T: Scheduler + ?Sized> Renderer for T {
    type Timing = ();
    type Error = Infallible;
    type UntilError = UntilError;
    type Outcome<V> = V;

    fn add_timing((): &mut (), (): ()) {}

    fn outcome<V>(result: Result<V, Infallible>) -> V {
        let Ok(value) = result;
        value
    }

    fn result<V>(outcome: V) -> Result<V, Infallible> {
        Ok(outcome)
    }

    fn shoot<S: Shot>(
        &self,
        shot: &S,
        _effort: Effort,
        image: &mut Image<S::Output>,
        observer: Option<Observer<'_>>,
    ) -> Result<ControlFlow<()>, Infallible> {
        let total = image.pixels().len();
        let watch = observer.map_or_else(Watch::nobody, |observer| Watch::new(observer, total));
        self.run(shot, image, &watch);
        let is_stopped = watch.is_stopped();
        Ok(if is_stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    fn batch<A: Type, R: Type>(&self, kernel: &Kernel<'_, A, R>, inputs: &[A], outputs: &mut [R]) {
        self.run_batch(kernel, inputs, outputs);
    }
}
