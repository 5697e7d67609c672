//! From light in a buffer of a device to a picture on it: nothing is read back.

use raydsl::gpu::GpuWindow;

/// The display transform of [`Display`](raydsl::render::Display), for each pixel of the target.
const SHADER: &str = r"
struct Params { size: vec2<u32>, gain: f32, unused: f32 }
@group(0) @binding(0) var<storage, read> light: array<vec4<f32>>;
@group(0) @binding(1) var<uniform> params: Params;

@vertex
fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn pixel(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    // Row 0 of the light is at the bottom, and that of the picture at the top.
    let row = params.size.y - 1u - u32(at.y);
    let color = light[row * params.size.x + u32(at.x)].rgb * params.gain;
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(1.0));
    let curve = 1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055;
    return vec4<f32>(select(curve, 12.92 * c, c <= vec3<f32>(0.0031308)), 1.0);
}
";

/// Bytes of a pixel's light.
const PIXEL: u64 = 16;

/// A pipeline that shows light, and the buffer that the light is in.
#[derive(Debug)]
pub struct Screen {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipeline: wgpu::RenderPipeline,
    buffer: Option<wgpu::Buffer>,
}

impl Screen {
    /// Creates a screen for pictures of a format.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, format: wgpu::TextureFormat) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("screen"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("screen"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("pixel"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { device: device.clone(), queue: queue.clone(), pipeline, buffer: None }
    }

    /// Returns a window of a buffer for the light of a frame, which is kept for the next one.
    pub fn window(&mut self, (width, height): (u32, u32)) -> GpuWindow {
        let size = u64::from(width) * u64::from(height) * PIXEL;
        let kept = self.buffer.take().filter(|buffer| buffer.size() >= size);
        let buffer = kept.unwrap_or_else(|| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("light"),
                size,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        self.buffer = Some(buffer.clone());
        GpuWindow { buffer, offset: 0, size }
    }

    /// Shows the light of a window in a picture of the same size, `exposure` stops brighter.
    pub fn show(
        &self,
        light: &GpuWindow,
        size: (u32, u32),
        exposure: f32,
        picture: &wgpu::TextureView,
    ) {
        let group = self.bind(light, size, exposure);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("screen"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: picture,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
    }

    fn bind(&self, light: &GpuWindow, size: (u32, u32), exposure: f32) -> wgpu::BindGroup {
        let params = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("size and exposure"),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let words = [size.0, size.1, exposure.exp2().to_bits(), 0];
        self.queue.write_buffer(&params, 0, bytemuck::bytes_of(&words));
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("screen"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: light.buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: params.as_entire_binding() },
            ],
        })
    }
}
