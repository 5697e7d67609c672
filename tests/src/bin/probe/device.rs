//! A device that evaluates one expression on many inputs.

use raydsl::gpu::Context;
use raydsl::machine::wgsl::{Arithmetic, Module};

/// Any failure; it ends the program.
pub(crate) type Error = Box<dyn std::error::Error>;

/// The numbers that an expression names `a`, `b`, `c` and `d`.
pub(crate) type Input = [f32; 4];

/// How a text reaches the driver.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Path {
    /// As wgpu translates it.
    Wgsl,
    /// As the library's SPIR-V, with `NoContraction` at each operation.
    NoContraction,
}

pub(crate) struct Device {
    pub(crate) context: Context,
}

impl Device {
    pub(crate) fn open() -> Result<Self, Error> {
        pollster::block_on(async {
            let descriptor = wgpu::InstanceDescriptor::new_without_display_handle().with_env();
            let instance = wgpu::Instance::new(descriptor);
            let options = wgpu::RequestAdapterOptions {
                power_preference: wgpu::PowerPreference::HighPerformance,
                ..Default::default()
            };
            let adapter = instance.request_adapter(&options).await?;
            // Filters of `f32` are what the library's own device does without.
            let wanted = wgpu::Features::PASSTHROUGH_SHADERS | wgpu::Features::FLOAT32_FILTERABLE;
            let request = adapter.request_device(&wgpu::DeviceDescriptor {
                required_features: adapter.features() & wanted,
                required_limits: adapter.limits(),
                // SAFETY: the one experimental feature is that of passed shaders, which only the
                // library makes.
                experimental_features: unsafe { wgpu::ExperimentalFeatures::enabled() },
                ..Default::default()
            });
            let (device, queue) = request.await?;
            Ok(Self { context: Context::from_wgpu(Some(adapter.get_info()), device, queue) })
        })
    }

    pub(crate) fn name(&self) -> String {
        format!("{}, {}", self.context.adapter_name(), self.context.adapter_info().driver_info)
    }

    pub(crate) fn has(&self, feature: wgpu::Features) -> bool {
        self.context.device().features().contains(feature)
    }

    /// Returns the paths that the device takes.
    pub(crate) fn paths(&self) -> Vec<Path> {
        let takes_spirv = self.context.is_exact();
        if takes_spirv { vec![Path::Wgsl, Path::NoContraction] } else { vec![Path::Wgsl] }
    }

    /// Prints the adapter and the limits that decide how scenes are cut into windows.
    pub(crate) fn print_limits(&self) {
        println!("{}", self.name());
        let (limits, adapter) = (self.context.device().limits(), self.context.adapter_info());
        let (device, queue) = (self.context.device().clone(), self.context.queue().clone());
        match Context::from_wgpu(Some(adapter.clone()), device, queue).require_exact() {
            Ok(_) => println!("strict kernels: taken, with the bits of the CPU's variants"),
            Err(refusal) => println!("strict kernels: refused, {refusal}"),
        }
        for (name, value) in [
            ("bytes of a storage binding", limits.max_storage_buffer_binding_size),
            ("bytes of a buffer", limits.max_buffer_size),
            ("bytes of a uniform binding", limits.max_uniform_buffer_binding_size),
            ("storage buffers of a stage", limits.max_storage_buffers_per_shader_stage.into()),
            ("alignment of an offset", limits.min_storage_buffer_offset_alignment.into()),
            ("workgroups along an axis", limits.max_compute_workgroups_per_dimension.into()),
            ("invocations of a workgroup", limits.max_compute_invocations_per_workgroup.into()),
            ("bytes of a workgroup", limits.max_compute_workgroup_storage_size.into()),
            ("invocations of a subgroup, least", adapter.subgroup_min_size.into()),
            ("invocations of a subgroup, most", adapter.subgroup_max_size.into()),
        ] {
            println!("{name:<34}{value:>20}");
        }
    }

    /// Returns what statements leave in `r: f32`, for each input.
    pub(crate) fn evaluate(
        &self,
        path: Path,
        body: &str,
        inputs: &[Input],
    ) -> Result<Vec<f32>, Error> {
        let bytes: Vec<u8> = inputs.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let mut outputs = vec![0; 4 * inputs.len()];
        let size = [u32::try_from(inputs.len())?, 1];
        self.context.run(&module(path, body), &|_| None, &bytes, size, &mut outputs)?;
        Ok(floats(&outputs))
    }

    pub(crate) fn buffer(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let label = Some(label);
        let descriptor = wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false };
        self.context.device().create_buffer(&descriptor)
    }

    /// Returns the floats in a buffer, once what was submitted is done.
    pub(crate) fn read(&self, staging: &wgpu::Buffer) -> Result<Vec<f32>, Error> {
        let slice = staging.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        self.context.device().poll(wgpu::PollType::wait_indefinitely())?;
        Ok(floats(&slice.get_mapped_range()?))
    }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|word| f32::from_le_bytes(*word)).collect()
}

/// Returns the module that runs statements on each input.
fn module(path: Path, body: &str) -> Module {
    let source = format!(
        "struct Job {{
    size: vec2<u32>,
    first: vec2<u32>,
    count: vec2<u32>,
    base: u32,
    pad: u32,
}}
@group(0) @binding(0) var<uniform> params: vec4<u32>;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(2) var<storage, read> inputs: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    if (any(id.xy >= job.count)) {{ return; }}
    let index = job.first.x + id.x - job.base;
    let input = inputs[index];
    let a = input.x;
    let b = input.y;
    let c = input.z;
    let d = input.w;
    var r = 0.0;
    {body}
    outputs[index] = r;
}}
"
    );
    Module {
        source,
        arithmetic: match path {
            Path::Wgsl => Arithmetic::Fast,
            Path::NoContraction => Arithmetic::Strict,
        },
        workgroup: [64, 1],
        uniforms: vec![0; 16],
        input_stride: 16,
        output_stride: 4,
        buffers: Vec::new(),
        textures: Vec::new(),
    }
}
