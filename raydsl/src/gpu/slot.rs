//! A dispatch: its buffers, its submission and the readback of its outputs.

use futures_channel::oneshot;

use super::buffers::Bound;
use super::clock::{Clock, STAMPS};
use super::device::{Gpu, lost};
use super::error::GpuError;
use super::pipeline::Pipeline;
use super::textures::BoundTexture;
use super::tiles::Tile;
use super::window::GpuWindow;
use crate::machine::wgsl::Module;
use crate::run::clock::Instant;

/// Bytes of WGSL's `struct Job`.
const JOB: u64 = 32;

/// The data shared by all dispatches of one run.
pub(super) struct Pass<'a> {
    pub(super) module: &'a Module,
    /// The destination of the outputs, if they stay on the device.
    pub(super) target: Option<&'a GpuWindow>,
    pub(super) pipeline: Pipeline,
    pub(super) uniforms: wgpu::Buffer,
    pub(super) scene: Vec<Bound>,
    pub(super) textures: Vec<BoundTexture>,
    pub(super) size: [u32; 2],
    pub(super) inputs: &'a [u8],
}

/// The buffers of one dispatch, kept for the next one and grown as needed.
pub(super) struct Slot {
    job: wgpu::Buffer,
    inputs: Option<wgpu::Buffer>,
    outputs: Option<wgpu::Buffer>,
    staging: Option<wgpu::Buffer>,
    clock: Option<Clock>,
}

/// A dispatch in flight.
pub(super) struct InFlight {
    slot: Slot,
    staging: wgpu::Buffer,
    tile: Tile,
    index: wgpu::SubmissionIndex,
    mapped: oneshot::Receiver<bool>,
    /// The time of submission.
    pub(super) since: Instant,
}

/// The buffers of one dispatch, large enough for it.
struct Room {
    /// The inputs with their bytes, if there are any.
    inputs: Option<(wgpu::Buffer, u64)>,
    /// The outputs with their bytes.
    outputs: (wgpu::Buffer, u64),
    /// The buffer that the host reads, unless it reads nothing.
    staging: Option<wgpu::Buffer>,
}

/// A finished dispatch.
pub(super) struct Finished {
    pub(super) slot: Slot,
    pub(super) tile: Tile,
    /// The time of the compute pass, if the device measures it.
    pub(super) device_ms: Option<f64>,
}

