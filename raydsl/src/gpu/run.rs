//! Dispatch of a recorded kernel over a grid.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;

use super::buffers::{Bound, Source};
use super::context::Context;
use super::device::lock;
use super::error::GpuError;
use super::pipeline::{Bindings, Pipeline, Sampled, Storage, stored_parameters};
use super::pipelines::PipelineSource;
use super::slot::{Finished, InFlight, Pass, Slot};
use super::textures::BoundTexture;
use super::tiles::{Tiler, next_goal};
use super::window::GpuWindow;
use crate::machine::wgsl::{Arithmetic, BufferKey, Module};
use crate::render::{Effort, timing_of};
use crate::run::clock::Instant;

/// Dispatches in flight: one computes while the other's outputs are read back.
const IN_FLIGHT: usize = 2;
/// The limit on a dispatch's inputs or outputs in bytes: several dispatches overlap better with
/// their transfers than one large one, and the buffers stay small beside the scene.
const TILE_BYTES: u64 = 64 << 20;

/// A callback that receives the completed share of a run and returns whether to go on.
pub(super) type Teller<'a> = &'a mut dyn FnMut(f64) -> ControlFlow<()>;

/// A grid to run: its size, the cost of a pixel, and the progress callback.
pub(super) struct Grid<'a> {
    pub(super) size: [u32; 2],
    pub(super) effort: Effort,
    pub(super) teller: Option<Teller<'a>>,
}

impl Grid<'_> {
    /// Creates a grid with one sample per pixel and no progress callback.
    pub(super) const fn of(size: [u32; 2]) -> Self {
        Self { size, effort: Effort::ONE, teller: None }
    }
}

/// The destination of a run's outputs.
pub(super) enum Outputs<'a> {
    /// The host, `output_stride` bytes per pixel.
    Host(&'a mut [u8]),
    /// A checked window of the application; nothing is read back.
    Device(&'a GpuWindow),
}

/// The time of a run.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Timing {
    /// The compute passes alone, by the device's clock, if it has one.
    pub device_ms: Option<f64>,
    /// The whole call, including uploads, compilation and readback.
    pub wall_ms: f64,
    /// The number of dispatches of the grid.
    pub dispatches: u32,
}

impl core::ops::AddAssign for Timing {
    fn add_assign(&mut self, other: Self) {
        self.device_ms = match (self.device_ms, other.device_ms) {
            (Some(a), Some(b)) => Some(a + b),
            (a, b) => a.or(b),
        };
        self.wall_ms += other.wall_ms;
        self.dispatches += other.dispatches;
    }
}

