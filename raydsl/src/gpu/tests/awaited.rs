//! Tests that awaited calls, the only ones of a browser, give what plain ones give.

use pollster::block_on;

use super::kernels::grind;
use crate::gpu::{Context, GpuError, GpuScheduler, GpuWindow};
use crate::prelude::*;

fn scheduler() -> Option<GpuScheduler> {
    super::context().map(GpuScheduler::with_context)
}

fn camera() -> Pinhole {
    Pinhole::new(vec3(0.0, 0.5, 5.0), Vec3::ZERO, Vec3::Y, 1.0)
}

/// Returns the bytes of a buffer.
fn contents(context: &Context, buffer: &wgpu::Buffer) -> Vec<u8> {
    let device = context.device();
    let staging = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
    context.queue().submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |result| result.expect("it can be mapped"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
    staging.get_mapped_range(..).expect("it is mapped").to_vec()
}

#[test]
fn a_context_can_be_awaited() {
    if super::context().is_none() {
        return;
    }
    let gpu = block_on(GpuScheduler::open()).expect("the adapter gives a second device");
    assert!(!gpu.context().adapter_name().is_empty());
}

#[test]
fn pictures_and_batches_are_the_same() -> Result<(), GpuError> {
    let Some(gpu) = scheduler() else { return Ok(()) };
    let table: Vec<f32> = (0..100).map(|i| i as f32 * 0.25).collect();
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let mut sampler = sampler;
        let place = (sampler.next_1d() * 100.0) as u32;
        vec4(ray.direction.x, ray.direction.y, table[place as usize], 1.0)
    });
    let (mut plain, mut awaited) =
        (Image::filled(70, 50, Vec4::ZERO), Image::filled(70, 50, Vec4::ONE));
    gpu.frame(&camera(), &kernel, &mut plain)?;
    block_on(gpu.frame_async(&camera(), &kernel, &mut awaited))?;
    assert_eq!(plain, awaited);

    // More than one pass.
    let sampling = Sampling::new(100);
    let (mut plain, mut awaited) = (Film::new(40, 30), Film::new(40, 30));
    gpu.accumulate(&camera(), &kernel, &sampling, &mut plain, 100)?;
    block_on(gpu.accumulate_async(&camera(), &kernel, &sampling, &mut awaited, 100))?;
    assert_eq!(awaited.samples(), 100);
    assert_eq!(plain, awaited);

    let inputs: Vec<(f32,)> = (0..1000).map(|i| (i as f32,)).collect();
    let half = kernel!(|x: f32| x * 0.5);
    let (mut plain, mut awaited) = (vec![0.0f32; 1000], vec![1.0f32; 1000]);
    gpu.batch(&half, &inputs, &mut plain)?;
    block_on(gpu.batch_async(&half, &inputs, &mut awaited))?;
    assert_eq!(plain, awaited);
    assert!(plain.iter().any(|x| *x != 0.0));
    Ok(())
}

#[test]
fn a_window_is_filled_by_both() -> Result<(), GpuError> {
    let Some(gpu) = scheduler() else { return Ok(()) };
    let kernel = kernel!(|ray: Ray| vec4(ray.direction.x, ray.direction.y, ray.direction.z, 1.0));
    let mut expected = Image::filled(33, 17, Vec4::ZERO);
    gpu.frame(&camera(), &kernel, &mut expected)?;
    let size = 33 * 17 * 16;
    for is_awaited in [false, true] {
        // How long others took decides how many dispatches there are, and a new context knows none.
        let Some(gpu) = scheduler() else { return Ok(()) };
        let device = gpu.context().device();
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::COPY_SRC;
        let descriptor =
            wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let window = GpuWindow { buffer: device.create_buffer(&descriptor), offset: 0, size };
        let timing = if is_awaited {
            block_on(gpu.frame_into_async(&camera(), &kernel, (33, 17), &window))?
        } else {
            gpu.frame_into(&camera(), &kernel, (33, 17), &window)?
        };
        assert_eq!(timing.dispatches, 1);
        let found = contents(gpu.context(), &window.buffer);
        assert_eq!(found, bytemuck::cast_slice::<Vec4, u8>(expected.pixels()));
    }
    Ok(())
}

/// An answer that comes late frees what may be invalid: the next run uploads and compiles again.
#[test]
fn a_late_error_is_returned_once_and_the_context_goes_on() -> Result<(), GpuError> {
    let Some(context) = super::context() else { return Ok(()) };
    let mut expected = vec![0; 256 * 4];
    context.run(&grind(1), &|_| None, &[], [16, 16], &mut expected)?;
    let (end, answer) = futures_channel::oneshot::channel();
    assert_eq!(context.gpu.answers.now(async { answer.await.ok().flatten() }), None);
    let mut outputs = vec![0; 256 * 4];
    let late = GpuError::PipelineFailed { message: "late".to_owned() };
    end.send(Some(late.clone())).expect("the answer is kept");
    let refused = context.run(&grind(1), &|_| None, &[], [16, 16], &mut outputs);
    assert_eq!(refused, Err(late));
    context.run(&grind(1), &|_| None, &[], [16, 16], &mut outputs)?;
    assert_eq!(outputs, expected);
    assert_eq!(context.compiled(), 2);
    Ok(())
}

/// A call of the application outside every scope, whose error would otherwise come with the next
/// run.
#[test]
fn settling_returns_errors_of_the_application() {
    let Some(context) = super::context() else { return };
    assert_eq!(block_on(context.settle()), Ok(()));
    let _ = context.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 1 << 60,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let told = block_on(context.settle());
    assert!(matches!(told, Err(GpuError::Rejected { .. })), "{told:?}");
    assert_eq!(block_on(context.settle()), Ok(()));
}

/// A future that is dropped leaves no copy of what it borrowed: other data may have the address.
#[test]
fn a_dropped_future_forgets_what_it_borrowed() -> Result<(), GpuError> {
    let Some(gpu) = scheduler() else { return Ok(()) };
    let table = vec![1.0f32; 64];
    let read = kernel!(|i: u32| table[i as usize]);
    let inputs: Vec<(u32,)> = (0..64).map(|i| (i,)).collect();
    let mut outputs = vec![0.0f32; 64];
    drop(gpu.batch_async(&read, &inputs, &mut outputs));
    gpu.batch(&read, &inputs, &mut outputs)?;
    assert_eq!(outputs, table);
    assert_eq!(gpu.context().scene_bytes(), 0);
    Ok(())
}
