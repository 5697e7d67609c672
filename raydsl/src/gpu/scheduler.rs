//! A renderer that runs kernels on a device.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::Arc;
#[cfg(not(target_family = "wasm"))]
use std::time::Duration;

#[cfg(not(target_family = "wasm"))]
use super::background::Background;
use super::device::lock;
#[cfg(not(target_family = "wasm"))]
use super::meanwhile::Meanwhile;
use super::run::{Grid, Outputs, Teller};
use super::window::check_target;
use super::{Context, GpuError, GpuWindow, Timing};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::machine::wgsl::{BufferKey, Module};
use crate::machine::{
    Description, Frame as KernelFrame, Identity, Recorder, Recording, Resource, Type, Value, X2,
    stride,
};
use crate::render::{
    Effort, Film, FilmArgs, Frame, Image, Kept, Observer, Radiance, Sampling, Shot, passes,
    recorded, timing_of,
};
#[cfg(not(target_family = "wasm"))]
use crate::render::{Pace, Renderer, TiledScheduler};

/// A visitor of the buffers that a kernel may read.
type Visit<'a> = &'a mut dyn FnMut(&dyn Resource);

/// A function that calls a visitor with each of them.
type Resources<'a> = &'a dyn Fn(Visit<'_>);

/// A renderer that runs the WGSL variant of kernels, for pictures and batches.
///
/// Trees are uploaded once and kept; text is compiled once and kept. The numbers that a kernel
/// captures are in a uniform buffer, so that new numbers compile nothing. A kernel that a closure
/// makes anew, with other numbers, slices, trees, grids or transfer functions, is not even recorded
/// again; one that captures textures, instances, views of meshes or foreign structures is.
///
/// On a machine it is a [`Renderer`]. A browser lets no call wait: there it is none, and pictures are
/// made by [`GpuScheduler::frame_async`], [`GpuScheduler::accumulate_async`],
/// [`GpuScheduler::batch_async`] and [`GpuScheduler::frame_into_async`]. On a machine these give the
/// same results; the thread that polls them waits for the device.
#[derive(Debug)]
pub struct GpuScheduler {
    context: Arc<Context>,
    #[cfg(not(target_family = "wasm"))]
    background: Background,
    /// Who renders while the device compiles.
    #[cfg(not(target_family = "wasm"))]
    host: Option<TiledScheduler>,
}

impl GpuScheduler {
    /// Uses the best adapter of this machine.
    ///
    /// # Errors
    ///
    /// If there is none, or it gives no device.
    #[cfg(not(target_family = "wasm"))]
    pub fn new() -> Result<Self, GpuError> {
        Ok(Self::with_context(Context::new()?))
    }

    /// Uses the best adapter like [`GpuScheduler::new`], in a browser too.
    ///
    /// # Errors
    ///
    /// If there is none, or it gives no device.
    pub async fn open() -> Result<Self, GpuError> {
        Ok(Self::with_context(Context::open().await?))
    }

    /// Uses a context, for example of the application's own device and queue; schedulers may share
    /// one in an `Arc`.
    pub fn with_context(context: impl Into<Arc<Context>>) -> Self {
        Self {
            context: context.into(),
            #[cfg(not(target_family = "wasm"))]
            background: Background::default(),
            #[cfg(not(target_family = "wasm"))]
            host: None,
        }
    }

    /// Renders on the CPU while the device compiles a kernel, so that the first picture does not wait:
    /// the CPU's variants are compiled with the program, for every scene.
    ///
    /// A kernel that is new to the device is compiled on a thread of its own. Until that ends, frames,
    /// passes over films and batches are the host's. Of a batch the device does the rest; of a frame or
    /// a pass all, if the host has done less than half. The bits are the same where the device is
    /// [exact](Context::is_exact) and the kernel's arithmetic is not `Fast`; elsewhere those of two
    /// variants mix: leave it out where variants are compared. [`Timing::dispatches`] is 0 where the
    /// host did all of the work. [`GpuScheduler::frame_into`] and the `async` functions wait for the
    /// device. An error of the compilation comes with the next call; a batch may then have some results.
    ///
    /// ```no_run
    /// # use raydsl::prelude::*;
    /// let gpu = GpuScheduler::new()?.while_compiling(TiledScheduler::new());
    /// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
    /// let sky = kernel!(|ray: Ray| ray.direction.y);
    /// gpu.frame(&camera, &sky, &mut Image::filled(640, 480, 0.0))?;
    /// # Ok::<(), raydsl::gpu::GpuError>(())
    /// ```
    #[cfg(not(target_family = "wasm"))]
    #[must_use]
    pub fn while_compiling(self, host: TiledScheduler) -> Self {
        Self { host: Some(host), ..self }
    }

    /// Returns whether frames of this kernel are compiled for the device, and begins to compile them on a
    /// thread of its own if they are not: for a program that shows something else meanwhile. The size
    /// of a frame makes no difference.
    ///
    /// # Errors
    ///
    /// If the device refused the kernel, or is lost. The next call tries again.
    #[cfg(not(target_family = "wasm"))]
    pub fn prepare_frame<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
    ) -> Result<bool, GpuError> {
        let shot = Frame { rays: camera.begin_frame(1, 1), kernel };
        Ok(self.background.pending(&self.context, &|| self.module(&shot))?.is_none())
    }

    /// Returns who renders until a module is compiled; nothing if it is, or nobody does.
    #[cfg(not(target_family = "wasm"))]
    fn meanwhile(&self, module: &dyn Fn() -> Module) -> Result<Option<Meanwhile<'_>>, GpuError> {
        let Some(host) = &self.host else { return Ok(None) };
        let pending = self.background.pending(&self.context, module)?;
        Ok(pending.map(|compiled| Meanwhile::new(host, compiled)))
    }

    /// Returns the device with its caches.
    pub fn context(&self) -> &Context {
        &self.context
    }

    /// Renders a frame of `width` by `height` pixels into the application's buffer: row by row from
    /// the bottom, each result in its memory layout. Nothing is read back to the host, and later
    /// submissions to the queue see it.
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
    /// In a browser it submits the frame and waits for nothing: an error comes with the next call,
    /// and the time is that of the submission.
    ///
    /// # Errors
    ///
    /// [`GpuError::Window`] if the window has another size than the results, or its buffer has not
    /// `STORAGE` and `COPY_DST` or is another device's; or if the device refuses or is lost.
    pub fn frame_into<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        (width, height): (u32, u32),
        window: &GpuWindow,
    ) -> Result<Timing, GpuError> {
        #[cfg(not(target_family = "wasm"))]
        return pollster::block_on(self.frame_into_async(camera, kernel, (width, height), window));
        #[cfg(target_family = "wasm")]
        {
            let pixels = u64::from(width) * u64::from(height);
            check_target::<R>(&self.context.gpu, pixels, window)?;
            let shot = Frame { rays: camera.begin_frame(width, height), kernel };
            let module = self.module(&shot);
            let _forget = self.data_of(&module);
            let data = |key| bytes_of(&|visit| shot.resources(visit), key).map(Cow::Owned);
            self.context.submit_to(&module, &data, [width, height], window)
        }
    }

    /// Renders a frame like [`GpuScheduler::frame_into`] and waits until it is done.
    ///
    /// # Errors
    ///
    /// As for [`GpuScheduler::frame_into`], and those of the frame itself in a browser too.
    pub async fn frame_into_async<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        (width, height): (u32, u32),
        window: &GpuWindow,
    ) -> Result<Timing, GpuError> {
        let pixels = u64::from(width) * u64::from(height);
        check_target::<R>(&self.context.gpu, pixels, window)?;
        let shot = Frame { rays: camera.begin_frame(width, height), kernel };
        let module = self.module(&shot);
        let (grid, outputs) = (Grid::of([width, height]), Outputs::Device(window));
        let resources = |visit: Visit<'_>| shot.resources(visit);
        self.run_to(&resources, &module, &[], grid, outputs).await.map(timing_of)
    }

    /// Renders a frame like [`Renderer::frame`](crate::render::Renderer::frame).
    ///
    /// # Errors
    ///
    /// If the device refuses or is lost; `image` is then unchanged.
    pub async fn frame_async<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
    ) -> Result<Timing, GpuError> {
        let rays = camera.begin_frame(image.width(), image.height());
        let end = self.shoot_async(&Frame { rays, kernel }, Effort::ONE, image, None).await;
        end.map(timing_of)
    }

    /// Adds `samples` samples to every pixel of `film` like
    /// [`Renderer::accumulate`](crate::render::Renderer::accumulate).
    ///
    /// # Errors
    ///
    /// If the device refuses or is lost; `film` then has the completed passes.
    pub async fn accumulate_async<C: Camera, A: FilmArgs, R: Radiance, K: Kept<R>>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        sampling: &Sampling,
        film: &mut Film<K>,
        samples: u32,
    ) -> Result<Timing, GpuError> {
        let mut image = Image::filled(film.width(), film.height(), K::none());
        let mut timing = Timing::default();
        for count in passes(samples) {
            let pass = film.pass(camera, kernel, sampling, count);
            let effort = Effort { samples: count, is_even: true };
            timing += self.shoot_async(&pass, effort, &mut image, None).await.map(timing_of)?;
            film.add_pass(&image, count);
        }
        Ok(timing)
    }

    /// Runs a kernel over `inputs`, like [`Renderer::batch`](crate::render::Renderer::batch).
    ///
    /// # Errors
    ///
    /// If the lengths differ, or the device refuses or is lost.
    pub async fn batch_async<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) -> Result<Timing, GpuError> {
        let module = self.batch_module(kernel);
        let each = stride(A::SCHEMA);
        let mut bytes = vec![0; each * inputs.len()];
        for (a, out) in inputs.iter().zip(bytes.chunks_exact_mut(each)) {
            a.write(out);
        }
        let count = u32::try_from(inputs.len())
            .map_err(|_| GpuError::GridTooLarge { size: [u32::MAX, 1] })?;
        let (resources, grid) = (|visit: Visit<'_>| kernel.resources(visit), Grid::of([count, 1]));
        self.run(&resources, &module, &bytes, grid, outputs).await.map(timing_of)
    }

    async fn shoot_async<S: Shot>(
        &self,
        shot: &S,
        effort: Effort,
        image: &mut Image<S::Output>,
        observer: Option<Observer<'_>>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let module = self.module(shot);
        let teller = observer.map(|observer| observer as Teller<'_>);
        let grid = Grid { size: [image.width(), image.height()], effort, teller };
        let resources = |visit: Visit<'_>| shot.resources(visit);
        self.run(&resources, &module, &[], grid, image.pixels_mut()).await
    }

    /// Renders a frame by another text in place of the kernel's own, of which `text` is told. It has
    /// the same bindings and numbers: for tests that compare it with one written by hand.
    ///
    /// # Errors
    ///
    /// As for [`GpuScheduler::frame_into`].
    #[doc(hidden)]
    #[cfg(not(target_family = "wasm"))]
    pub fn frame_by_text<C: Camera, A: FilmArgs, R: Type>(
        &self,
        camera: &C,
        kernel: &Kernel<'_, A, R>,
        image: &mut Image<R>,
        text: impl FnOnce(&str) -> String,
    ) -> Result<Timing, GpuError> {
        let size = [image.width(), image.height()];
        let shot = Frame { rays: camera.begin_frame(size[0], size[1]), kernel };
        let mut module = self.module(&shot);
        module.source = text(&module.source);
        let resources = |visit: Visit<'_>| shot.resources(visit);
        let run = self.run(&resources, &module, &[], Grid::of(size), image.pixels_mut());
        pollster::block_on(run).map(timing_of)
    }

    fn module<S: Shot>(&self, shot: &S) -> Module {
        let kernel = shot.kernel();
        let frame = kernel.record_grid::<S::Output>(|m, x, y, _| {
            shot.pixel_on(m, X2 { x, y }, &|m, _| no_body(m))
        });
        let describe = |out: &mut Description| kernel.describe(out);
        let record = || recorded(shot);
        self.known_module(&kernel.identity(&describe), KernelFrame::new(frame), &record)
    }

    fn batch_module<A: Type, R: Type>(&self, kernel: &Kernel<'_, A, R>) -> Module {
        let describe = |out: &mut Description| kernel.describe(out);
        self.known_module(&kernel.identity(&describe), kernel.frame(), &|| kernel.record())
    }

    /// Returns the module of a kernel in a frame; `record` records it if it is new.
    fn known_module(
        &self,
        kernel: &Identity<'_>,
        frame: KernelFrame,
        record: &dyn Fn() -> Recording,
    ) -> Module {
        lock(&self.context.modules).get(self.context.limits(), kernel, frame, record)
    }

    /// Runs a module; if it is stopped, `outputs` are unchanged.
    async fn run<O: Type>(
        &self,
        resources: Resources<'_>,
        module: &Module,
        inputs: &[u8],
        grid: Grid<'_>,
        outputs: &mut [O],
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let each = stride(O::SCHEMA);
        let mut bytes = vec![0; each * outputs.len()];
        let end = self.run_to(resources, module, inputs, grid, Outputs::Host(&mut bytes)).await?;
        if end.is_continue() {
            for (out, bytes) in outputs.iter_mut().zip(bytes.chunks_exact(each)) {
                *out = O::read(bytes);
            }
        }
        Ok(end)
    }

    async fn run_to(
        &self,
        resources: Resources<'_>,
        module: &Module,
        inputs: &[u8],
        grid: Grid<'_>,
        outputs: Outputs<'_>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let _forget = self.data_of(module);
        let data = |key| bytes_of(resources, key).map(Cow::Owned);
        self.context.run_to(module, &data, inputs, grid, outputs).await
    }

    /// Frees the scene buffers of dropped trees, and those that the module borrows once the result
    /// is dropped.
    fn data_of<'a>(&'a self, module: &'a Module) -> Borrowed<'a> {
        self.context.forget_gone();
        Borrowed { context: &self.context, module }
    }
}

/// The data that a run borrows. It may end early, as a future that is dropped: so it is this whose
/// end frees their copies.
struct Borrowed<'a> {
    context: &'a Context,
    module: &'a Module,
}

