//! What runs kernels over films and batches.

use core::convert::Infallible;
use core::ops::ControlFlow;

use super::allocation::Allocation;
use super::film_args::FilmArgs;
use super::shot::{Frame, Pass, Shot};
use super::until::{ProgressObserver, Reached, Renderer, Until, UntilError, run};
use super::watch::{Observer, Watch};
use super::{Film, Image, Moments, Radiance, Sampling};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::machine::Type;

/// The samples of a pixel that one pass takes at most: in between, the observer may stop it.
const PASS: u32 = 64;

/// How many samples each pass takes.
fn passes(samples: u32) -> impl Iterator<Item = u32> {
    (0..samples).step_by(PASS as usize).map(move |first| PASS.min(samples - first))
}

/// Samples that a film gets.
#[derive(Clone, Copy)]
pub(crate) struct Samples<'a> {
    pub(crate) sampling: &'a Sampling,
    /// Of each pixel; if they are allocated, the most of any.
    pub(crate) each: u32,
    /// How many each block gets in all, where they do not all get the same.
    pub(crate) allocation: Option<&'a Allocation>,
}

impl<'a> Samples<'a> {
    /// The least that a pixel gets.
    #[cfg(feature = "gpu")]
    pub(crate) fn least(&self) -> u32 {
        self.allocation.map_or(self.each, Allocation::least)
    }

    /// The next `count` of them.
    pub(crate) fn pass<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &'a Kernel<'a, A, R>,
        film: &Film,
        count: u32,
    ) -> Pass<'a, C::Rays, A, R> {
        let rays = camera.begin_frame(film.width(), film.height());
        let Self { sampling, allocation, .. } = *self;
        Pass { rays, kernel, sampling: *sampling, first: film.samples(), count, allocation }
    }
}

/// Runs a kernel for every pixel of a film, or for every element of a batch, on the CPU.
///
/// The result is the same for every scheduler, number of threads and CPU variant. One of your own
/// has [`Scheduler::run`], which hands out tiles, and [`Scheduler::batch`]:
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
///     fn batch<A: raydsl::Type + Sync, R: raydsl::Type + Send>(
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
    /// Runs `shot` for every pixel of `image`, counting pixels with `watch` and leaving early when
    /// that is stopped.
    fn run<S: Shot>(&self, shot: &S, image: &mut Image<S::Output>, watch: &Watch<'_>);

    /// Runs a kernel over `inputs`; `outputs` has the same length.
    ///
    /// # Panics
    ///
    /// If the lengths differ.
    fn batch<A: Type + Sync, R: Type + Send>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    );

    /// Renders a frame: `image`'s size is the film's, and one ray goes through the middle of each
    /// pixel.
    fn frame<C: Camera, A: FilmArgs, R: Type + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
    ) {
        let rays = camera.begin_frame(image.width(), image.height());
        self.run(&Frame { rays, kernel }, image, &Watch::nobody());
    }

    /// [`Scheduler::frame`], telling `observer` the share that is done. It may break off: the pixels
    /// so far are in `image`, the others as they were.
    fn frame_observed<C: Camera, A: FilmArgs, R: Type + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
        observer: Observer<'_>,
    ) -> ControlFlow<()> {
        observer(0.0)?;
        let rays = camera.begin_frame(image.width(), image.height());
        let watch = Watch::new(observer, image.pixels().len());
        self.run(&Frame { rays, kernel }, image, &watch);
        if watch.is_stopped() {
            return ControlFlow::Break(());
        }
        // The picture is there, whatever the answer.
        let _ = observer(1.0);
        ControlFlow::Continue(())
    }

    /// Adds `samples` samples to every pixel of `film`.
    ///
    /// Samples are counted: two calls for 8 give what one for 16 gives, to within the rounding of
    /// a pass.
    fn accumulate<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        samples: u32,
    ) {
        let go_on = &mut |_| ControlFlow::Continue(());
        let _ = self.accumulate_observed(camera, kernel, sampling, film, samples, go_on);
    }

    /// [`Scheduler::accumulate`], telling `observer` the share that is done. It may break off: the film
    /// then has the passes, of at most 64 samples, that were finished.
    fn accumulate_observed<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        samples: u32,
        observer: Observer<'_>,
    ) -> ControlFlow<()> {
        let plan = Samples { sampling, each: samples, allocation: None };
        OnCpu { scheduler: self, camera, kernel }.accumulate(&plan, film, observer)
    }

    /// Renders until an error is reached, or a budget is spent. `film` gives the size; what it had
    /// is forgotten, and it then has the best picture so far.
    ///
    /// Samples are taken by [`REPLICATIONS`](super::REPLICATIONS) independent replications, whose
    /// means scatter as the error does, however the samples of each depend on each other. A pilot
    /// chooses the number of samples; fresh samples make the picture and its error, so that the
    /// choice does not flatter them (Stein, "A Two-Sample Test for a Linear Hypothesis Whose Power
    /// is Independent of the Variance", 1945). Random numbers of the kernel must come from the
    /// `Sampler` that it is given: others are the same in all replications, and their error is not
    /// seen. Fixed places in pixels are taken in whole rounds.
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use raydsl::render::{Budget, Metric, Outcome, Target, Until};
    ///
    /// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
    /// let method = SampleMethod::Sobol;
    /// let noise = kernel!(|_ray: Ray, sampler: Sampler| {
    ///     let mut sampler = sampler;
    ///     sampler.next_1d(host(method))
    /// });
    /// let until = Until::new(Target::new(Metric::Rmse, 1e-3), Budget::of_samples(100_000));
    /// let mut film = Film::new(8, 8);
    /// let sampling = Sampling::new(1);
    /// let reached =
    ///     TiledScheduler::new().render_until(&camera, &noise, &sampling, &mut film, &until)?;
    /// assert_eq!(reached.outcome, Outcome::Converged);
    /// assert!(reached.estimate.high <= 1e-3 && reached.samples == film.samples());
    /// # Ok::<(), raydsl::render::UntilError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// What cannot be asked for: a tolerance, a budget, or a film of nothing.
    fn render_until<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        until: &Until,
    ) -> Result<Reached, UntilError> {
        let go_on: ProgressObserver<'_> = &mut |_| ControlFlow::Continue(());
        self.render_until_observed(camera, kernel, sampling, film, until, go_on)
    }

    /// [`Scheduler::render_until`], telling `observer` how far it is. It may break off.
    ///
    /// # Errors
    ///
    /// As there.
    fn render_until_observed<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        until: &Until,
        observer: ProgressObserver<'_>,
    ) -> Result<Reached, UntilError> {
        until.check(film, sampling)?;
        let mut renderer = OnCpu { scheduler: self, camera, kernel };
        let Ok(reached) = run(until, sampling, film, observer, &mut renderer);
        Ok(reached)
    }
}

