//! Tests of scene buffers: windows, the cache, versions.

use super::kernels::{gather, gathered, hash};
use crate::gpu::{Checks, Context, GpuError};
use crate::machine::wgsl::BufferKey;

/// Elements of 5 MiB.
const LEN: u64 = 5 << 18;
/// Elements of 1 MiB.
const WINDOW: u64 = 1 << 18;
const SIZE: [u32; 2] = [300, 203];
const PIXELS: u32 = SIZE[0] * SIZE[1];

const fn key(version: u32) -> BufferKey {
    BufferKey { id: 7, version, part: 0 }
}

fn scene(len: u64, seed: u32) -> Vec<u32> {
    (0..len as u32).map(|index| hash(index.wrapping_add(seed))).collect()
}

fn run(
    context: &Context,
    module: &crate::machine::wgsl::Module,
    scene: Option<&[u32]>,
) -> Result<Vec<u32>, GpuError> {
    let mut outputs = vec![0u32; PIXELS as usize];
    let bytes = scene.map(bytemuck::cast_slice);
    let out = bytemuck::cast_slice_mut(&mut outputs);
    context.run(module, &|_| bytes.map(Into::into), &[], SIZE, out)?;
    Ok(outputs)
}

#[test]
fn a_large_scene_is_read_through_small_windows() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let context = context.with_max_binding_bytes(1 << 20);
    assert_eq!(context.limits().max_binding_bytes, 1 << 20);
    let scene = scene(LEN, 1);
    let mut module = gather(key(0), LEN, WINDOW, 3);
    assert_eq!(run(&context, &module, Some(&scene))?, gathered(&scene, PIXELS, 3));
    assert_eq!(context.uploaded_bytes(), 5 << 20);

    // Other parameters, the same scene: nothing is compiled or uploaded again.
    module.uniforms = super::kernels::params(99, 0);
    assert_eq!(run(&context, &module, None)?, gathered(&scene, PIXELS, 99));
    assert_eq!(context.uploaded_bytes(), 5 << 20);
    assert_eq!(context.compiled(), 1);
    Ok(())
}

#[test]
fn kernels_with_other_windows_share_the_upload() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let scene = scene(LEN, 2);
    for window in [WINDOW, LEN, 3 << 17] {
        let module = gather(key(0), LEN, window, 0);
        assert_eq!(run(&context, &module, Some(&scene))?, gathered(&scene, PIXELS, 0));
    }
    assert_eq!(context.uploaded_bytes(), 5 << 20);
    assert_eq!(context.compiled(), 3);
    Ok(())
}

#[test]
fn windows_at_odd_offsets_get_buffers_of_their_own() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let scene = scene(1000, 3);
    let module = gather(key(0), 1000, 333, 0);
    assert_eq!(run(&context, &module, Some(&scene))?, gathered(&scene, PIXELS, 0));
    assert_eq!(context.uploaded_bytes(), 4000);
    Ok(())
}

#[test]
fn a_new_version_evicts_the_old_one() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let (old, new) = (scene(1000, 4), scene(1000, 5));
    let first = gather(key(1), 1000, 1000, 0);
    let second = gather(key(2), 1000, 1000, 0);
    assert_eq!(run(&context, &first, Some(&old))?, gathered(&old, PIXELS, 0));
    assert_eq!(run(&context, &second, Some(&new))?, gathered(&new, PIXELS, 0));
    assert_eq!(context.uploaded_bytes(), 8000);
    assert_eq!(run(&context, &second, None)?, gathered(&new, PIXELS, 0));
    // The old version is dropped: its bytes are requested again.
    let missing = run(&context, &first, None);
    assert!(
        matches!(&missing, Err(GpuError::MissingData { key: asked, .. }) if *asked == key(1)),
        "{missing:?}"
    );
    Ok(())
}

#[test]
fn forgotten_scenes_are_uploaded_again() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let scene = scene(1000, 6);
    let module = gather(key(0), 1000, 1000, 0);
    run(&context, &module, Some(&scene))?;
    context.forget(7);
    assert!(matches!(run(&context, &module, None), Err(GpuError::MissingData { .. })));
    run(&context, &module, Some(&scene))?;
    assert_eq!(context.uploaded_bytes(), 8000);
    Ok(())
}

#[test]
fn a_window_without_elements_can_be_bound() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    let mut module = gather(key(0), 1, 1, 5);
    module.buffers[0].len = 0;
    module.buffers[0].windows[0].count = 0;
    assert_eq!(
        run(&context, &module, Some(&[]))?,
        vec![5; PIXELS as usize],
        "the placeholder is zero"
    );
    assert_eq!(context.uploaded_bytes(), 0);
    Ok(())
}

#[test]
fn trusted_shaders_give_the_same_bits() -> Result<(), GpuError> {
    let Some(context) = super::context() else {
        return Ok(());
    };
    // SAFETY: `gather` clamps its index, and `main` returns outside `job.count`.
    let context = unsafe { context.with_checks(Checks::Trusted) };
    let context = context.with_max_binding_bytes(1 << 20);
    let scene = scene(LEN, 8);
    let module = gather(key(0), LEN, WINDOW, 3);
    assert_eq!(run(&context, &module, Some(&scene))?, gathered(&scene, PIXELS, 3));
    Ok(())
}
