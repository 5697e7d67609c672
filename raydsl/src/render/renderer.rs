//! The trait of renderers, on the CPU or on a device.

use core::marker::PhantomData;
use core::ops::ControlFlow;
use std::time::Duration;

use glam::UVec2;

use super::allocation::Allocation;
use super::channels::Kept;
use super::film_args::FilmArgs;
use super::part;
use super::shot::{Frame, Pass, Shot};
use super::store::Store;
use super::until::{Accumulate, ProgressObserver, Reached, Until, UntilError, run};
use super::watch::Observer;
use super::window::Windowed;
use super::{Film, FilmExtent, FilmPart, Image, Radiance, Sampling};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::machine::Type;
use crate::run::clock::Instant;

/// The maximum number of samples per pixel in one pass: the observer may stop in between.
pub(super) const LARGEST_PASS: u32 = 64;

/// The number of passes of a device in a time budget.
#[cfg(all(feature = "gpu", not(target_family = "wasm")))]
const PASSES_OF_A_BUDGET: u32 = 50;

/// The samples to add to a film.
#[derive(Clone, Copy)]
pub(crate) struct Samples<'a> {
    pub(crate) sampling: &'a Sampling,
    /// The number per pixel; if they are allocated, the largest.
    pub(crate) each: u32,
    /// The total of each block, if they differ.
    pub(crate) allocation: Option<&'a Allocation>,
}

impl Samples<'_> {
    /// Returns the smallest number of samples of a pixel.
    fn least(&self) -> u32 {
        self.allocation.map_or(self.each, Allocation::least)
    }
}

/// The cost of a pixel.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// The maximum number of samples.
    pub samples: u32,
    /// Whether all pixels take that many: only then does a run predict the time of others.
    pub is_even: bool,
}

impl Effort {
    /// The cost of one sample.
    pub(crate) const ONE: Self = Self { samples: 1, is_even: true };
}

/// The number of samples per pixel in the next pass.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    pass: u32,
    /// The maximum time of a pass.
    slice: Duration,
}

impl Pace {
    /// Passes of the maximum length.
    pub(crate) const LONGEST: Self = Self { pass: LARGEST_PASS, slice: Duration::MAX };

    /// Returns passes that are short beside a time budget, for renderers that lose a pass when
    /// stopped.
    #[cfg(all(feature = "gpu", not(target_family = "wasm")))]
    pub(crate) fn within(budget: Duration) -> Self {
        Self { pass: 1, slice: budget / PASSES_OF_A_BUDGET }
    }

    /// Makes the next passes shorter if one took too long, and longer if there is time.
    fn learn(&mut self, took: Duration) {
        if took > self.slice {
            self.pass = (self.pass / 2).max(1);
        } else if took < self.slice / 4 {
            self.pass = (self.pass * 2).min(LARGEST_PASS);
        }
    }
}

/// A renderer: renders pictures and films with a kernel, and runs kernels over batches.
///
/// Every [`Scheduler`](super::Scheduler) of the CPU is one, and so is
/// [`GpuScheduler`](crate::gpu::GpuScheduler). An [`Outcome`](Renderer::Outcome) is the value
/// itself if nothing can fail, as on the CPU; a device returns a `Result`.
///
/// ```
/// use raydsl::prelude::*;
///
/// fn horizon<R: Renderer>(renderer: &R) -> R::Outcome<R::Timing> {
///     let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
///     let sky = kernel!(|ray: Ray| ray.direction.y);
///     renderer.frame(&camera, &sky, &mut Image::filled(100, 70, 0.0))
/// }
///
/// horizon(&TiledScheduler::new());
/// ```
pub trait Renderer {
    /// The time of a run, if it is measured: it is not on the CPU.
    type Timing: Default;

    /// The error of a failed run.
    type Error;

    /// The error of a failed run, or of an invalid target.
    type UntilError: From<UntilError> + From<Self::Error>;

    /// A value, or the error in its place.
    type Outcome<T>;