impl Slot {
    /// Creates an empty slot.
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let clock = gpu.caps.timestamps.then(|| Clock::new(gpu)).transpose()?;
        Ok(Self {
            job: gpu.buffer("job", JOB, usage)?,
            inputs: None,
            outputs: None,
            staging: None,
            clock,
        })
    }

    /// Uploads the tile's inputs and submits its dispatch.
    pub(super) fn submit(
        mut self,
        gpu: &Gpu,
        pass: &Pass<'_>,
        tile: Tile,
    ) -> Result<InFlight, GpuError> {
        let bytes = packed_bytes(pass, tile) + STAMPS;
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let staging = room(&mut self.staging, gpu, "readback", bytes, usage)?;
        let room = self.room(gpu, pass, tile, Some(staging.clone()))?;
        let (report, mapped) = oneshot::channel();
        let index = gpu.guarded("a dispatch", || {
            let index = gpu.queue.submit([self.commands(gpu, pass, tile, &room)]);
            staging.map_async(wgpu::MapMode::Read, 0..bytes, move |result| {
                // The receiver is gone after an error elsewhere.
                let _ = report.send(result.is_ok());
            });
            index
        })?;
        Ok(InFlight { slot: self, staging, tile, index, mapped, since: Instant::now() })
    }

    /// Submits a dispatch of which the host reads nothing. The buffers serve the next one at once:
    /// submissions run in their order.
    #[cfg(target_family = "wasm")]
    pub(super) fn submit_unread(
        &mut self,
        gpu: &Gpu,
        pass: &Pass<'_>,
        tile: Tile,
    ) -> Result<(), GpuError> {
        let room = self.room(gpu, pass, tile, None)?;
        gpu.guarded("a dispatch", || {
            gpu.queue.submit([self.commands(gpu, pass, tile, &room)]);
        })
    }

    /// Returns buffers for a tile.
    fn room(
        &mut self,
        gpu: &Gpu,
        pass: &Pass<'_>,
        tile: Tile,
        staging: Option<wgpu::Buffer>,
    ) -> Result<Room, GpuError> {
        use wgpu::BufferUsages as Usage;
        let span = tile.span(pass.size[0]);
        let input_bytes = span * u64::from(pass.module.input_stride);
        let output_bytes = span * u64::from(pass.module.output_stride);
        let usage = Usage::STORAGE | Usage::COPY_DST;
        let inputs = match input_bytes {
            0 => None,
            bytes => Some((room(&mut self.inputs, gpu, "inputs", bytes, usage)?, bytes)),
        };
        let usage = Usage::STORAGE | Usage::COPY_SRC;
        let outputs = room(&mut self.outputs, gpu, "outputs", output_bytes, usage)?;
        Ok(Room { inputs, outputs: (outputs, output_bytes), staging })
    }

    /// Uploads the inputs and returns the commands of a dispatch.
    fn commands(&self, gpu: &Gpu, pass: &Pass<'_>, tile: Tile, room: &Room) -> wgpu::CommandBuffer {
        self.write(gpu, pass, tile, room.inputs.as_ref().map(|(buffer, _)| buffer));
        let group = self.bind(gpu, pass, room);
        self.record(gpu, pass, tile, &group, room)
    }

    /// Queues the job and the inputs, which are transferred with the next submission.
    fn write(&self, gpu: &Gpu, pass: &Pass<'_>, tile: Tile, inputs: Option<&wgpu::Buffer>) {
        let width = pass.size[0];
        // Fits: `run` refuses grids of 2^32 pixels and more.
        let base = tile.first[1] * width + tile.first[0];
        let [w, h] = pass.size;
        let ([x, y], [columns, rows]) = (tile.first, tile.count);
        let job = [w, h, x, y, columns, rows, base, 0];
        gpu.queue.write_buffer(&self.job, 0, bytemuck::bytes_of(&job));
        let Some(inputs) = inputs else { return };
        let stride = u64::from(pass.module.input_stride);
        for (first, length) in tile.runs(width) {
            let bytes = (first * stride) as usize..((first + length) * stride) as usize;
            let at = (first - u64::from(base)) * stride;
            gpu.queue.write_buffer(inputs, at, &pass.inputs[bytes]);
        }
    }

    /// Creates the bind group of a dispatch. Inputs and outputs are bound with their exact sizes,
    /// so that a checked shader is checked against the tile and not against old contents.
    fn bind(&self, gpu: &Gpu, pass: &Pass<'_>, room: &Room) -> wgpu::BindGroup {
        let mut entries = vec![
            entry(0, &pass.uniforms, 0, pass.module.uniforms.len() as u64),
            entry(1, &self.job, 0, JOB),
            entry(3, &room.outputs.0, 0, room.outputs.1),
        ];
        let inputs = room.inputs.as_ref();
        entries.extend(inputs.map(|(buffer, bytes)| entry(2, buffer, 0, *bytes)));
        let scene = pass.scene.iter();
        entries.extend(
            scene.map(|bound| entry(bound.binding, &bound.buffer, bound.offset, bound.size)),
        );
        entries.extend(pass.textures.iter().flat_map(|BoundTexture { binding, view, sampler }| {
            let texture = wgpu::BindingResource::TextureView(view);
            let sampler = wgpu::BindingResource::Sampler(sampler);
            [(*binding, texture), (*binding + 1, sampler)]
                .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        }));
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("raydsl"),
            layout: &pass.pipeline.layout,
            entries: &entries,
        })
    }

    /// Records the dispatch, the copy of the outputs to the staging buffer or the application's,
    /// and then the timestamps.
    fn record(
        &self,
        gpu: &Gpu,
        pass: &Pass<'_>,
        tile: Tile,
        group: &wgpu::BindGroup,
        room: &Room,
    ) -> wgpu::CommandBuffer {
        let staging = room.staging.as_ref();
        // Without a buffer for the host nobody reads the clock.
        let clock = self.clock.as_ref().zip(staging);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("raydsl"),
                timestamp_writes: clock.map(|(clock, _)| clock.writes()),
            });
            compute.set_pipeline(&pass.pipeline.compute);
            compute.set_bind_group(0, group, &[]);
            let [columns, rows] = pass.module.workgroup;
            let groups = [tile.count[0].div_ceil(columns), tile.count[1].div_ceil(rows)];
            compute.dispatch_workgroups(groups[0], groups[1], 1);
        }
        let outputs = &room.outputs.0;
        let stride = u64::from(pass.module.output_stride);
        let mut base = None;
        let mut at = 0;
        for (first, length) in tile.runs(pass.size[0]) {
            let from = (first - *base.get_or_insert(first)) * stride;
            let bytes = length * stride;
            if let Some(window) = pass.target {
                let place = window.offset + first * stride;
                encoder.copy_buffer_to_buffer(outputs, from, &window.buffer, place, bytes);
            } else if let Some(staging) = staging {
                encoder.copy_buffer_to_buffer(outputs, from, staging, at, bytes);
            }
            at += bytes;
        }
        if let Some((clock, staging)) = clock {
            clock.copy(&mut encoder, staging, packed_bytes(pass, tile));
        }
        encoder.finish()
    }
}

