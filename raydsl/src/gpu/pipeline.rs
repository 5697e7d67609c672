//! Compute pipelines of kernels: their bindings and their compilation.

use std::num::NonZeroU64;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use super::device::{Gpu, typed};
use super::error::{GpuError, one_line};
use super::float_controls::FloatControls;
#[cfg(not(target_family = "wasm"))]
use super::spirv;
use super::tiles::FIRST_GOAL;

/// The runtime checks that wgpu adds to a shader.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Checks {
    /// All checks: no shader can access memory outside its buffers.
    #[default]
    Full,
    /// No bounds checks: the shader keeps its indices within bounds itself.
    Trusted,
}

/// A compiled kernel; a handle, cheap to clone.
#[derive(Clone)]
pub(super) struct Pipeline {
    pub(super) compute: wgpu::ComputePipeline,
    pub(super) layout: wgpu::BindGroupLayout,
    /// Samples per dispatch at the end of the last run: the next one starts there.
    pub(super) goal: Arc<AtomicU64>,
}

/// A storage binding of a kernel.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Storage {
    pub(super) binding: u32,
    pub(super) read_only: bool,
}

/// A texture of a kernel; its sampler's binding is the next one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Sampled {
    pub(super) binding: u32,
    pub(super) is_volume: bool,
}

/// The least bytes of buffers, by their bindings.
pub(super) type Sizes = Vec<(u32, NonZeroU64)>;

/// All bindings of a kernel but that of the job, which is always the same.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Bindings {
    /// Whether the kernel's numbers are in a storage buffer, by [`stored_parameters`].
    pub(super) has_stored_parameters: bool,
    pub(super) storage: Vec<Storage>,
    pub(super) sampled: Vec<Sampled>,
    /// If the driver gets SPIR-V whose operations it may not fuse or move: what else is asked of it.
    pub(super) exact: Option<FloatControls>,
}

#[cfg(not(target_family = "wasm"))]
impl Bindings {
    /// Returns the numbers of all bindings, in their order.
    pub(super) fn numbers(&self) -> Vec<u32> {
        let storage = self.storage.iter().map(|storage| storage.binding);
        let sampled = self.sampled.iter().flat_map(|s| [s.binding, s.binding + 1]);
        let mut numbers: Vec<u32> = [0, 1].into_iter().chain(storage).chain(sampled).collect();
        numbers.sort_unstable();
        numbers
    }
}

/// How a text declares the kernel's numbers.
const PARAMETERS: &str = "@group(0) @binding(0) var<uniform> ";

/// Returns a text whose numbers are in a storage buffer, if it declares them as printed.
///
/// Lavapipe compiles a kernel again for each dispatch if a condition depends on a uniform buffer alone:
/// it replaces such numbers by their values. That takes seconds where materials are shaded.
pub(super) fn stored_parameters(source: &str) -> Option<String> {
    let stored = "@group(0) @binding(0) var<storage, read> ";
    source.contains(PARAMETERS).then(|| source.replacen(PARAMETERS, stored, 1))
}

/// Compiles a pipeline from a text.
///
/// The layout lists every binding of the module, used or not: a layout deduced from the shader
/// would omit unused bindings, and bind groups would differ.
pub(super) fn compile(
    gpu: &Gpu,
    checks: Checks,
    source: &str,
    bindings: &Bindings,
    cache: Option<&wgpu::PipelineCache>,
) -> Result<Pipeline, GpuError> {
    // What wgpu translates it also checks against the layout.
    #[cfg(not(target_family = "wasm"))]
    if let Some(controls) = bindings.exact {
        let (module, sizes) = exact_shader(gpu, checks, source, bindings, controls)?;
        return assemble(gpu, checks, &module, bindings, &sizes, cache);
    }
    let module = shader(gpu, checks, source)?;
    assemble(gpu, checks, &module, bindings, &Sizes::new(), cache)
}

/// Makes a pipeline of a module.
fn assemble(
    gpu: &Gpu,
    checks: Checks,
    module: &wgpu::ShaderModule,
    bindings: &Bindings,
    sizes: &Sizes,
    cache: Option<&wgpu::PipelineCache>,
) -> Result<Pipeline, GpuError> {
    let (compute, layout) = gpu.explained(|| {
        let layout = layout(&gpu.device, bindings, sizes);
        let made = (pipeline(&gpu.device, module, &layout, checks, cache), layout);
        (made, |error| std::future::ready(failed(error)))
    })?;
    Ok(Pipeline { compute, layout, goal: Arc::new(AtomicU64::new(FIRST_GOAL)) })
}

/// Returns the error for a module of which no pipeline could be made.
fn failed(error: wgpu::Error) -> GpuError {
    match typed(error, "the pipeline") {
        GpuError::Rejected { message, .. } => GpuError::PipelineFailed { message },
        error => error,
    }
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    checks: Checks,
    cache: Option<&wgpu::PipelineCache>,
) -> wgpu::ComputePipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("raydsl"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("raydsl"),
        layout: Some(&layout),
        module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions {
            zero_initialize_workgroup_memory: checks == Checks::Full,
            ..Default::default()
        },
        cache,
    })
}

