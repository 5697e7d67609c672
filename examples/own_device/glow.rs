//! What an application does with a picture that is on its device: a glow around what is bright.

use std::error::Error;
use std::sync::mpsc::channel;

/// Edge of a workgroup; the shader has the same.
const GROUP: u32 = 8;

const SHADER: &str = "
@group(0) @binding(0) var<storage, read> light: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> picture: array<u32>;
override WIDTH: u32;
override HEIGHT: u32;

@compute @workgroup_size(8, 8)
fn glow(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= WIDTH || id.y >= HEIGHT {
        return;
    }
    var sum = vec3f();
    var weights = 0.0;
    for (var dy = -24; dy <= 24; dy += 2) {
        for (var dx = -24; dx <= 24; dx += 2) {
            let x = u32(clamp(i32(id.x) + dx, 0, i32(WIDTH) - 1));
            let y = u32(clamp(i32(id.y) + dy, 0, i32(HEIGHT) - 1));
            let weight = exp(-f32(dx * dx + dy * dy) / 130.0);
            sum += max(light[y * WIDTH + x].rgb - 0.6, vec3f()) * weight;
            weights += weight;
        }
    }
    let color = light[id.y * WIDTH + id.x].rgb + sum / weights * 1.2;
    let shown = pow(1.0 - exp(-color), vec3f(1.0 / 2.2));
    // Rays count rows from the bottom, picture files from the top.
    picture[(HEIGHT - 1 - id.y) * WIDTH + id.x] = pack4x8unorm(vec4f(shown, 1.0));
}
";

fn entry(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }
}

/// The shader with its buffers.
pub(crate) struct Glow {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    picture: wgpu::Buffer,
    readback: wgpu::Buffer,
    size: (u32, u32),
}

impl Glow {
    /// For a picture of `size` in `light`.
    pub(crate) fn new(device: &wgpu::Device, light: &wgpu::Buffer, size: (u32, u32)) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("glow"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let constants = [("WIDTH", f64::from(size.0)), ("HEIGHT", f64::from(size.1))];
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("glow"),
            layout: None,
            module: &module,
            entry_point: Some("glow"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            cache: None,
        });
        let buffer = |usage| {
            let size = u64::from(size.0 * size.1) * 4;
            let label = Some("picture");
            device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        use wgpu::BufferUsages as Usage;
        let picture = buffer(Usage::STORAGE | Usage::COPY_SRC);
        let readback = buffer(Usage::MAP_READ | Usage::COPY_DST);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("glow"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[entry(0, light), entry(1, &picture)],
        });
        Self { pipeline, group, picture, readback, size }
    }

    /// Red, green, blue and alpha of each pixel, from the top.
    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(self.size.0.div_ceil(GROUP), self.size.1.div_ceil(GROUP), 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.picture, 0, &self.readback, 0, self.readback.size());
        queue.submit([encoder.finish()]);
        let (report, mapped) = channel();
        self.readback.map_async(wgpu::MapMode::Read, .., move |result| {
            // Whoever asked waits for it below.
            let _ = report.send(result);
        });
        device.poll(wgpu::PollType::wait_indefinitely())?;
        mapped.recv()??;
        Ok(self.readback.get_mapped_range(..)?.to_vec())
    }
}
