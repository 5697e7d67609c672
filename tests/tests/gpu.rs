//! What belongs to the device: windows, the application's own device, caches.

use raydsl::gpu::{Context, GpuScheduler};
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;
use raydsl_tests::scenes::{random_rays, spheres};
use raydsl_tests::values::compare;

type Error = Box<dyn std::error::Error>;

const RAYS: usize = 20_000;

/// A scheduler of its own, so that nobody else moves its counters.
fn own_scheduler() -> Result<Option<GpuScheduler>, Error> {
    if gpu().is_none() {
        return Ok(None);
    }
    Ok(Some(GpuScheduler::new()?))
}

#[test]
fn windows_give_the_same_bits() -> Result<(), Error> {
    let Some(one_binding) = own_scheduler()? else { return Ok(()) };
    let windowed = GpuScheduler::with_context(Context::new()?.with_max_binding_bytes(1 << 20));
    let points = spheres(250_000);
    assert!(size_of_val(&points[..]) > 3 << 20);
    let bvh = Bvh::build(&points)?;
    assert!(size_of_val(bvh.nodes()) > 3 << 20);
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        Shaded { color: bvh.primitive(hit).rgb(), depth: hit.t, id: hit.prim_id }
    });
    let module = kernel.record().module(&windowed.context().limits());
    let windows: Vec<usize> = module.buffers.iter().map(|b| b.windows.len()).collect();
    assert!(windows.iter().filter(|n| **n > 3).count() >= 2, "{windows:?}");
    let args: Vec<(Ray,)> = random_rays(23, RAYS).into_iter().map(|r| (r,)).collect();
    let mut expected = vec![Shaded::default(); RAYS];
    kernel.run(Variant::widest(), &args, &mut expected);
    for (name, gpu) in [("one binding", &one_binding), ("windows", &windowed)] {
        let mut found = vec![Shaded::default(); RAYS];
        gpu.batch(&kernel, &args, &mut found)?;
        compare(name, &expected, &found).assert_same(|i| format!("{:?}", args[i]));
    }
    Ok(())
}

/// A device as an application might have it.
fn application_device() -> Result<(wgpu::Device, wgpu::Queue), Error> {
    let descriptor = wgpu::InstanceDescriptor::new_without_display_handle().with_env();
    let instance = wgpu::Instance::new(descriptor);
    pollster::block_on(async {
        let adapter = instance.request_adapter(&Default::default()).await?;
        Ok(adapter.request_device(&Default::default()).await?)
    })
}

#[test]
fn the_applications_device_works() -> Result<(), Error> {
    if gpu().is_none() {
        return Ok(());
    }
    let (device, queue) = application_device()?;
    let gpu = GpuScheduler::with_context(Context::from_wgpu(None, device.clone(), queue));
    let points = spheres(500);
    let bvh = Bvh::build(&points)?;
    let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
    let args: Vec<(Ray,)> = random_rays(29, RAYS).into_iter().map(|r| (r,)).collect();
    let mut expected = vec![Hit::miss(); RAYS];
    kernel.run(Variant::Scalar, &args, &mut expected);
    let mut found = vec![Hit::miss(); RAYS];
    gpu.batch(&kernel, &args, &mut found)?;
    compare("own device", &expected, &found).assert_same(|i| format!("{:?}", args[i]));
    drop(gpu);
    // It is still the application's.
    device.poll(wgpu::PollType::Poll)?;
    Ok(())
}

#[test]
fn numbers_compile_nothing_and_trees_are_kept() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let context = gpu.context();
    let points = spheres(500);
    let bvh = Bvh::build(&points)?;
    let args: Vec<(Ray,)> = random_rays(31, 100).into_iter().map(|r| (r,)).collect();
    let run = |background: Vec3, depth: f32, flip: bool| -> Result<Vec<Shaded>, Error> {
        let kernel = kernel!(|ray: Ray| {
            let hit = bvh.closest_hit(ray);
            let color = if hit.is_hit { bvh.primitive(hit).rgb() } else { background };
            let depth = if flip { -hit.t } else { hit.t * depth };
            Shaded { color, depth, id: hit.prim_id }
        });
        let mut expected = vec![Shaded::default(); args.len()];
        kernel.run(Variant::Scalar, &args, &mut expected);
        let mut found = vec![Shaded::default(); args.len()];
        gpu.batch(&kernel, &args, &mut found)?;
        compare("WGSL", &expected, &found).assert_same(|i| format!("{:?}", args[i]));
        Ok(found)
    };
    let first = run(vec3(0.1, 0.2, 0.3), 1.0, false)?;
    let (compiled, uploaded) = (context.compiled(), context.uploaded_bytes());
    assert_eq!(compiled, 1);
    assert!(uploaded as usize >= size_of_val(&points[..]) + bvh.bytes());
    let second = run(vec3(0.5, 0.25, 0.125), 2.0, false)?;
    assert_ne!(first, second);
    assert_eq!(context.compiled(), compiled, "a changed number compiled something");
    assert_eq!(context.uploaded_bytes(), uploaded, "an unchanged tree was sent again");
    // A host condition is part of the text: that these counters can move shows they count.
    run(vec3(0.5, 0.25, 0.125), 2.0, true)?;
    assert_eq!(context.compiled(), compiled + 1);
    assert_eq!(context.uploaded_bytes(), uploaded);
    let other = spheres(400);
    let bvh = Bvh::build(&other)?;
    let kernel = kernel!(|ray: Ray| bvh.any_hit(ray));
    gpu.batch(&kernel, &args, &mut vec![false; args.len()])?;
    assert!(context.uploaded_bytes() > uploaded);
    Ok(())
}

/// A slice is named by its address: after it is gone, other data may lie there.
#[test]
fn slices_are_sent_every_time() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let args: Vec<(Ray,)> = random_rays(37, 2000).into_iter().map(|r| (r,)).collect();
    let mut few = spheres(40);
    for round in 0..3 {
        few.iter_mut().for_each(|s| s.center += vec3(0.5, 0.0, -0.25) * round as f32);
        let kernel = kernel!(|ray: Ray| few.closest_hit(ray));
        let mut expected = vec![Hit::miss(); args.len()];
        kernel.run(Variant::Scalar, &args, &mut expected);
        let mut found = vec![Hit::miss(); args.len()];
        gpu.batch(&kernel, &args, &mut found)?;
        compare("slice", &expected, &found).assert_same(|i| format!("{:?}", args[i]));
    }
    Ok(())
}