    /// Adds the time of another run.
    #[doc(hidden)]
    fn add_timing(total: &mut Self::Timing, timing: Self::Timing);

    #[doc(hidden)]
    fn outcome<T>(result: Result<T, Self::Error>) -> Self::Outcome<T>;

    /// Returns what [`outcome`](Self::outcome) was made of.
    #[doc(hidden)]
    fn result<T>(outcome: Self::Outcome<T>) -> Result<T, Self::Error>;

    /// Runs `shot` for every pixel of `image`, reporting the completed share to `observer`,
    /// excluding the beginning and the end.
    #[doc(hidden)]
    fn shoot<S: Shot>(
        &self,
        shot: &S,
        effort: Effort,
        image: &mut Image<S::Output>,
        observer: Option<Observer<'_>>,
    ) -> Result<ControlFlow<Self::Timing, Self::Timing>, Self::Error>;

    /// Returns the length of passes over a film with this time budget.
    #[doc(hidden)]
    fn pace(&self, _budget: Duration) -> Pace {
        Pace::LONGEST
    }

    /// Runs a kernel over `inputs`; `outputs` has the same length.
    ///
    /// # Panics
    ///
    /// On the CPU, if the lengths differ.
    ///
    /// # Errors
    ///
    /// On a device, if the lengths differ, or the device refuses or is lost.
    fn batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) -> Self::Outcome<Self::Timing>;

    /// Renders a frame of the size of `image`, with one ray through the centre of each pixel.
    ///
    /// # Errors
    ///
    /// If a device refuses or is lost; `image` is then unchanged.
    fn frame<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
    ) -> Self::Outcome<Self::Timing> {
        let rays = camera.begin_frame(image.width(), image.height());
        let end = self.shoot(&Frame { rays, kernel }, Effort::ONE, image, None);
        Self::outcome(end.map(timing_of))
    }

    /// Renders a frame like [`Renderer::frame`] and reports the completed share to `observer`: on a
    /// device after each dispatch, which takes about 50 ms. The observer may stop the run: on the
    /// CPU `image` then has the completed pixels, the others unchanged; a device returns nothing.
    ///
    /// # Errors
    ///
    /// As for [`Renderer::frame`].
    fn frame_observed<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
        observer: Observer<'_>,
    ) -> Self::Outcome<ControlFlow<Self::Timing, Self::Timing>> {
        if observer(0.0).is_break() {
            return Self::outcome(Ok(ControlFlow::Break(Self::Timing::default())));
        }
        let rays = camera.begin_frame(image.width(), image.height());
        let end = self.shoot(&Frame { rays, kernel }, Effort::ONE, image, Some(&mut *observer));
        if matches!(end, Ok(ControlFlow::Continue(_))) {
            // The picture is complete, whatever the observer returns.
            let _ = observer(1.0);
        }
        Self::outcome(end)
    }

    /// Renders a window of a frame of `size` pixels: `image`, whose lower left pixel is that at
    /// `origin` of the frame. Its pixels have the bits that they have in the whole frame.
    ///
    /// # Errors
    ///
    /// As for [`Renderer::frame`].
    ///
    /// ```
    /// use raydsl::prelude::*;
    ///
    /// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
    /// let sky = kernel!(|ray: Ray| ray.direction.y);
    /// let (mut whole, mut window) = (Image::filled(100, 70, 0.0), Image::filled(10, 5, 0.0));
    /// let scheduler = TiledScheduler::new();
    /// scheduler.frame(&camera, &sky, &mut whole);
    /// scheduler.frame_window(&camera, &sky, uvec2(100, 70), uvec2(33, 44), &mut window);
    /// assert_eq!(window.get(9, 4), whole.get(42, 48));
    /// ```
    fn frame_window<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        size: UVec2,
        origin: UVec2,
        image: &mut Image<R>,
    ) -> Self::Outcome<Self::Timing> {
        let rays = camera.begin_frame(size.x, size.y);
        let shot = Windowed { shot: Frame { rays, kernel }, origin };
        Self::outcome(self.shoot(&shot, Effort::ONE, image, None).map(timing_of))
    }

    /// Renders a part of a film, for [`Film::from_parts`]. Its samples are those that
    /// [`accumulate`](Renderer::accumulate) takes, so they may be rendered by many machines.
    ///
    /// # Errors
    ///
    /// If a device refuses or is lost.
    fn render_part<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        extent: &FilmExtent,
    ) -> Self::Outcome<FilmPart> {
        Self::outcome(part::render(self, camera, kernel, sampling, extent))
    }

    /// Adds `samples` samples to every pixel of `film`: their colours, and for a film
    /// [of channels](Film::of_channels) every number of the results.
    ///
    /// Samples are numbered: two calls for 8 give the result of one for 16, up to the rounding of a
    /// pass of at most 64 samples, which are summed where they are taken.
    ///
    /// # Errors
    ///
    /// If a device refuses or is lost; `film` then has the completed passes.
    fn accumulate<C: Camera, A: FilmArgs, R: Radiance, K: Kept<R>>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film<K>,
        samples: u32,
    ) -> Self::Outcome<Self::Timing> {
        let plan = Samples { sampling, each: samples, allocation: None };
        let go_on: Observer<'_> = &mut |_| ControlFlow::Continue(());
        let pace = Pace::LONGEST;
        let mut passes =
            Passes { renderer: self, camera, kernel, pace, kept: PhantomData::<fn() -> K> };
        Self::outcome(passes.add(&plan, &mut film.store, go_on).map(timing_of))
    }

    /// Adds samples like [`Renderer::accumulate`] and reports the completed share to `observer`,
    /// which may stop the run: the film then has the completed passes.
    ///
    /// # Errors
    ///
    /// As for [`Renderer::accumulate`].
    fn accumulate_observed<C: Camera, A: FilmArgs, R: Radiance, K: Kept<R>>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film<K>,
        samples: u32,
        observer: Observer<'_>,
    ) -> Self::Outcome<ControlFlow<Self::Timing, Self::Timing>> {
        let plan = Samples { sampling, each: samples, allocation: None };
        let pace = Pace::LONGEST;
        let mut passes =
            Passes { renderer: self, camera, kernel, pace, kept: PhantomData::<fn() -> K> };
        Self::outcome(passes.add(&plan, &mut film.store, observer))
    }

    /// Renders until a target error is reached, or a budget is spent. `film` gives the size; its
    /// samples are cleared, and it then has the best picture so far.
    ///
    /// Samples are taken in [`REPLICATIONS`](super::REPLICATIONS) independent replications, whose
    /// means scatter like the error, even if the samples of each are correlated. A pilot chooses
    /// the number of samples; fresh samples make the picture and its error estimate, so that the
    /// choice does not bias them (Stein, "A Two-Sample Test for a Linear Hypothesis Whose Power is
    /// Independent of the Variance", 1945). Random numbers of the kernel must come from its
    /// `Sampler`: others are the same in all replications, and their error is not measured. Fixed
    /// positions in pixels are used in whole periods.
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use raydsl::render::{Budget, Metric, Outcome, Target, Until};
    ///
    /// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
    /// let noise = kernel!(|_ray: Ray, sampler: Sampler| {
    ///     let mut sampler = sampler;
    ///     sampler.next_1d()
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
    /// On a device the clock is checked after each dispatch, and a pass over the film takes about a
    /// fiftieth of the time: an interrupted pass is lost.
    ///
    /// # Errors
    ///
    /// If the tolerance or the budget is invalid, or the film has no pixels; or if a device refuses
    /// or is lost, and `film` then has the best picture so far.
    fn render_until<C: Camera, A: FilmArgs, R: Radiance, K: Kept<R>>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film<K>,
        until: &Until,
    ) -> Result<Reached, Self::UntilError> {
        let go_on: ProgressObserver<'_> = &mut |_| ControlFlow::Continue(());
        self.render_until_observed(camera, kernel, sampling, film, until, go_on)
    }

    /// Renders like [`Renderer::render_until`] and reports progress to `observer`, which may stop
    /// the run.
    ///
    /// # Errors
    ///
    /// As for [`Renderer::render_until`].
    fn render_until_observed<C: Camera, A: FilmArgs, R: Radiance, K: Kept<R>>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film<K>,
        until: &Until,
        observer: ProgressObserver<'_>,
    ) -> Result<Reached, Self::UntilError> {
        until.check(film.width(), film.height(), sampling)?;
        let pace = self.pace(until.budget.time);
        let mut passes =
            Passes { renderer: self, camera, kernel, pace, kept: PhantomData::<fn() -> K> };
        Ok(run(until, sampling, &mut film.store, observer, &mut passes)?)
    }
}

