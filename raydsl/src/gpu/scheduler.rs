//! A renderer that runs kernels on a device.

use std::borrow::Cow;
use std::ops::ControlFlow;
use std::time::Duration;

use super::device::lock;
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
use crate::render::{Effort, FilmArgs, Frame, Image, Observer, Pace, Renderer, Shot, timing_of};

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
#[derive(Debug)]
pub struct GpuScheduler {
    context: Context,
}

impl GpuScheduler {
    /// Uses the best adapter of this machine.
    ///
    /// # Errors
    ///
    /// If there is none, or it gives no device.
    pub fn new() -> Result<Self, GpuError> {
        Ok(Self::with_context(Context::new()?))
    }

    /// Uses a context, for example of the application's own device and queue.
    pub fn with_context(context: Context) -> Self {
        Self { context }
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
        let pixels = u64::from(width) * u64::from(height);
        check_target::<R>(&self.context.gpu, pixels, window)?;
        let rays = camera.begin_frame(width, height);
        let shot = Frame { rays, kernel };
        let resources = |visit: Visit<'_>| shot.resources(visit);
        let module = self.module(&shot);
        let grid = Grid::of([width, height]);
        self.run_to(&resources, &module, &[], grid, Outputs::Device(window)).map(timing_of)
    }

    fn module<S: Shot>(&self, shot: &S) -> Module {
        let kernel = shot.kernel();
        let frame = kernel.record_grid::<S::Output>(|m, x, y, _| {
            shot.pixel_on(m, X2 { x, y }, &|m, _| no_body(m))
        });
        let record = || {
            kernel.record_grid::<S::Output>(|m, x, y, body| {
                shot.pixel_on(m, X2 { x, y }, &|m, args| {
                    m.begin_body();
                    body(m, args)
                })
            })
        };
        let describe = |out: &mut Description| kernel.describe(out);
        self.known_module(&kernel.identity(&describe), KernelFrame::new(frame), &record)
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
        // The address of a slice identifies its data only while it is borrowed.
        let buffers = module.buffers.iter().map(|buffer| buffer.key);
        let keys = buffers.chain(module.textures.iter().map(|texture| texture.key));
        for key in keys.filter(|key| crate::machine::is_borrowed(*key)) {
            self.context.forget(key.id);
        }
        end
    }
}

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
        observer: Option<Observer<'_>>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let module = self.module(shot);
        let teller = observer.map(|observer| observer as Teller<'_>);
        let grid = Grid { size: [image.width(), image.height()], effort, teller };
        self.run(&|visit| shot.resources(visit), &module, &[], grid, image.pixels_mut())
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
        let describe = |out: &mut Description| kernel.describe(out);
        let identity = kernel.identity(&describe);
        let module = self.known_module(&identity, kernel.frame(), &|| kernel.record());
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
