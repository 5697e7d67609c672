//! How finely a device's sampler blends two texels.

use serde::Serialize;

use crate::device::{Device, Error};

/// Positions between the centres of the texels.
const COUNT: u32 = 1 << 16;

const TEXT: &str = "@group(0) @binding(0) var texels: texture_2d<f32>;
@group(0) @binding(1) var linear: sampler;
@group(0) @binding(2) var<storage, read_write> outputs: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let weight = f32(id.x) / 65536.0;
    outputs[id.x] = textureSampleLevel(texels, linear, vec2(0.25 + 0.5 * weight, 0.5), 0.0).x;
}
";

/// A format's filter.
#[derive(Serialize)]
pub(crate) struct Row {
    format: String,
    /// Distinct results between 0 and 1.
    levels: usize,
    /// Greatest error of a weight.
    worst: f32,
}

pub(crate) fn measure(device: &Device) -> Result<Vec<Row>, Error> {
    use wgpu::TextureFormat::{R8Unorm, R16Float, R32Float, Rgba8Unorm};
    let mut formats = vec![(R8Unorm, vec![0, 255]), (Rgba8Unorm, vec![0, 0, 0, 0, 255, 0, 0, 0])];
    formats.push((R16Float, vec![0, 0, 0x00, 0x3c]));
    if device.has(wgpu::Features::FLOAT32_FILTERABLE) {
        formats.push((R32Float, [0f32, 1.0].iter().flat_map(|x| x.to_le_bytes()).collect()));
    }
    formats.into_iter().map(|(format, texels)| of(device, format, &texels)).collect()
}

fn of(device: &Device, format: wgpu::TextureFormat, texels: &[u8]) -> Result<Row, Error> {
    let gpu = device.context.device();
    let size = wgpu::Extent3d { width: 2, height: 1, depth_or_array_layers: 1 };
    let texture = gpu.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let rows = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(texels.len() as u32),
        rows_per_image: None,
    };
    device.context.queue().write_texture(texture.as_image_copy(), texels, rows, size);
    let sampler = gpu.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let bytes = 4 * u64::from(COUNT);
    let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let outputs = device.buffer("outputs", bytes, storage);
    let read = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
    let staging = device.buffer("staging", bytes, read);
    let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(TEXT.into()),
    });
    let pipeline = gpu.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let view = texture.create_view(&Default::default());
    let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            wgpu::BindGroupEntry { binding: 2, resource: outputs.as_entire_binding() },
        ],
    });
    let mut encoder = gpu.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(COUNT / 64, 1, 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&outputs, 0, &staging, 0, bytes);
    device.context.queue().submit([encoder.finish()]);
    let results = device.read(&staging)?;
    let weights = (0..COUNT).map(|i| i as f32 / COUNT as f32);
    let worst = results.iter().zip(weights).map(|(r, w)| (r - w).abs()).fold(0.0, f32::max);
    let mut levels: Vec<u32> = results.iter().map(|r| r.to_bits()).collect();
    levels.sort_unstable();
    levels.dedup();
    Ok(Row { format: format!("{format:?}"), levels: levels.len(), worst })
}

pub(crate) fn print(rows: &[Row]) {
    println!("\n{:<22}{:>16}{:>22}", "linear filter", "distinct weights", "worst error of one");
    for row in rows {
        println!("{:<22}{:>16}{:>22.2e}", row.format, row.levels, row.worst);
    }
}
