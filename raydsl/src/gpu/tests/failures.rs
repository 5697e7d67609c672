//! Tests that every failure is an error: no panic, no hang.

use std::time::Duration;

use super::kernels::{gather, grind, spread};
use crate::gpu::device::typed;
use crate::gpu::{Context, GpuError};
use crate::machine::wgsl::{BufferKey, Module};

const KEY: BufferKey = BufferKey { id: 3, version: 1, part: 0 };

/// Runs a module with `scene` zero bytes of data over 16 x 16 pixels.
fn run(context: &Context, module: &Module, scene: usize) -> Result<(), GpuError> {
    let data = vec![0; scene];
    let mut outputs = vec![0; 256 * module.output_stride as usize];
    let inputs = vec![0; 256 * module.input_stride as usize];
    context.run(module, &|_| Some(data[..].into()), &inputs, [16, 16], &mut outputs)?;
    Ok(())
}

#[test]
fn broken_wgsl_is_quoted() {
    let Some(context) = super::context() else {
        return;
    };
    let mut module = grind(1);
    module.source = module.source.replace("hash(value)", "hsah(value)");
    match run(&context, &module, 0) {
        Err(error @ GpuError::ShaderInvalid { .. }) => {
            let text = error.to_string();
            assert!(text.contains("value = hsah(value);"), "{text}");
            assert!(text.contains("no definition in scope for identifier: `hsah`"), "{text}");
            assert!(!text.contains('\n'), "{text}");
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(context.compiled(), 0);
    // The context still works.
    assert_eq!(run(&context, &grind(1), 0), Ok(()));
}

#[test]
fn wgsl_that_parses_but_does_not_validate_is_quoted() {
    let Some(context) = super::context() else {
        return;
    };
    let mut module = grind(1);
    module.source += "\nfn wrong() -> u32 {\n    return 1.5f;\n}\n";
    match run(&context, &module, 0) {
        Err(GpuError::ShaderInvalid { line, text, message }) => {
            assert!(line > 0, "{message}");
            assert!(text.contains("1.5f") || text.contains("wrong"), "{text}");
            assert!(!message.contains('\n'), "{message}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_module_that_breaks_the_interface_makes_no_pipeline() {
    let Some(context) = super::context() else {
        return;
    };
    let mut module = grind(1);
    module.source = module.source.replace("fn main", "fn mian");
    let refused = run(&context, &module, 0);
    assert!(matches!(refused, Err(GpuError::PipelineFailed { .. })), "{refused:?}");
    module = grind(1);
    module.source = module.source.replace("@workgroup_size(8, 8)", "@workgroup_size(8, 8000)");
    let refused = run(&context, &module, 0);
    assert!(matches!(refused, Err(GpuError::PipelineFailed { .. })), "{refused:?}");
    // What the layout has elsewhere, or not at all; wgpu does not see it where it passes SPIR-V on.
    for (ours, other) in [
        ("@group(0) @binding(3)", "@group(0) @binding(2)"),
        ("@group(0) @binding(3)", "@group(1) @binding(3)"),
        ("@binding(0) var<uniform>", "@binding(0) var<storage, read>"),
        (
            "outputs: array<u32>;",
            "outputs: array<u32>;\nvar<workgroup> large: array<u32, 1048576>;",
        ),
    ] {
        module = grind(1);
        assert!(module.source.contains(ours), "{}", module.source);
        module.source = module.source.replace(ours, other);
        if other.contains("large") {
            module.source = module
                .source
                .replace("var value = linear;", "var value = linear; large[value] = 1u;");
        }
        let refused = run(&context, &module, 0);
        assert!(matches!(refused, Err(GpuError::PipelineFailed { .. })), "{other}: {refused:?}");
    }
    module = grind(1);
    module.output_stride = 6;
    let refused = run(&context, &module, 0);
    assert!(matches!(refused, Err(GpuError::BadModule { .. })), "{refused:?}");
}

#[test]
fn scene_buffers_are_checked() {
    let Some(context) = super::context() else {
        return;
    };
    let context = context.with_max_binding_bytes(1024);
    assert_eq!(
        run(&context, &gather(KEY, 512, 512, 0), 2048),
        Err(GpuError::BindingTooLarge { name: "scene".to_owned(), bytes: 2048, limit: 1024 })
    );
    assert_eq!(
        run(&context, &gather(KEY, 512, 256, 0), 2044),
        Err(GpuError::WrongLength {
            what: "the scene buffer scene".to_owned(),
            bytes: 2044,
            needed: 2048
        })
    );
    let mut module = gather(KEY, 512, 256, 0);
    module.buffers[0].windows[1].count = u64::MAX;
    let refused = run(&context, &module, 2048);
    assert!(matches!(refused, Err(GpuError::BadModule { .. })), "{refused:?}");
}

#[test]
fn too_many_buffers_are_counted() {
    let Some(context) = super::context() else {
        return;
    };
    let limit = context.limits().max_storage_buffers;
    if limit > 1000 {
        return; // A module of a million bindings says nothing more.
    }
    let module = gather(KEY, u64::from(limit), 1, 0);
    let needed = u64::from(limit) + 1;
    assert_eq!(
        run(&context, &module, 4 * limit as usize),
        Err(GpuError::TooManyBuffers { needed, limit })
    );
    let module = gather(KEY, u64::from(limit) - 1, 1, 0);
    assert_eq!(run(&context, &module, 4 * limit as usize), Ok(()));
}

#[test]
fn grids_and_slices_are_checked() {
    let Some(context) = super::context() else {
        return;
    };
    let size = [1 << 16, 1 << 16];
    let refused = context.run(&grind(1), &|_| None, &[], size, &mut []);
    assert_eq!(refused, Err(GpuError::GridTooLarge { size }));
    let refused = context.run(&grind(1), &|_| None, &[], [4, 4], &mut [0; 60]);
    assert!(
        matches!(refused, Err(GpuError::WrongLength { bytes: 60, needed: 64, .. })),
        "{refused:?}"
    );
    let module = spread([8, 8], 1);
    let refused = context.run(&module, &|_| None, &[0; 3], [1, 1], &mut [0; 16]);
    assert!(matches!(refused, Err(GpuError::WrongLength { .. })), "{refused:?}");
}

#[test]
fn a_slow_device_times_out() {
    let Some(context) = super::context() else {
        return;
    };
    let context = context.with_timeout(Duration::ZERO);
    let refused = run(&context, &grind(1_000_000), 0);
    assert_eq!(refused, Err(GpuError::Timeout { seconds: 0.0 }));
}

#[test]
fn a_lost_device_is_an_error() {
    let Some(context) = super::context() else {
        return;
    };
    lose(&context);
}

#[test]
fn a_lost_device_of_the_application_is_an_error() {
    let Some(context) = super::context() else {
        return;
    };
    let (device, queue) = (context.device().clone(), context.queue().clone());
    // Like an application's device: its callback reports to that other context only.
    lose(&Context::from_wgpu(None, device, queue));
}

fn lose(context: &Context) {
    assert_eq!(run(context, &grind(1), 0), Ok(()));
    context.device().destroy();
    for _ in 0..2 {
        let refused = run(context, &grind(1), 0);
        assert!(matches!(refused, Err(GpuError::DeviceLost { .. })), "{refused:?}");
        let refused = run(context, &gather(KEY, 512, 256, 0), 2048);
        assert!(matches!(refused, Err(GpuError::DeviceLost { .. })), "{refused:?}");
    }
}

#[test]
fn stray_errors_reach_the_next_run() {
    let Some(context) = super::context() else {
        return;
    };
    // Outside every scope, where wgpu's default would panic.
    let _ = context.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 1 << 60,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let refused = run(&context, &grind(1), 0);
    assert!(matches!(refused, Err(GpuError::Rejected { .. })), "{refused:?}");
    assert_eq!(run(&context, &grind(1), 0), Ok(()));
}

#[test]
fn missing_memory_is_named() {
    let error = wgpu::Error::OutOfMemory { source: Box::new(std::fmt::Error) };
    let what = "scene (5 bytes)".to_owned();
    assert_eq!(typed(error, "scene (5 bytes)"), GpuError::OutOfMemory { what });
}

#[test]
fn every_message_is_one_line() {
    let errors = [
        GpuError::NoAdapter { reason: "none".to_owned() },
        GpuError::BufferTooLarge { name: "nodes".to_owned(), bytes: 2, limit: 1 },
        GpuError::OutOfMemory { what: "nodes".to_owned() },
        GpuError::Timeout { seconds: 1.0 },
        GpuError::GridTooLarge { size: [9, 9] },
    ];
    for error in errors {
        assert!(!error.to_string().contains('\n'), "{error}");
    }
    let no_adapter = GpuError::NoAdapter { reason: String::new() };
    let text = no_adapter.to_string();
    assert!(
        text.contains("install a Vulkan driver, on Debian mesa-vulkan-drivers and libvulkan1"),
        "{text}"
    );
}
