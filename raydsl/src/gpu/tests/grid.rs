//! Tests of grids and batches of all shapes, split into dispatches.

use std::time::Instant;

use super::kernels::{grind, ground, hash, spread, spreaded};
use crate::gpu::{Context, GpuError, Timing};
use crate::machine::wgsl::Module;

/// Runs [`spread`] over a grid and checks every element.
fn check_spread(context: &Context, module: &Module, size: [u32; 2]) -> Result<Timing, GpuError> {
    let inputs: Vec<u32> = (0..size[0] * size[1]).map(hash).collect();
    let mut outputs = vec![[0u32; 4]; inputs.len()];
    let timing = context.run(
        module,
        &|_| None,
        bytemuck::cast_slice(&inputs),
        size,
        bytemuck::cast_slice_mut(&mut outputs),
    )?;
    assert!(outputs == spreaded(&inputs, size[0], 7), "{size:?}");
    Ok(timing)
}

#[test]
fn inputs_and_outputs_may_exceed_a_window() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    // 4096 elements of output per dispatch.
    let context = context.with_max_binding_bytes(1 << 16);
    let images = spread([8, 8], 7);
    for size in [[700, 300], [5000, 9], [1, 9000], [4097, 3], [64, 64]] {
        let timing = check_spread(&context, &images, size)?;
        let least = (size[0] * size[1]).div_ceil(4096);
        assert!(timing.dispatches >= least, "{size:?} {timing:?}");
    }
    let batches = spread([64, 1], 7);
    let timing = check_spread(&context, &batches, [300_001, 1])?;
    assert_eq!(timing.dispatches, 300_001u32.div_ceil(4096));
    Ok(())
}

#[test]
fn batches_may_exceed_the_number_of_workgroups() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    // One thread per workgroup: at most 65535 elements in x.
    let module = spread([1, 1], 7);
    let timing = check_spread(&context, &module, [200_000, 1])?;
    assert!(timing.dispatches >= 4, "{timing:?}");
    Ok(())
}

#[test]
fn a_tiny_window_still_makes_progress() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let context = context.with_max_binding_bytes(1);
    assert_eq!(context.limits().max_binding_bytes, 256);
    check_spread(&context, &spread([8, 8], 7), [37, 5])?;
    Ok(())
}

#[test]
fn fast_dispatches_grow_and_slow_ones_shrink() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let size = [512, 512];
    let mut outputs = vec![0u32; 512 * 512];
    let mut run = |rounds| {
        let module = grind(rounds);
        let out = bytemuck::cast_slice_mut(&mut outputs);
        let timing = context.run(&module, &|_| None, &[], size, out)?;
        assert!(outputs == ground(512 * 512, rounds), "{rounds}");
        Ok::<_, GpuError>(timing)
    };
    // The assertion on the goal uses the measured times, so that a busy machine cannot make it
    // fail.
    let told = |timing: &Timing| timing.device_ms.unwrap_or(timing.wall_ms);
    let fast = (0..6).map(|_| run(1)).collect::<Result<Vec<_>, _>>()?;
    let (first, last) = (fast[0], fast[5]);
    assert!(first.dispatches > 1, "{first:?}");
    if fast.iter().all(|timing| told(timing) < 25.0) {
        assert_eq!(last.dispatches, 1, "{first:?}");
    }
    // A kernel is identified by its text, so this one starts with the goal learnt above.
    let slow = run(3000)?;
    if slow.dispatches == 1 && told(&slow) > 100.0 {
        let shorter = run(3000)?;
        assert!(shorter.dispatches > 1, "{slow:?} {shorter:?}");
    }
    Ok(())
}

#[test]
fn times_are_told() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let start = Instant::now();
    let mut outputs = vec![0; 256 * 256 * 4];
    let timing = context.run(&grind(200), &|_| None, &[], [256, 256], &mut outputs)?;
    let elapsed = start.elapsed().as_secs_f64() * 1e3;
    assert!(timing.wall_ms > 0.0 && timing.wall_ms <= elapsed);
    let features = context.device().features();
    assert_eq!(timing.device_ms.is_some(), features.contains(wgpu::Features::TIMESTAMP_QUERY));
    if let Some(device_ms) = timing.device_ms {
        assert!(device_ms > 0.0 && device_ms <= elapsed, "{timing:?}");
    }
    Ok(())
}

#[test]
fn an_empty_grid_returns_at_once() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    for size in [[0, 0], [0, 9], [u32::MAX, 0]] {
        let timing = context.run(&grind(1), &|_| None, &[], size, &mut [])?;
        assert_eq!(timing, Timing::default());
    }
    assert_eq!(context.compiled(), 0);
    Ok(())
}

#[test]
fn threads_may_share_a_context() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let context = context.with_max_binding_bytes(1 << 16);
    let module = spread([8, 8], 7);
    let results: Vec<_> = std::thread::scope(|scope| {
        let (context, module) = (&context, &module);
        let work = |index: u32| move || check_spread(context, module, [100 + index, 200]);
        let threads: Vec<_> = (0..4).map(|index| scope.spawn(work(index))).collect();
        threads.into_iter().map(|thread| thread.join()).collect()
    });
    for result in results {
        result.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    }
    assert_eq!(context.compiled(), 1);
    Ok(())
}