impl Context {
    /// Runs `module` once per pixel of a grid of `size`, or per element of a batch of `size` (n,
    /// 1), and waits for the outputs.
    ///
    /// `data` returns the bytes of the scene buffers that are not on the device yet; it must not
    /// call this context, whose cache is locked meanwhile.
    ///
    /// `inputs` and `outputs` are in row order, `input_stride` and `output_stride` bytes per pixel;
    /// `outputs` must have exactly that length. After an error it holds the results of the
    /// completed dispatches.
    #[cfg(not(target_family = "wasm"))]
    pub fn run<'a>(
        &self,
        module: &Module,
        data: &dyn Fn(BufferKey) -> Option<Cow<'a, [u8]>>,
        inputs: &[u8],
        size: [u32; 2],
        outputs: &mut [u8],
    ) -> Result<Timing, GpuError> {
        pollster::block_on(self.run_async(module, data, inputs, size, outputs))
    }

    /// Runs `module` like [`Context::run`]. In a browser nothing but the future waits; on a machine
    /// the thread that polls it waits for the device, and the future is ready.
    pub async fn run_async<'a>(
        &self,
        module: &Module,
        data: &dyn Fn(BufferKey) -> Option<Cow<'a, [u8]>>,
        inputs: &[u8],
        size: [u32; 2],
        outputs: &mut [u8],
    ) -> Result<Timing, GpuError> {
        let outputs = Outputs::Host(outputs);
        self.run_to(module, data, inputs, Grid::of(size), outputs).await.map(timing_of)
    }

    /// Does the same with a chosen destination of the outputs, unless the progress callback stops
    /// it.
    pub(super) async fn run_to<'a>(
        &self,
        module: &Module,
        data: &dyn Fn(BufferKey) -> Option<Cow<'a, [u8]>>,
        inputs: &[u8],
        grid: Grid<'_>,
        outputs: Outputs<'_>,
    ) -> Result<ControlFlow<Timing, Timing>, GpuError> {
        let start = Instant::now();
        let pixels = pixels(grid.size)?;
        self.check_lengths(module, pixels, inputs)?;
        if let Outputs::Host(bytes) = &outputs {
            expect("outputs", bytes, pixels, module.output_stride)?;
        }
        if pixels == 0 {
            return Ok(ControlFlow::Continue(Timing::default()));
        }
        let (target, outputs) = match outputs {
            Outputs::Host(bytes) => (None, bytes),
            Outputs::Device(window) => (Some(window), &mut [][..]),
        };
        let (pass, tiler) = self.prepare(module, data, inputs, grid.size, target)?;
        let mut timing = Timing::default();
        let end = self.dispatch_all(&pass, tiler, outputs, grid, &mut timing).await;
        // The late error of a call is the cause of one of the wait.
        self.answered().await?;
        timing.wall_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(match end? {
            ControlFlow::Continue(()) => ControlFlow::Continue(timing),
            ControlFlow::Break(()) => ControlFlow::Break(timing),
        })
    }

    /// Submits all dispatches of a grid and waits for none. Errors come with the next call.
    #[cfg(target_family = "wasm")]
    pub(super) fn submit_to<'a>(
        &self,
        module: &Module,
        data: &dyn Fn(BufferKey) -> Option<Cow<'a, [u8]>>,
        size: [u32; 2],
        window: &GpuWindow,
    ) -> Result<Timing, GpuError> {
        let start = Instant::now();
        let pixels = pixels(size)?;
        self.check_lengths(module, pixels, &[])?;
        if pixels == 0 {
            return Ok(Timing::default());
        }
        let (pass, mut tiler) = self.prepare(module, data, &[], size, Some(window))?;
        let goal = pass.pipeline.goal.load(Ordering::Relaxed);
        let mut slot = self.slot()?;
        let mut timing = Timing::default();
        while let Some(tile) = tiler.next(goal) {
            slot.submit_unread(&self.gpu, &pass, tile)?;
            timing.dispatches += 1;
        }
        lock(&self.idle).push(slot);
        timing.wall_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(timing)
    }

    /// Returns what all dispatches of a grid share, uploaded and compiled, and their partition.
    fn prepare<'p>(
        &self,
        module: &'p Module,
        data: Source<'_, '_>,
        inputs: &'p [u8],
        size: [u32; 2],
        target: Option<&'p GpuWindow>,
    ) -> Result<(Pass<'p>, Tiler), GpuError> {
        self.check()?;
        let max_elements = self.max_elements(module)?;
        let pass = Pass {
            module,
            target,
            pipeline: self.pipeline(module)?,
            uniforms: self.uniforms(module)?,
            scene: self.scene(module, data)?,
            textures: self.textures(module, data)?,
            size,
            inputs,
        };
        let max_groups = self.gpu.caps.max_groups;
        Ok((pass, Tiler::new(size, module.workgroup, max_elements, max_groups)))
    }

    /// Returns buffers for a dispatch.
    fn slot(&self) -> Result<Slot, GpuError> {
        let kept = lock(&self.idle).pop();
        kept.map_or_else(|| Slot::new(&self.gpu), Ok)
    }

    /// Checks the module's sizes and the caller's slices against each other.
    fn check_lengths(&self, module: &Module, pixels: u64, inputs: &[u8]) -> Result<(), GpuError> {
        let bad = |reason: &str| Err(GpuError::BadModule { reason: reason.to_owned() });
        if module.output_stride == 0 {
            return bad("it has no outputs");
        }
        if !(module.input_stride.is_multiple_of(4) && module.output_stride.is_multiple_of(4)) {
            return bad("the strides of inputs and outputs must be multiples of 4");
        }
        if module.workgroup.contains(&0) {
            return bad("its workgroup is empty");
        }
        if module.uniforms.is_empty() || !module.uniforms.len().is_multiple_of(16) {
            return bad("its uniforms must be a positive multiple of 16 bytes");
        }
        expect("inputs", inputs, pixels, module.input_stride)
    }

    /// Returns how many elements of the inputs and outputs fit in one dispatch.
    fn max_elements(&self, module: &Module) -> Result<u64, GpuError> {
        let caps = &self.gpu.caps;
        let stride = u64::from(module.input_stride.max(module.output_stride));
        if stride > caps.max_binding {
            return Err(GpuError::BindingTooLarge {
                name: "one element of the inputs or outputs".to_owned(),
                bytes: stride,
                limit: caps.max_binding,
            });
        }
        // The staging buffer also holds the timestamps.
        let budget = caps.max_binding.min(caps.max_buffer.saturating_sub(64));
        Ok((budget.min(TILE_BYTES) / stride).max(1))
    }

    /// Returns the compiled kernel.
    fn pipeline(&self, module: &Module) -> Result<Pipeline, GpuError> {
        self.pipelines.get(&self.gpu, self.checks, &self.pipeline_source(module)?)
    }

    /// Returns what the kernel is compiled from.
    pub(super) fn pipeline_source<'m>(
        &self,
        module: &'m Module,
    ) -> Result<PipelineSource<'m>, GpuError> {
        let sampled = module.textures.iter().map(|texture| Sampled {
            binding: texture.binding,
            is_volume: texture.layout.is_volume,
        });
        let storage = storage(module);
        let limit = self.gpu.caps.max_storage_buffers;
        let needed = storage.len() as u64;
        if needed > u64::from(limit) {
            return Err(GpuError::TooManyBuffers { needed, limit });
        }
        let has_room =
            needed < u64::from(limit) && self.adapter_info().name.starts_with("llvmpipe");
        let stored = if has_room { stored_parameters(&module.source) } else { None };
        let has_stored_parameters = stored.is_some();
        let exact = self.spirv.filter(|_| module.arithmetic == Arithmetic::Strict);
        let sampled = sampled.collect();
        let bindings = Bindings { has_stored_parameters, storage, sampled, exact };
        let text = stored.map_or(Cow::Borrowed(&*module.source), Cow::Owned);
        Ok(PipelineSource { text, bindings })
    }

    /// Uploads the kernel's uniform buffer.
    fn uniforms(&self, module: &Module) -> Result<wgpu::Buffer, GpuError> {
        let bytes = module.uniforms.len() as u64;
        let limit = self.gpu.caps.max_uniform;
        if bytes > limit {
            return Err(GpuError::BindingTooLarge {
                name: "the kernel's parameters".to_owned(),
                bytes,
                limit,
            });
        }
        // Either a uniform or a storage buffer, as the pipeline has it.
        let usage = wgpu::BufferUsages::UNIFORM
            | wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_DST;
        let buffer = self.gpu.buffer("parameters", bytes, usage)?;
        self.gpu.guarded("the kernel's parameters", || {
            self.gpu.queue.write_buffer(&buffer, 0, &module.uniforms);
        })?;
        Ok(buffer)
    }

    /// Returns the bindings of all scene buffers' windows, uploading where needed.
    fn scene(&self, module: &Module, data: Source<'_, '_>) -> Result<Vec<Bound>, GpuError> {
        let mut uploads = lock(&self.uploads);
        let mut scene = Vec::new();
        for buffer in &module.buffers {
            scene.extend(uploads.bind(&self.gpu, buffer, data)?);
        }
        Ok(scene)
    }

    /// Returns the bindings of all sampled textures, uploading where needed.
    fn textures(
        &self,
        module: &Module,
        data: Source<'_, '_>,
    ) -> Result<Vec<BoundTexture>, GpuError> {
        let mut textures = lock(&self.textures);
        module.textures.iter().map(|texture| textures.bind(&self.gpu, texture, data)).collect()
    }

    /// Submits the tiles, a few in flight, and adapts their size. Tiles in flight are completed
    /// even after a stop.
    async fn dispatch_all(
        &self,
        pass: &Pass<'_>,
        mut tiler: Tiler,
        outputs: &mut [u8],
        grid: Grid<'_>,
        timing: &mut Timing,
    ) -> Result<ControlFlow<()>, GpuError> {
        let Grid { effort, mut teller, .. } = grid;
        let all = u64::from(pass.size[0]) * u64::from(pass.size[1]);
        let goal = pass.pipeline.goal.load(Ordering::Relaxed);
        let mut progress = Progress { goal, effort, last_end: None, timing, done: 0 };
        let mut in_flight: VecDeque<InFlight> = VecDeque::with_capacity(IN_FLIGHT);
        let mut end = ControlFlow::Continue(());
        while let Some(tile) = tiler.next(progress.goal / u64::from(effort.samples.max(1))) {
            // The callers report the beginning and the end.
            if progress.done > 0
                && let Some(teller) = &mut teller
                && teller(progress.done as f64 / all as f64).is_break()
            {
                end = ControlFlow::Break(());
                break;
            }
            if in_flight.len() == IN_FLIGHT
                && let Some(oldest) = in_flight.pop_front()
            {
                self.retire(oldest, pass, outputs, &mut progress).await?;
            }
            in_flight.push_back(self.slot()?.submit(&self.gpu, pass, tile)?);
            progress.timing.dispatches += 1;
        }
        for oldest in in_flight {
            self.retire(oldest, pass, outputs, &mut progress).await?;
        }
        if effort.is_even {
            pass.pipeline.goal.store(progress.goal, Ordering::Relaxed);
        }
        Ok(end)
    }

    /// Copies the outputs of a dispatch and keeps its buffers for reuse.
    async fn retire(
        &self,
        dispatch: InFlight,
        pass: &Pass<'_>,
        outputs: &mut [u8],
        progress: &mut Progress<'_>,
    ) -> Result<(), GpuError> {
        let since = dispatch.since;
        let finished = dispatch.finish(&self.gpu, pass, outputs).await?;
        progress.note(since, &finished);
        lock(&self.idle).push(finished.slot);
        Ok(())
    }
}

