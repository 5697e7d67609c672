//! What renders pictures, whether on the CPU or on a device.

use core::ops::ControlFlow;
use std::time::{Duration, Instant};

use super::allocation::Allocation;
use super::film_args::FilmArgs;
use super::shot::{Frame, Pass, Shot};
use super::until::{Accumulate, ProgressObserver, Reached, Until, UntilError, run};
use super::watch::Observer;
use super::{Film, Image, Moments, Radiance, Sampling};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::machine::Type;

/// The samples of a pixel that one pass takes at most: in between, the observer may stop it.
const LARGEST_PASS: u32 = 64;

/// A pass on a device takes about this share of the time of a budget.
#[cfg(feature = "gpu")]
const PASSES_OF_A_BUDGET: u32 = 50;

/// Samples that a film gets.
#[derive(Clone, Copy)]
pub(crate) struct Samples<'a> {
    pub(crate) sampling: &'a Sampling,
    /// Of each pixel; if they are allocated, the most of any.
    pub(crate) each: u32,
    /// How many each block gets in all, where they do not all get the same.
    pub(crate) allocation: Option<&'a Allocation>,
}

impl Samples<'_> {
    /// The least that a pixel gets.
    fn least(&self) -> u32 {
        self.allocation.map_or(self.each, Allocation::least)
    }
}

/// What a pixel costs.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// At most so many samples.
    pub samples: u32,
    /// Whether all pixels take that many: only then a run tells how long others will take.
    pub is_even: bool,
}

impl Effort {
    /// One sample.
    pub(crate) const ONE: Self = Self { samples: 1, is_even: true };
}

/// How many samples of each pixel the next pass takes.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    pass: u32,
    /// How long a pass should take at most.
    slice: Duration,
}

impl Pace {
    /// Passes as long as they may be.
    pub(crate) const LONGEST: Self = Self { pass: LARGEST_PASS, slice: Duration::MAX };

    /// Passes that are short beside a budget of time, for what loses a pass when it is broken off.
    #[cfg(feature = "gpu")]
    pub(crate) fn within(budget: Duration) -> Self {
        Self { pass: 1, slice: budget / PASSES_OF_A_BUDGET }
    }

    /// Makes the next passes shorter where one took long, and longer where there is room.
    fn learn(&mut self, took: Duration) {
        if took > self.slice {
            self.pass = (self.pass / 2).max(1);
        } else if took < self.slice / 4 {
            self.pass = (self.pass * 2).min(LARGEST_PASS);
        }
    }
}

