//! Runs kernels on a device.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use super::run::{Effort, Grid, Outputs, Teller, timing_of};
use super::window::check_target;
use super::{Context, GpuError, GpuWindow, Timing};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::machine::wgsl::{BufferKey, Module};
use crate::machine::{Resource, Type, X2, stride};
use crate::render::{
    Film, FilmArgs, Frame, Image, Moments, Observer, ProgressObserver, Radiance, Reached, Renderer,
    Samples, Sampling, Shot, Until, run_until,
};

/// Who is shown the buffers that a kernel may read.
type Visit<'a> = &'a mut dyn FnMut(&dyn Resource);

/// Shows them.
type Resources<'a> = &'a dyn Fn(Visit<'_>);

/// Runs the WGSL variant of kernels: pictures and batches.
///
/// Trees are uploaded once and kept; text is compiled once and kept. The numbers that a kernel
/// captures are in a uniform block, so that new numbers compile nothing.
#[derive(Debug)]
pub struct GpuScheduler {
    context: Context,
}

impl GpuScheduler {
    /// Takes the best adapter of this machine.
    ///
    /// # Errors
    ///
    /// If there is none, or it gives no device.
    pub fn new() -> Result<Self, GpuError> {
        Ok(Self::with_context(Context::new()?))
    }

    /// Takes a context, for example of the application's own device and queue.
    pub fn with_context(context: Context) -> Self {
        Self { context }
    }

    /// The device with its caches.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// Renders a frame: `image`'s size is the film's, and one ray goes through the middle of each
    /// pixel.
    ///
    /// # Errors
    ///
    /// If the device refuses or is lost; `image` is then what it was.
    pub fn frame<C: Camera, A: FilmArgs, R: Type + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
    ) -> Result<Timing, GpuError> {
        let go_on: Observer<'_> = &mut |_| ControlFlow::Continue(());
        self.frame_observed(camera, kernel, image, go_on).map(timing_of)
    }

    /// [`GpuScheduler::frame`], telling `observer` the share that is done, after each dispatch: they
    /// take about 50 ms. It may break off; `image` is then what it was.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn frame_observed<C: Camera, A: FilmArgs, R: Type + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        if observer(0.0).is_break() {
            return Ok(ControlFlow::Break(Timing::default()));
        }
        let rays = camera.begin_frame(image.width(), image.height());
        let end = self.shoot(&Frame { rays, kernel }, Effort::ONE, image, observer)?;
        if end.is_continue() {
            // The picture is there, whatever the answer.
            let _ = observer(1.0);
        }
        Ok(end)
    }

    /// Renders a frame of `width` by `height` pixels into the application's buffer: row by row from
    /// the bottom, each result as it lies in memory. Nothing comes back to the host, and what is
    /// submitted to the queue afterwards finds it there.
    ///
    /// ```no_run
    /// # use raydsl::prelude::*;
    /// # use raydsl::gpu::{GpuError, GpuWindow};
    /// # fn show(
    /// #     gpu: &GpuScheduler, camera: &Pinhole, buffer: &wgpu::Buffer,
    /// # ) -> Result<(), GpuError> {
    /// let sky = kernel!(|ray: Ray| vec4(ray.direction.y, 0.5, 1.0, 1.0));
    /// let window = GpuWindow { buffer: buffer.clone(), offset: 0, size: 640 * 480 * 16 };
    /// gpu.frame_into(camera, &sky, (640, 480), &window)?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// [`GpuError::Window`] if the window has another size than the results, or its buffer has not
    /// `STORAGE` and `COPY_DST` or is another device's; or if the device refuses or is lost.
    pub fn frame_into<C: Camera, A: FilmArgs, R: Type + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        (width, height): (u32, u32),
        window: &GpuWindow,
    ) -> Result<Timing, GpuError> {
        let pixels = u64::from(width) * u64::from(height);
        check_target::<R>(&self.context.gpu, pixels, window)?;
        let rays = camera.begin_frame(width, height);
        let shot = Frame { rays, kernel };
        let resources = |visit: Visit<'_>| shot.resources(visit);
        let module = self.module(&shot);
        let grid = Grid::of([width, height]);
        self.run_to(&resources, &module, &[], grid, Outputs::Device(window)).map(timing_of)
    }

    /// Adds `samples` samples to every pixel of `film`, as [`Scheduler::accumulate`] does. Those of
    /// a pass, 64 at most, are added up on the device.
    ///
    /// [`Scheduler::accumulate`]: crate::render::Scheduler::accumulate
    ///
    /// # Errors
    ///
    /// If the device refuses or is lost; `film` then has the passes that came through.
    pub fn accumulate<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        samples: u32,
    ) -> Result<Timing, GpuError> {
        let go_on: Observer<'_> = &mut |_| ControlFlow::Continue(());
        self.accumulate_observed(camera, kernel, sampling, film, samples, go_on).map(timing_of)
    }

    /// [`GpuScheduler::accumulate`], telling `observer` the share that is done, after each dispatch.
    /// It may break off: the film then has the passes that were finished.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn accumulate_observed<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        samples: u32,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let plan = Samples { sampling, each: samples, allocation: None };
        let mut renderer =
            OnDevice { scheduler: self, camera, kernel, slice: Duration::MAX, pass: LARGEST_PASS };
        renderer.accumulate(&plan, film, observer)
    }

    /// Renders until an error is reached, or a budget is spent, as [`Scheduler::render_until`]
    /// does. The clock is looked at after each dispatch, which takes about 50 ms; what is broken off
    /// in a pass over the film is lost, so that one takes about a fiftieth of the time.
    ///
    /// [`Scheduler::render_until`]: crate::render::Scheduler::render_until
    ///
    /// # Errors
    ///
    /// What cannot be asked for, or if the device refuses or is lost; `film` then has the best
    /// picture so far.
    pub fn render_until<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        until: &Until,
    ) -> Result<Reached, GpuError> {
        let go_on: ProgressObserver<'_> = &mut |_| ControlFlow::Continue(());
        self.render_until_observed(camera, kernel, sampling, film, until, go_on)
    }

    /// [`GpuScheduler::render_until`], telling `observer` how far it is. It may break off.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn render_until_observed<C: Camera, A: FilmArgs, R: Radiance + Send>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film,
        until: &Until,
        observer: ProgressObserver<'_>,
    ) -> Result<Reached, GpuError> {
        until.check(film, sampling)?;
        let slice = until.budget.time / PASSES_OF_A_BUDGET;
        let mut renderer = OnDevice { scheduler: self, camera, kernel, pass: 1, slice };
        run_until(until, sampling, film, observer, &mut renderer)
    }

    fn module<S: Shot>(&self, shot: &S) -> Module {
        let recording = shot.kernel().record_grid::<S::Output>(|m, x, y, body| {
            shot.pixel_on(m, X2 { x, y }, &|m, args| body(m, args))
        });
        recording.module(&self.context.limits())
    }

    fn shoot<S: Shot>(
        &self,
        shot: &S,
        effort: Effort,
        image: &mut Image<S::Output>,
        teller: Teller<'_>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let module = self.module(shot);
        let grid = Grid { size: [image.width(), image.height()], effort, teller: Some(teller) };
        self.run(&|visit| shot.resources(visit), &module, &[], grid, image.pixels_mut())
    }

    /// Runs a kernel over `inputs`; `outputs` has the same length.
    ///
    /// # Errors
    ///
    /// If the lengths differ, or the device refuses or is lost.
    pub fn batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) -> Result<Timing, GpuError> {
        let module = kernel.record().module(&self.context.limits());
        let each = stride(A::SCHEMA);
        let mut bytes = vec![0; each * inputs.len()];
        for (a, out) in inputs.iter().zip(bytes.chunks_exact_mut(each)) {
            a.write(out);
        }
        let count = u32::try_from(inputs.len())
            .map_err(|_| GpuError::GridTooLarge { size: [u32::MAX, 1] })?;
        let (resources, grid) = (|visit: Visit<'_>| kernel.resources(visit), Grid::of([count, 1]));
        self.run(&resources, &module, &bytes, grid, outputs).map(timing_of)
    }

    /// Runs a module; if it was broken off, `outputs` are what they were.
    fn run<O: Type>(
        &self,
        resources: Resources<'_>,
        module: &Module,
        inputs: &[u8],
        grid: Grid<'_>,
        outputs: &mut [O],
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let each = stride(O::SCHEMA);
        let mut bytes = vec![0; each * outputs.len()];
        let end = self.run_to(resources, module, inputs, grid, Outputs::Host(&mut bytes))?;
        if end.is_continue() {
            for (out, bytes) in outputs.iter_mut().zip(bytes.chunks_exact(each)) {
                *out = O::read(bytes);
            }
        }
        Ok(end)
    }

    fn run_to(
        &self,
        resources: Resources<'_>,
        module: &Module,
        inputs: &[u8],
        grid: Grid<'_>,
        outputs: Outputs<'_>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        self.context.forget_gone();
        let data = |key| bytes_of(resources, key).map(Cow::Owned);
        let end = self.context.run_to(module, &data, inputs, grid, outputs);
        // The address of a slice names its data only while it is borrowed.
        let buffers = module.buffers.iter().map(|buffer| buffer.key);
        let keys = buffers.chain(module.textures.iter().map(|texture| texture.key));
        for key in keys.filter(|key| crate::machine::is_borrowed(*key)) {
            self.context.forget(key.id);
        }
        end
    }
}