/// Returns the timing of a run, complete or stopped.
pub(crate) fn timing_of<T>(end: ControlFlow<T, T>) -> T {
    match end {
        ControlFlow::Continue(timing) | ControlFlow::Break(timing) => timing,
    }
}

/// A renderer with its camera and kernel, run pass by pass.
struct Passes<'a, T: ?Sized, C, A: Type, R: Type, K> {
    renderer: &'a T,
    camera: &'a C,
    kernel: &'a Kernel<'a, A, R>,
    pace: Pace,
    kept: PhantomData<fn() -> K>,
}

impl<T, C, A, R, K> Passes<'_, T, C, A, R, K>
where
    T: Renderer + ?Sized,
    C: Camera,
    A: FilmArgs,
    R: Radiance,
    K: Kept<R>,
{
    /// Adds samples to a film. A stopped pass adds none.
    fn add(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Store,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<T::Timing, T::Timing>, T::Error> {
        let mut timing = T::Timing::default();
        if observer(0.0).is_break() {
            return Ok(ControlFlow::Break(timing));
        }
        let Samples { sampling, each, allocation } = *samples;
        let all = f64::from(each);
        let mut image = Image::filled(film.width(), film.height(), K::none());
        let mut done = 0;
        while done < each {
            let count = self.pace.pass.min(each - done);
            let rays = self.camera.begin_frame(film.width(), film.height());
            let (kernel, sampling, first) = (self.kernel, *sampling, film.samples());
            let kept = PhantomData::<fn() -> K>;
            let pass = Pass { rays, kernel, sampling, first, count, allocation, kept };
            // If some blocks have all their samples, a pass is shorter than others will be.
            let is_even = samples.least() >= done + count;
            let mut tell =
                |share: f64| observer((f64::from(done) + share * f64::from(count)) / all);
            let effort = Effort { samples: count, is_even };
            let begin = Instant::now();
            let end = self.renderer.shoot(&pass, effort, &mut image, Some(&mut tell))?;
            let is_over = end.is_break();
            T::add_timing(&mut timing, timing_of(end));
            if is_over {
                return Ok(ControlFlow::Break(timing));
            }
            if is_even {
                self.pace.learn(begin.elapsed());
            }
            K::join(&image, count, film);
            done += count;
            let answer = observer(f64::from(done) / all);
            if done < each && answer.is_break() {
                return Ok(ControlFlow::Break(timing));
            }
        }
        Ok(ControlFlow::Continue(timing))
    }
}

impl<T, C, A, R, K> Accumulate for Passes<'_, T, C, A, R, K>
where
    T: Renderer + ?Sized,
    C: Camera,
    A: FilmArgs,
    R: Radiance,
    K: Kept<R>,
{
    type Error = T::Error;

    fn accumulate(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Store,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<()>, T::Error> {
        Ok(match self.add(samples, film, observer)? {
            ControlFlow::Continue(_) => ControlFlow::Continue(()),
            ControlFlow::Break(_) => ControlFlow::Break(()),
        })
    }
}
