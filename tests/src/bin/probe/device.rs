//! A device that evaluates one expression on many inputs.

use wgpu::util::DeviceExt;

use crate::spirv;

/// Any failure; it ends the program.
pub(crate) type Error = Box<dyn std::error::Error>;

/// The numbers that an expression names `a`, `b`, `c` and `d`.
pub(crate) type Input = [f32; 4];

/// How a text reaches the driver.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Path {
    /// As wgpu translates it.
    Wgsl,
    /// As naga's SPIR-V, with `NoContraction` at each operation.
    NoContraction,
}

pub(crate) struct Device {
    adapter: wgpu::AdapterInfo,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

/// Invocations of a workgroup.
const GROUP: u32 = 64;

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
            let wanted = wgpu::Features::PASSTHROUGH_SHADERS | wgpu::Features::FLOAT32_FILTERABLE;
            let request = adapter.request_device(&wgpu::DeviceDescriptor {
                required_features: adapter.features() & wanted,
                required_limits: adapter.limits(),
                // SAFETY: the one experimental feature is that of passed shaders, and those are what
                // naga wrote, with decorations.
                experimental_features: unsafe { wgpu::ExperimentalFeatures::enabled() },
                ..Default::default()
            });
            let (device, queue) = request.await?;
            Ok(Self { adapter: adapter.get_info(), device, queue })
        })
    }

    pub(crate) fn name(&self) -> String {
        let wgpu::AdapterInfo { name, driver, driver_info, backend, .. } = &self.adapter;
        format!("{name} ({backend:?}, {driver} {driver_info})")
    }

    pub(crate) fn has(&self, feature: wgpu::Features) -> bool {
        self.device.features().contains(feature)
    }

    /// Returns the paths that the device takes.
    pub(crate) fn paths(&self) -> Vec<Path> {
        let is_vulkan = self.adapter.backend == wgpu::Backend::Vulkan;
        let takes_spirv = is_vulkan && self.has(wgpu::Features::PASSTHROUGH_SHADERS);
        if takes_spirv { vec![Path::Wgsl, Path::NoContraction] } else { vec![Path::Wgsl] }
    }

    /// Prints the adapter and the limits that decide how scenes are cut into windows.
    pub(crate) fn print_limits(&self) {
        println!("{}", self.name());
        let limits = self.device.limits();
        for (name, value) in [
            ("bytes of a storage binding", limits.max_storage_buffer_binding_size),
            ("bytes of a buffer", limits.max_buffer_size),
            ("bytes of a uniform binding", limits.max_uniform_buffer_binding_size),
            ("storage buffers of a stage", limits.max_storage_buffers_per_shader_stage.into()),
            ("alignment of an offset", limits.min_storage_buffer_offset_alignment.into()),
            ("workgroups along an axis", limits.max_compute_workgroups_per_dimension.into()),
            ("invocations of a workgroup", limits.max_compute_invocations_per_workgroup.into()),
            ("bytes of a workgroup", limits.max_compute_workgroup_storage_size.into()),
            ("invocations of a subgroup, least", self.adapter.subgroup_min_size.into()),
            ("invocations of a subgroup, most", self.adapter.subgroup_max_size.into()),
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
        let bytes: Vec<u8> =
            inputs.iter().flatten().flat_map(|x| x.to_bits().to_le_bytes()).collect();
        let count = u32::try_from(inputs.len())?;
        if count % GROUP != 0 {
            return Err(format!("{count} inputs are no multiple of {GROUP}").into());
        }
        let source = text(body);
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = self.module(path, &source)?;
        let storage = wgpu::BufferUsages::STORAGE;
        let inputs = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("inputs"),
            contents: &bytes,
            usage: storage,
        });
        let size = 4 * u64::from(count);
        let outputs = self.buffer("outputs", size, storage | wgpu::BufferUsages::COPY_SRC);
        let read = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let staging = self.buffer("staging", size, read);
        let pipeline = self.pipeline(&module);
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: inputs.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: outputs.as_entire_binding() },
            ],
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(count / GROUP, 1, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&outputs, 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(format!("{body}: {error}").into());
        }
        self.read(&staging)
    }

    /// Returns the floats in a buffer, once what was submitted is done.
    pub(crate) fn read(&self, staging: &wgpu::Buffer) -> Result<Vec<f32>, Error> {
        let slice = staging.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let view = slice.get_mapped_range()?;
        let word = |bytes: &[u8]| f32::from_bits(u32::from_le_bytes(bytes.try_into().unwrap()));
        Ok(view.chunks_exact(4).map(word).collect())
    }

    pub(crate) fn buffer(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let label = Some(label);
        let descriptor = wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false };
        self.device.create_buffer(&descriptor)
    }

    fn module(&self, path: Path, source: &str) -> Result<wgpu::ShaderModule, Error> {
        if path == Path::Wgsl {
            let source = wgpu::ShaderSource::Wgsl(source.into());
            let descriptor = wgpu::ShaderModuleDescriptor { label: None, source };
            return Ok(self.device.create_shader_module(descriptor));
        }
        let words = spirv::without_contraction(source)?;
        let entry = wgpu::PassthroughShaderEntryPoint {
            name: "main".into(),
            workgroup_size: (GROUP, 1, 1),
        };
        // SAFETY: the words are what naga wrote for a module that it validated, with decorations
        // that every SPIR-V consumer knows; indices of buffers are those of the invocation, of which
        // there are as many as inputs and outputs.
        Ok(unsafe {
            self.device.create_shader_module_passthrough(wgpu::ShaderModuleDescriptorPassthrough {
                entry_points: vec![entry].into(),
                spirv: Some(words.into()),
                ..Default::default()
            })
        })
    }

    fn pipeline(&self, module: &wgpu::ShaderModule) -> wgpu::ComputePipeline {
        let entry = |binding, read_only| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[entry(0, true), entry(1, false)],
        });
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            cache: None,
        })
    }
}

/// Returns the module that runs statements on each input.
fn text(body: &str) -> String {
    format!(
        "@group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> outputs: array<f32>;

@compute @workgroup_size({GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let input = inputs[id.x];
    let a = input.x;
    let b = input.y;
    let c = input.z;
    let d = input.w;
    var r = 0.0;
    {body}
    outputs[id.x] = r;
}}
"
    )
}
