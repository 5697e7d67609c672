//! A render pass of wgpu, whose colours and depths come back.

use std::sync::mpsc::channel;

use raydsl::gpu::Context;
use raydsl::prelude::*;
use raydsl::render::Fragment;

use super::{Corner, RasterizerError};

const SHADER: &str = "
struct Seen {
    @builtin(position) place: vec4f,
    @location(0) color: vec3f,
}

@group(0) @binding(0) var<uniform> clip: mat4x4f;

@vertex
fn corner(@location(0) place: vec3f, @location(1) color: vec3f) -> Seen {
    return Seen(clip * vec4f(place, 1.0), color);
}

@fragment
fn pixel(seen: Seen) -> @location(0) vec4f {
    return vec4f(seen.color, 1.0);
}
";

/// Bytes of a corner in the buffer: six floats.
const CORNER: u64 = 24;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

fn bytes(floats: impl IntoIterator<Item = f32>) -> Vec<u8> {
    floats.into_iter().flat_map(f32::to_le_bytes).collect()
}

fn refused(error: impl ToString) -> RasterizerError {
    RasterizerError::Refused { reason: error.to_string() }
}

/// Draws into `image`, which has pixels; there are triangles.
pub(super) fn draw(
    context: &Context,
    triangles: &[[Corner; 3]],
    clip: Mat4,
    image: &mut Image<Fragment>,
) -> Result<(), RasterizerError> {
    let device = context.device();
    let (width, height) = (image.width(), image.height());
    let limit = device.limits().max_texture_dimension_2d;
    if width.max(height) > limit {
        return Err(RasterizerError::TooLarge { width, height, limit });
    }
    // What the device refuses would else be told to nobody, or end the program.
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let [color, depth] = pass(context, triangles, clip, (width, height));
    let caught = [pollster::block_on(memory.pop()), pollster::block_on(validation.pop())];
    if let Some(error) = caught.into_iter().flatten().next() {
        return Err(refused(error));
    }
    let (color, depth) = (color.read(device)?, depth.read(device)?);
    // A device has the first row at the top, rays have it at the bottom.
    for (row, pixels) in image.pixels_mut().chunks_mut(width as usize).rev().enumerate() {
        let (color, depth) = (&color[row], &depth[row]);
        for (x, pixel) in pixels.iter_mut().enumerate() {
            *pixel = Fragment { color: Vec4::from_slice(&color[4 * x..]), depth: depth[x] };
        }
    }
    Ok(())
}

/// Submits the pass, and the copies of its colours and depths.
fn pass(
    context: &Context,
    triangles: &[[Corner; 3]],
    clip: Mat4,
    size: (u32, u32),
) -> [Readback; 2] {
    let (device, queue) = (context.device(), context.queue());
    let filled = |contents: &[u8], usage| {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rasterizer"),
            size: contents.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&buffer, 0, contents);
        buffer
    };
    let floats = |c: &Corner| [c.place.to_array(), c.color.to_array()];
    let corners = bytes(triangles.as_flattened().iter().flat_map(floats).flatten());
    let corners = filled(&corners, wgpu::BufferUsages::VERTEX);
    let matrix = filled(&bytes(clip.to_cols_array()), wgpu::BufferUsages::UNIFORM);
    let pipeline = pipeline(device);
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("rasterizer"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() }],
    });
    let [color, depth] = [COLOR, DEPTH].map(|format| target(device, format, size));
    let [color_view, depth_view] = [&color, &depth].map(|t| t.create_view(&Default::default()));

    let mut encoder = device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("rasterizer"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &color_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth_view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.set_vertex_buffer(0, corners.slice(..));
    pass.draw(0..(corners.size() / CORNER) as u32, 0..1);
    drop(pass);
    let back = [(&color, 16), (&depth, 4)].map(|(t, texel)| Readback::of(device, t, texel));
    for (texture, readback) in [&color, &depth].into_iter().zip(&back) {
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &readback.buffer, layout: readback.layout() },
            texture.size(),
        );
    }
    queue.submit([encoder.finish()]);
    back
}

fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("rasterizer"),
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("rasterizer"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: CORNER,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
            })],
        },
        // Triangles are seen from both sides.
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("pixel"),
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn target(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    (width, height): (u32, u32),
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("rasterizer"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// A buffer for a texture of floats.
struct Readback {
    buffer: wgpu::Buffer,
    /// Bytes of a row, and from one to the next.
    row: u32,
    stride: u32,
}

impl Readback {
    /// For the pixels of `texture`, of `texel` bytes each.
    fn of(device: &wgpu::Device, texture: &wgpu::Texture, texel: u32) -> Self {
        let row = texture.width() * texel;
        let stride = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("rasterizer"),
            size: u64::from(stride) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { buffer, row, stride }
    }

    fn layout(&self) -> wgpu::TexelCopyBufferLayout {
        wgpu::TexelCopyBufferLayout { bytes_per_row: Some(self.stride), ..Default::default() }
    }

    /// The floats of each row, from the top.
    fn read(&self, device: &wgpu::Device) -> Result<Vec<Vec<f32>>, RasterizerError> {
        let (report, mapped) = channel();
        self.buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // Whoever asked waits for it below.
            let _ = report.send(result);
        });
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(refused)?;
        mapped.recv().map_err(refused)?.map_err(refused)?;
        let bytes = self.buffer.get_mapped_range(..).map_err(refused)?;
        let floats = |row: &[u8]| {
            let (floats, _) = row[..self.row as usize].as_chunks::<4>();
            floats.iter().map(|b| f32::from_le_bytes(*b)).collect()
        };
        Ok(bytes.chunks(self.stride as usize).map(floats).collect())
    }
}