/// A pass takes about this share of the time of a budget.
const PASSES_OF_A_BUDGET: u32 = 50;
/// The samples of a pixel that one pass takes at most.
const LARGEST_PASS: u32 = 64;

/// A device with what it is to render.
struct OnDevice<'a, C, A: Type, R: Type> {
    scheduler: &'a GpuScheduler,
    camera: &'a C,
    kernel: &'a Kernel<'a, A, R>,
    /// Samples of the next pass.
    pass: u32,
    /// How long a pass should take at most.
    slice: Duration,
}

impl<C: Camera, A: FilmArgs, R: Radiance + Send> OnDevice<'_, C, A, R> {
    /// Adds samples, pass by pass. What broke off in a pass does not count.
    fn accumulate(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Film,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let mut timing = Timing::default();
        if observer(0.0).is_break() {
            return Ok(ControlFlow::Break(timing));
        }
        let all = f64::from(samples.each);
        let mut image = Image::filled(film.width(), film.height(), Moments::none());
        let mut done = 0;
        while done < samples.each {
            let count = self.pass.min(samples.each - done);
            let pass = samples.pass(self.camera, self.kernel, film, count);
            // Where some blocks have all they need, a pass is shorter than others will be.
            let is_even = samples.least() >= done + count;
            let mut tell =
                |share: f64| observer((f64::from(done) + share * f64::from(count)) / all);
            let effort = Effort { samples: count, is_even };
            let begin = Instant::now();
            let end = self.scheduler.shoot(&pass, effort, &mut image, &mut tell)?;
            timing += timing_of(end);
            if end.is_break() {
                return Ok(ControlFlow::Break(timing));
            }
            if is_even {
                self.learn(begin.elapsed());
            }
            film.join(&image, count);
            done += count;
            let answer = observer(f64::from(done) / all);
            if done < samples.each && answer.is_break() {
                return Ok(ControlFlow::Break(timing));
            }
        }
        Ok(ControlFlow::Continue(timing))
    }
}