/// Renders pictures and films with a kernel, and runs kernels over batches.
///
/// Every [`Scheduler`](super::Scheduler) of the CPU is one, and so is
/// [`GpuScheduler`](crate::gpu::GpuScheduler). Where nothing may go wrong, as on the CPU, an
/// [`Outcome`](Renderer::Outcome) is the value itself; a device gives a `Result`.
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
    /// How long it took, as far as that is known: nothing is of the CPU.
    type Timing: Default;

    /// What may go wrong.
    type Error;

    /// What may go wrong, or cannot be asked for.
    type UntilError: From<UntilError> + From<Self::Error>;

    /// A value, or what went wrong in its place.
    type Outcome<T>;

    /// Counts what another run took.
    #[doc(hidden)]
    fn add_timing(total: &mut Self::Timing, timing: Self::Timing);

    #[doc(hidden)]
    fn outcome<T>(result: Result<T, Self::Error>) -> Self::Outcome<T>;

    /// Runs `shot` for every pixel of `image`, telling `observer` the share that is done, between its
    /// ends.
    #[doc(hidden)]
    fn shoot<S: Shot>(
        &self,
        shot: &S,
        effort: Effort,
        image: &mut Image<S::Output>,
        observer: Option<Observer<'_>>,
    ) -> Result<ControlFlow<Self::Timing, Self::Timing>, Self::Error>;

    /// How long passes over a film are that has this budget of time.
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

    /// Renders a frame: `image`'s size is the film's, and one ray goes through the middle of each
    /// pixel.
    ///
    /// # Errors
    ///
    /// If a device refuses or is lost; `image` is then what it was.
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

    /// [`Renderer::frame`], telling `observer` the share that is done: on a device after each
    /// dispatch, which takes about 50 ms. It may break off: on the CPU the pixels so far are in
    /// `image`, the others as they were; of a device nothing comes back.
    ///
    /// # Errors
    ///
    /// As there.
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
            // The picture is there, whatever the answer.
            let _ = observer(1.0);
        }
        Self::outcome(end)
    }

    /// Adds `samples` samples to every pixel of `film`.
    ///
    /// Samples are counted: two calls for 8 give what one for 16 gives, to within the rounding of
    /// a pass of at most 64 samples, which are added up where they are taken.
    ///
    /// # Errors
    ///
    /// If a device refuses or is lost; `film` then has the passes that came through.
    fn accumulate<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        samples: u32,
    ) -> Self::Outcome<Self::Timing> {
        let plan = Samples { sampling, each: samples, allocation: None };
        let go_on: Observer<'_> = &mut |_| ControlFlow::Continue(());
        let mut passes = Passes { renderer: self, camera, kernel, pace: Pace::LONGEST };
        Self::outcome(passes.add(&plan, film, go_on).map(timing_of))
    }

    /// [`Renderer::accumulate`], telling `observer` the share that is done. It may break off: the film
    /// then has the passes that were finished.
    ///
    /// # Errors
    ///
    /// As there.
    fn accumulate_observed<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        samples: u32,
        observer: Observer<'_>,
    ) -> Self::Outcome<ControlFlow<Self::Timing, Self::Timing>> {
        let plan = Samples { sampling, each: samples, allocation: None };
        let mut passes = Passes { renderer: self, camera, kernel, pace: Pace::LONGEST };
        Self::outcome(passes.add(&plan, film, observer))
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
    /// On a device the clock is looked at after each dispatch, and a pass over the film takes about a
    /// fiftieth of the time: what is broken off in one is lost.
    ///
    /// # Errors
    ///
    /// What cannot be asked for: a tolerance, a budget, or a film of nothing; or if a device refuses or
    /// is lost, and `film` then has the best picture so far.
    fn render_until<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        until: &Until,
    ) -> Result<Reached, Self::UntilError> {
        let go_on: ProgressObserver<'_> = &mut |_| ControlFlow::Continue(());
        self.render_until_observed(camera, kernel, sampling, film, until, go_on)
    }

    /// [`Renderer::render_until`], telling `observer` how far it is. It may break off.
    ///
    /// # Errors
    ///
    /// As there.
    fn render_until_observed<C: Camera, A: FilmArgs, R: Radiance>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        until: &Until,
        observer: ProgressObserver<'_>,
    ) -> Result<Reached, Self::UntilError> {
        until.check(film, sampling)?;
        let pace = self.pace(until.budget.time);
        let mut passes = Passes { renderer: self, camera, kernel, pace };
        Ok(run(until, sampling, film, observer, &mut passes)?)
    }
}

/// What a run took, also one that was broken off.
pub(crate) fn timing_of<T>(end: ControlFlow<T, T>) -> T {
    match end {
        ControlFlow::Continue(timing) | ControlFlow::Break(timing) => timing,
    }
}

/// A renderer with what it is to render, pass by pass.
struct Passes<'a, T: ?Sized, C, A: Type, R: Type> {
    renderer: &'a T,
    camera: &'a C,
    kernel: &'a Kernel<'a, A, R>,
    pace: Pace,
}

impl<T, C, A, R> Passes<'_, T, C, A, R>
where
    T: Renderer + ?Sized,
    C: Camera,
    A: FilmArgs,
    R: Radiance,
{
    /// Adds samples to a film. What broke off in a pass does not count.
    fn add(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Film,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<T::Timing, T::Timing>, T::Error> {
        let mut timing = T::Timing::default();
        if observer(0.0).is_break() {
            return Ok(ControlFlow::Break(timing));
        }
        let Samples { sampling, each, allocation } = *samples;
        let all = f64::from(each);
        let mut image = Image::filled(film.width(), film.height(), Moments::none());
        let mut done = 0;
        while done < each {
            let count = self.pace.pass.min(each - done);
            let rays = self.camera.begin_frame(film.width(), film.height());
            let (kernel, sampling, first) = (self.kernel, *sampling, film.samples());
            let pass = Pass { rays, kernel, sampling, first, count, allocation };
            // Where some blocks have all they need, a pass is shorter than others will be.
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
            film.join(&image, count);
            done += count;
            let answer = observer(f64::from(done) / all);
            if done < each && answer.is_break() {
                return Ok(ControlFlow::Break(timing));
            }
        }
        Ok(ControlFlow::Continue(timing))
    }
}

impl<T, C, A, R> Accumulate for Passes<'_, T, C, A, R>
where
    T: Renderer + ?Sized,
    C: Camera,
    A: FilmArgs,
    R: Radiance,
{
    type Error = T::Error;

    fn accumulate(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Film,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<()>, T::Error> {
        Ok(match self.add(samples, film, observer)? {
            ControlFlow::Continue(_) => ControlFlow::Continue(()),
            ControlFlow::Break(_) => ControlFlow::Break(()),
        })
    }
}