fn layout(device: &wgpu::Device, bindings: &Bindings, sizes: &Sizes) -> wgpu::BindGroupLayout {
    let uniform = wgpu::BufferBindingType::Uniform;
    let stored = wgpu::BufferBindingType::Storage { read_only: true };
    let parameters = if bindings.has_stored_parameters { stored } else { uniform };
    let uniforms = [buffer(0, parameters), buffer(1, uniform)];
    let storage = bindings.storage.iter().map(|&Storage { binding, read_only }| {
        buffer(binding, wgpu::BufferBindingType::Storage { read_only })
    });
    let sampled = bindings.sampled.iter().flat_map(sampled);
    let mut entries: Vec<_> = uniforms.into_iter().chain(storage).chain(sampled).collect();
    // Vulkan's numbers are the entries' places: those of exact shaders follow this order.
    entries.sort_by_key(|entry| entry.binding);
    for entry in &mut entries {
        if let wgpu::BindingType::Buffer { min_binding_size, .. } = &mut entry.ty {
            let of_entry = sizes.iter().find(|(binding, _)| *binding == entry.binding);
            *min_binding_size = of_entry.map(|(_, size)| *size);
        }
    }
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("raydsl"),
        entries: &entries,
    })
}

fn buffer(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    entry(binding, ty)
}

fn sampled(&Sampled { binding, is_volume }: &Sampled) -> [wgpu::BindGroupLayoutEntry; 2] {
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: if is_volume {
            wgpu::TextureViewDimension::D3
        } else {
            wgpu::TextureViewDimension::D2
        },
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    [entry(binding, texture), entry(binding + 1, sampler)]
}

fn entry(binding: u32, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
}

/// Parses and validates a text; an error quotes the line at fault.
fn shader(gpu: &Gpu, checks: Checks, source: &str) -> Result<wgpu::ShaderModule, GpuError> {
    gpu.explained(|| {
        let module = shader_module(&gpu.device, checks, source);
        let report = module.get_compilation_info();
        let source = source.to_owned();
        let explain = |error| async move {
            match typed(error, "the shader") {
                GpuError::Rejected { message, .. } => invalid(&source, report.await, message),
                error => error,
            }
        };
        (module, explain)
    })
}

fn shader_module(device: &wgpu::Device, checks: Checks, source: &str) -> wgpu::ShaderModule {
    let descriptor = wgpu::ShaderModuleDescriptor {
        label: Some("raydsl"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    };
    match checks {
        Checks::Full => device.create_shader_module(descriptor),
        Checks::Trusted => {
            let trusted = wgpu::ShaderRuntimeChecks {
                bounds_checks: false,
                ..wgpu::ShaderRuntimeChecks::checked()
            };
            // SAFETY: only the bounds checks are off, and `Context::with_checks`, the one way to
            // `Trusted`, requires modules that stay within bounds without them; recorded kernels
            // clamp each index of a buffer and of an array, their stacks have a place for every
            // level that a tree may have, and they leave when their pixel is outside `job.count`.
            // Loop bounding stays on: an infinite loop, possible in a kernel's own `while`, would
            // otherwise let the driver assume anything, clamps included. Integer division keeps its
            // guards for the same reason: a kernel may divide by zero.
            unsafe { device.create_shader_module_trusted(descriptor, trusted) }
        }
    }
}

/// Parses and validates a text as [`shader`], and hands it to the driver as SPIR-V, which no browser
/// takes.
#[cfg(not(target_family = "wasm"))]
fn exact_shader(
    gpu: &Gpu,
    checks: Checks,
    source: &str,
    bindings: &Bindings,
    controls: FloatControls,
) -> Result<(wgpu::ShaderModule, Sizes), GpuError> {
    let spirv::Exact { words, sizes } =
        spirv::exact(source, checks, bindings, controls, &gpu.device.limits())?;
    let entry =
        wgpu::PassthroughShaderEntryPoint { name: "main".into(), workgroup_size: (1, 1, 1) };
    let made = gpu.guarded("the shader", || {
        // SAFETY: wgpu does not look at the words. They are what naga has written for a module that it
        // validated, with the checks that wgpu asks of naga; its bindings are those of the pipeline's
        // layout, which also has the sizes that its buffers must have at least. What is added are
        // decorations of results that the module has, and modes that the device offers. Without
        // bounds checks the conditions are those of `shader_module`.
        unsafe {
            gpu.device.create_shader_module_passthrough(wgpu::ShaderModuleDescriptorPassthrough {
                label: Some("raydsl"),
                entry_points: vec![entry].into(),
                spirv: Some(words.into()),
                ..Default::default()
            })
        }
    })?;
    Ok((made, sizes))
}

/// Returns the error for a text that the compiler, here naga and in a browser its own, refused.
fn invalid(source: &str, report: wgpu::CompilationInfo, fallback: String) -> GpuError {
    let fault = report
        .messages
        .into_iter()
        .find(|message| message.message_type == wgpu::CompilationMessageType::Error);
    let Some(fault) = fault else {
        return GpuError::ShaderInvalid { message: fallback, line: 0, text: String::new() };
    };
    let line = fault.location.map_or(0, |location| location.line_number);
    let text = source.lines().nth((line as usize).wrapping_sub(1));
    GpuError::ShaderInvalid {
        message: one_line(&fault.message),
        line,
        text: text.unwrap_or_default().trim().to_owned(),
    }
}