impl<C: Camera, A: FilmArgs, R: Radiance + Send> Renderer for OnDevice<'_, C, A, R> {
    type Error = GpuError;

    fn render(
        &mut self,
        samples: &Samples<'_>,
        film: &mut Film,
        observer: Observer<'_>,
    ) -> Result<ControlFlow<()>, GpuError> {
        Ok(match self.accumulate(samples, film, observer)? {
            ControlFlow::Continue(_) => ControlFlow::Continue(()),
            ControlFlow::Break(_) => ControlFlow::Break(()),
        })
    }
}

impl<C, A: Type, R: Type> OnDevice<'_, C, A, R> {
    /// Makes the next passes shorter where one took long, and longer where there is room.
    fn learn(&mut self, took: Duration) {
        if took > self.slice {
            self.pass = (self.pass / 2).max(1);
        } else if took < self.slice / 4 {
            self.pass = (self.pass * 2).min(LARGEST_PASS);
        }
    }
}

/// The bytes of a buffer, made only where the device does not have them yet.
fn bytes_of(resources: Resources<'_>, key: BufferKey) -> Option<Vec<u8>> {
    let mut found = None;
    resources(&mut |resource| {
        if found.is_none() {
            found = resource.bytes(key).map(Cow::into_owned);
        }
    });
    found
}