/// The progress of a run.
struct Progress<'a> {
    /// Samples per dispatch.
    goal: u64,
    effort: Effort,
    last_end: Option<Instant>,
    timing: &'a mut Timing,
    /// Completed pixels.
    done: u64,
}

impl Progress<'_> {
    /// Records a finished dispatch. Without timestamps its time runs from its submission, or from
    /// the end of the dispatch before it, until now.
    fn note(&mut self, since: Instant, finished: &Finished) {
        let now = Instant::now();
        let begin = self.last_end.map_or(since, |end| end.max(since));
        self.last_end = Some(now);
        let wall_ms = (now - begin).as_secs_f64() * 1e3;
        if let Some(ms) = finished.device_ms {
            *self.timing.device_ms.get_or_insert(0.0) += ms;
        }
        let ms = finished.device_ms.unwrap_or(wall_ms);
        let pixels = finished.tile.invocations();
        self.done += pixels;
        let goal = next_goal(self.goal, pixels * u64::from(self.effort.samples), ms);
        // Pixels that have all their samples are fast, and do not predict their neighbours.
        self.goal = if self.effort.is_even { goal } else { goal.min(self.goal) };
    }
}

/// Returns the number of pixels, which shaders count in a u32.
fn pixels(size: [u32; 2]) -> Result<u64, GpuError> {
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    if pixels > u64::from(u32::MAX) {
        return Err(GpuError::GridTooLarge { size });
    }
    Ok(pixels)
}

/// Checks the length of inputs or outputs.
fn expect(what: &str, bytes: &[u8], pixels: u64, stride: u32) -> Result<(), GpuError> {
    let needed = pixels * u64::from(stride);
    if bytes.len() as u64 == needed {
        return Ok(());
    }
    Err(GpuError::WrongLength {
        what: format!("the slice of {what}"),
        bytes: bytes.len() as u64,
        needed,
    })
}

/// Returns the module's storage bindings: inputs, outputs, windows.
fn storage(module: &Module) -> Vec<Storage> {
    let windows = module.buffers.iter().flat_map(|buffer| &buffer.windows);
    let read = windows.map(|window| window.binding);
    let inputs = (module.input_stride > 0).then_some(2);
    let read = inputs.into_iter().chain(read).map(|binding| Storage { binding, read_only: true });
    let outputs = Storage { binding: 3, read_only: false };
    std::iter::once(outputs).chain(read).collect()
}
