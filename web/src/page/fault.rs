//! Faults on purpose: a page must say what a device refuses.

use raydsl::gpu::{GpuError, GpuWindow};
use raydsl::machine::wgsl::Module;
use raydsl::prelude::*;

use crate::Fault;

/// A kernel that calls a function that there is not.
const INVALID: &str = "
struct Job { size: vec2<u32>, first: vec2<u32>, count: vec2<u32>, base: u32, pad: u32 }
@group(0) @binding(0) var<uniform> params: vec4<u32>;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) gid: vec3<u32>) {
    outputs[gid.x] = no_such_function(params.x + job.base);
}
";

/// Commits a fault and returns the error that it is told by.
pub(super) async fn commit(fault: Fault, gpu: &GpuScheduler) -> Result<(), GpuError> {
    match fault {
        Fault::Shader => {
            let module = Module {
                source: INVALID.to_owned(),
                arithmetic: Arithmetic::Strict,
                workgroup: [8, 8],
                uniforms: vec![0; 16],
                input_stride: 0,
                output_stride: 4,
                buffers: Vec::new(),
                textures: Vec::new(),
            };
            let mut outputs = [0; 4];
            gpu.context().run_async(&module, &|_| None, &[], [1, 1], &mut outputs).await?;
        }
        // The next picture returns its error.
        Fault::Call => {
            let _ = gpu.context().device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("a buffer to be mapped in both ways"),
                size: 16,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE,
                mapped_at_creation: false,
            });
        }
        // And here too: what is only submitted can tell no error of the device.
        Fault::Window => {
            let (width, height) = (2, 2);
            let size = 16 * u64::from(width * height);
            let buffer = gpu.context().device().create_buffer(&wgpu::BufferDescriptor {
                label: Some("a buffer that is no more"),
                size,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            buffer.destroy();
            let kernel = kernel!(|ray: Ray| vec4(ray.direction.x, ray.direction.y, 0.0, 1.0));
            let camera = Pinhole::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0);
            let window = GpuWindow { buffer, offset: 0, size };
            let _ = gpu.frame_into(&camera, &kernel, (width, height), &window);
        }
    }
    Ok(())
}