impl InFlight {
    /// Waits for the dispatch and copies its outputs into the grid.
    pub(super) async fn finish(
        self,
        gpu: &Gpu,
        pass: &Pass<'_>,
        outputs: &mut [u8],
    ) -> Result<Finished, GpuError> {
        gpu.wait(self.index)?;
        if !is_mapped(gpu, self.mapped).await? {
            gpu.check()?;
            return Err(lost("the outputs could not be mapped"));
        }
        let packed = packed_bytes(pass, self.tile);
        let view = self
            .staging
            .get_mapped_range(0..packed + STAMPS)
            .map_err(|error| lost(&error.to_string()))?;
        let stride = u64::from(pass.module.output_stride);
        let mut rest = &view[..];
        let is_back = pass.target.is_none();
        for (first, length) in self.tile.runs(pass.size[0]).filter(|_| is_back) {
            let to = (first * stride) as usize..((first + length) * stride) as usize;
            let (run, after) = rest.split_at(to.len());
            outputs[to].copy_from_slice(run);
            rest = after;
        }
        let stamps = &view[packed as usize..];
        let clock = self.slot.clock.as_ref();
        let device_ms = clock.map(|clock| clock.milliseconds(stamps));
        drop(view);
        self.staging.unmap();
        Ok(Finished { slot: self.slot, tile: self.tile, device_ms })
    }
}

/// Waits until the outputs are mapped.
#[cfg(target_family = "wasm")]
async fn is_mapped(_: &Gpu, mapped: oneshot::Receiver<bool>) -> Result<bool, GpuError> {
    Ok(mapped.await == Ok(true))
}

/// Waits until the outputs are mapped. The work is done by now, but another thread's poll may be the
/// one to report it, which is a matter of microseconds unless that thread has ended.
#[cfg(not(target_family = "wasm"))]
async fn is_mapped(gpu: &Gpu, mut mapped: oneshot::Receiver<bool>) -> Result<bool, GpuError> {
    let start = Instant::now();
    loop {
        match mapped.try_recv() {
            Ok(Some(is_mapped)) => return Ok(is_mapped),
            Err(_) => return Ok(false),
            Ok(None) if start.elapsed() > gpu.timeout => {
                return Err(GpuError::Timeout { seconds: gpu.timeout.as_secs_f64() });
            }
            Ok(None) => std::thread::yield_now(),
        }
    }
}

/// Returns the bytes of a tile's outputs that are read back, without the gaps between its rows,
/// rounded up to the alignment of a map.
fn packed_bytes(pass: &Pass<'_>, tile: Tile) -> u64 {
    if pass.target.is_some() {
        return 0;
    }
    let bytes = tile.invocations() * u64::from(pass.module.output_stride);
    bytes.next_multiple_of(wgpu::MAP_ALIGNMENT)
}

/// Returns the buffer in `kept` if it is large enough, else a new one with spare capacity.
fn room(
    kept: &mut Option<wgpu::Buffer>,
    gpu: &Gpu,
    name: &str,
    bytes: u64,
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, GpuError> {
    if let Some(buffer) = kept.as_ref().filter(|buffer| buffer.size() >= bytes) {
        return Ok(buffer.clone());
    }
    let largest = gpu.caps.max_buffer & !3;
    let roomy = bytes.next_power_of_two().min(largest).max(bytes);
    // Frees the small one first.
    *kept = None;
    let buffer = gpu.buffer(name, roomy, usage)?;
    *kept = Some(buffer.clone());
    Ok(buffer)
}

fn entry(binding: u32, buffer: &wgpu::Buffer, offset: u64, bytes: u64) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset,
            size: wgpu::BufferSize::new(bytes),
        }),
    }
}