/// A scheduler of the CPU with what it is to render.
struct OnCpu<'a, S: ?Sized, C, A: Type, R: Type> {
    scheduler: &'a S,
    camera: &'a C,
    kernel: &'a Kernel<'a, A, R>,
}

impl<S, C, A, R> OnCpu<'_, S, C, A, R>
where
    S: Scheduler + ?Sized,
    C: Camera,
    A: FilmArgs,
    R: Radiance + Send,
{
    fn accumulate(
        &self,
        samples: &Samples<'_>,
        film: &mut Film,
        observer: Observer<'_>,
    ) -> ControlFlow<()> {
        observer(0.0)?;
        let all = f64::from(samples.each);
        let mut image = Image::filled(film.width(), film.height(), Moments::none());
        let mut done = 0;
        for count in passes(samples.each) {
            let pass = samples.pass(self.camera, self.kernel, film, count);
            let share = |of_pass: f64| (f64::from(done) + of_pass * f64::from(count)) / all;
            let mut tell = |of_pass: f64| observer(share(of_pass));
            let watch = Watch::new(&mut tell, image.pixels().len());
            self.scheduler.run(&pass, &mut image, &watch);
            if watch.is_stopped() {
                return ControlFlow::Break(());
            }
            film.join(&image, count);
            done += count;
            let answer = observer(f64::from(done) / all);
            if done < samples.each {
                answer?;
            }
        }
        ControlFlow::Continue(())
    }
}

impl<S, C, A, R> Renderer for OnCpu<'_, S, C, A, R>
where
    S: Scheduler + ?Sized,
    C: Camera,
    A: FilmArgs,
    R: Radiance + Send,
{
    type Error = Infallible;

    fn render(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Film,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<()>, Infallible> {
        Ok(self.accumulate(samples, film, observer))
    }
}
