//! Tests with the application's own device, queue and buffers.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use super::kernels::{gather, gathered, hash};
use crate::gpu::{Context, GpuError};
use crate::machine::wgsl::BufferKey;

const SIZE: [u32; 2] = [64, 65];
const PIXELS: u32 = SIZE[0] * SIZE[1];
const KEY: BufferKey = BufferKey { id: 1, version: 0, part: 2 };

/// Creates a device like an application's: no features, low limits.
fn own_device() -> Option<(wgpu::Device, wgpu::Queue)> {
    super::context()?;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let made = pollster::block_on(async {
        let adapter = instance.request_adapter(&Default::default()).await.ok()?;
        let descriptor = wgpu::DeviceDescriptor {
            required_limits: wgpu::Limits {
                max_buffer_size: 2 << 20,
                max_storage_buffer_binding_size: 1 << 20,
                max_storage_buffers_per_shader_stage: 7,
                ..Default::default()
            },
            ..Default::default()
        };
        adapter.request_device(&descriptor).await.ok()
    });
    assert!(made.is_some(), "the adapter gave no device");
    made
}

fn scene(len: u32) -> Vec<u32> {
    (0..len).map(hash).collect()
}

fn run(
    context: &Context,
    len: u64,
    window: u64,
    data: Option<&[u32]>,
) -> Result<Vec<u32>, GpuError> {
    let module = gather(KEY, len, window, 1);
    let mut outputs = vec![0u32; PIXELS as usize];
    let bytes = data.map(bytemuck::cast_slice);
    let out = bytemuck::cast_slice_mut(&mut outputs);
    context.run(&module, &|_| bytes.map(Into::into), &[], SIZE, out)?;
    Ok(outputs)
}

#[test]
fn its_device_and_limits_are_used() -> Result<(), GpuError> {
    let Some((device, queue)) = own_device() else {
        return Ok(());
    };
    let context = Context::from_wgpu(None, device, queue);
    assert!(!context.adapter_name().is_empty());
    assert_eq!(context.limits().max_binding_bytes, 1 << 20);
    assert_eq!(context.limits().max_storage_buffers, 7);
    // 5 MiB in buffers of at most 2 MiB.
    let scene = scene(5 << 18);
    assert_eq!(run(&context, 5 << 18, 1 << 18, Some(&scene))?, gathered(&scene, PIXELS, 1));
    assert_eq!(context.uploaded_bytes(), 5 << 20);
    // A seventh window would be the eighth storage buffer.
    let many = run(&context, 7, 1, Some(&scene));
    assert_eq!(many, Err(GpuError::TooManyBuffers { needed: 8, limit: 7 }));
    Ok(())
}

#[test]
fn its_error_callback_hears_nothing() -> Result<(), GpuError> {
    let Some((device, queue)) = own_device() else {
        return Ok(());
    };
    let heard = Arc::new(AtomicU32::new(0));
    let counter = Arc::clone(&heard);
    device.on_uncaptured_error(Arc::new(move |_| {
        counter.fetch_add(1, Ordering::Relaxed);
    }));
    let context = Context::from_wgpu(None, device, queue);
    let mut module = gather(KEY, 8, 8, 1);
    module.source.push_str("fn broken() -> u32 { return 1.5; }");
    let scene = scene(8);
    let bytes: &[u8] = bytemuck::cast_slice(&scene);
    let mut outputs = vec![0; PIXELS as usize * 4];
    let refused = context.run(&module, &|_| Some(bytes.into()), &[], SIZE, &mut outputs);
    assert!(matches!(refused, Err(GpuError::ShaderInvalid { .. })), "{refused:?}");
    assert_eq!(heard.load(Ordering::Relaxed), 0);
    Ok(())
}

#[test]
fn its_buffer_serves_as_a_scene_without_upload() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let scene = scene(1024);
    let buffer = context.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 256 + 4096,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let bytes: &[u8] = bytemuck::cast_slice(&scene);
    context.queue().write_buffer(&buffer, 256, bytes);
    context.with_external(KEY, buffer, 256, 4096)?;
    for window in [1024, 256] {
        let outputs = run(&context, 1024, window, None)?;
        assert_eq!(outputs, gathered(&scene, PIXELS, 1));
    }
    assert_eq!(context.uploaded_bytes(), 0);

    // Windows it cannot offer are refused rather than uploaded behind its back.
    for (len, window) in [(2048, 2048), (1024, 7 * 33)] {
        let refused = run(&context, len, window, Some(&scene));
        assert!(matches!(refused, Err(GpuError::ExternalBuffer { key: KEY, .. })), "{refused:?}");
    }
    Ok(())
}

#[test]
fn its_unusable_buffers_are_refused() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let buffer = |usage| {
        context.device().create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 1024,
            usage,
            mapped_at_creation: false,
        })
    };
    let storage = wgpu::BufferUsages::STORAGE;
    let cases = [
        (wgpu::BufferUsages::COPY_DST, 0, 1024, "STORAGE"),
        (storage, 4, 512, "multiple of"),
        (storage, 0, 0, "positive multiple of 4"),
        (storage, 0, 1028, "past its end"),
        (storage, 512, u64::MAX - 3, "past its end"),
    ];
    for (usage, offset, size, told) in cases {
        match context.with_external(KEY, buffer(usage), offset, size) {
            Err(GpuError::ExternalBuffer { key, reason }) => {
                assert_eq!(key, KEY);
                assert!(reason.contains(told), "{reason}");
            }
            other => panic!("{told}: {other:?}"),
        }
    }
    Ok(())
}