impl Drop for Borrowed<'_> {
    fn drop(&mut self) {
        // The address of a slice identifies its data only while it is borrowed.
        let buffers = self.module.buffers.iter().map(|buffer| buffer.key);
        let keys = buffers.chain(self.module.textures.iter().map(|texture| texture.key));
        for key in keys.filter(|key| crate::machine::is_borrowed(*key)) {
            self.context.forget(key.id);
        }
    }
}

#[cfg(not(target_family = "wasm"))]
impl Renderer for GpuScheduler {
    type Timing = Timing;
    type Error = GpuError;
    type UntilError = GpuError;
    type Outcome<T> = Result<T, GpuError>;

    fn add_timing(total: &mut Timing, timing: Timing) {
        *total += timing;
    }

    fn outcome<T>(result: Result<T, GpuError>) -> Result<T, GpuError> {
        result
    }

    fn result<T>(outcome: Result<T, GpuError>) -> Result<T, GpuError> {
        outcome
    }

    fn shoot<S: Shot>(
        &self,
        shot: &S,
        effort: Effort,
        image: &mut Image<S::Output>,
        mut observer: Option<Observer<'_>>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let Some(meanwhile) = self.meanwhile(&|| self.module(shot))? else {
            return pollster::block_on(self.shoot_async(shot, effort, image, observer));
        };
        // When the device begins anew, shares do not fall.
        let mut told = 0.0f64;
        let mut rising = |share: f64| {
            told = told.max(share);
            observer.as_mut().map_or(ControlFlow::Continue(()), |observer| observer(told))
        };
        if let Some(end) = meanwhile.shoot(shot, effort, image, &mut rising) {
            return Ok(end);
        }
        let mut before = meanwhile.timing();
        let end = pollster::block_on(self.shoot_async(shot, effort, image, Some(&mut rising)))?;
        let mut whole = |timing| {
            before += timing;
            before
        };
        Ok(match end {
            ControlFlow::Continue(timing) => ControlFlow::Continue(whole(timing)),
            ControlFlow::Break(timing) => ControlFlow::Break(whole(timing)),
        })
    }

    fn pace(&self, budget: Duration) -> Pace {
        Pace::within(budget)
    }

    fn batch<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        outputs: &mut [R],
    ) -> Result<Timing, GpuError> {
        if inputs.len() != outputs.len() {
            return pollster::block_on(self.batch_async(kernel, inputs, outputs));
        }
        let (mut done, mut timing) = (0, Timing::default());
        if let Some(meanwhile) = self.meanwhile(&|| self.batch_module(kernel))? {
            done = meanwhile.batch(kernel, inputs, outputs);
            timing = meanwhile.timing();
            if done == inputs.len() {
                return Ok(timing);
            }
        }
        timing +=
            pollster::block_on(self.batch_async(kernel, &inputs[done..], &mut outputs[done..]))?;
        Ok(timing)
    }
}

/// Returns a zero as the result of a kernel in a frame recorded without the kernel's body.
fn no_body<V: Value<Recorder>>(m: &Recorder) -> V {
    m.begin_body();
    V::zero(m)
}

/// Returns the bytes of a buffer, created only if the device does not have them yet.
fn bytes_of(resources: Resources<'_>, key: BufferKey) -> Option<Vec<u8>> {
    let mut found = None;
    resources(&mut |resource| {
        if found.is_none() {
            found = resource.bytes(key).map(Cow::into_owned);
        }
    });
    found
}
