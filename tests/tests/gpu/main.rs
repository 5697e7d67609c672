//! What belongs to the device: windows, the application's own device, caches.

mod buffers;
mod layout;

use raydsl::gpu::{Context, GpuScheduler};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;
use raydsl_tests::rng::Rng;
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
        let descriptor = wgpu::DeviceDescriptor {
            required_features: adapter.features() & wgpu::Features::PASSTHROUGH_SHADERS,
            // SAFETY: nothing here makes a shader that wgpu does not look at; the library does.
            experimental_features: unsafe { wgpu::ExperimentalFeatures::enabled() },
            ..Default::default()
        };
        Ok(adapter.request_device(&descriptor).await?)
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

/// A frame in a buffer of the application has the bits of one that comes back, in tiles as well.
#[test]
fn frames_stay_on_the_device() -> Result<(), Error> {
    use raydsl::gpu::{GpuError, GpuWindow, WindowError};
    use wgpu::BufferUsages as Usage;
    if gpu().is_none() {
        return Ok(());
    }
    let (device, queue) = application_device()?;
    let context = Context::from_wgpu(None, device.clone(), queue.clone());
    let gpu = GpuScheduler::with_context(context.with_max_binding_bytes(4096));
    let camera = Pinhole::new(vec3(1.0, 2.0, 9.0), vec3(0.0, 0.0, 0.0), Vec3::Y, 0.9);
    let kernel = kernel!(|ray: Ray, pixel: UVec2| {
        Shaded { color: ray.direction, depth: ray.direction.y, id: pixel.x + pixel.y }
    });
    let (width, height) = (67u32, 35u32);
    let mut expected = Image::new(width, height);
    gpu.frame(&camera, &kernel, &mut expected)?;
    let size = u64::from(width * height) * size_of::<Shaded>() as u64;
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: size + 512,
            usage,
            mapped_at_creation: false,
        })
    };
    let usage = Usage::STORAGE | Usage::COPY_DST | Usage::COPY_SRC;
    let window = GpuWindow { buffer: buffer(usage), offset: 256, size };
    let timing = gpu.frame_into(&camera, &kernel, (width, height), &window)?;
    assert!(timing.dispatches > 1, "{timing:?}");
    // What the application submits afterwards finds it there.
    let readback = buffer(Usage::MAP_READ | Usage::COPY_DST);
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(&window.buffer, 0, &readback, 0, size + 512);
    queue.submit([encoder.finish()]);
    readback.map_async(wgpu::MapMode::Read, .., |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let bytes = readback.get_mapped_range(..)?.to_vec();
    let (before, rest) = bytes.split_at(256);
    let (frame, after) = rest.split_at(size as usize);
    assert!(before.iter().chain(after).all(|b| *b == 0), "only the window is written to");
    let words = frame.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let expected = expected.pixels().iter().flat_map(|p| {
        let [r, g, b] = p.color.to_array().map(f32::to_bits);
        [r, g, b, p.depth.to_bits(), p.id]
    });
    assert!(words.eq(expected));

    let refused = |window: GpuWindow| match gpu.frame_into(&camera, &kernel, (67, 35), &window) {
        Err(GpuError::Window { problem, .. }) => Some(problem),
        _ => None,
    };
    let read_only = GpuWindow { buffer: buffer(Usage::STORAGE), ..window.clone() };
    assert_eq!(refused(read_only), Some(WindowError::NotCopyDst));
    let odd = GpuWindow { offset: 4, ..window.clone() };
    assert!(matches!(refused(odd), Some(WindowError::Unaligned { offset: 4, .. })));
    let small = GpuWindow { size: size - 20, ..window.clone() };
    assert!(matches!(refused(small), Some(WindowError::WrongSize { len: 2345, .. })));
    let late = GpuWindow { offset: 768, ..window };
    assert!(matches!(refused(late), Some(WindowError::PastEnd { .. })));
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
/// A picture by a device that knows no kernel yet.
fn picture(
    gpu: &GpuScheduler,
    kernel: &Kernel<'_, (Ray, Sampler), Vec4>,
    camera: &Pinhole,
    sampling: &Sampling,
) -> Result<Image<Vec4>, Error> {
    let mut film = Film::new(24, 16);
    gpu.accumulate(camera, kernel, sampling, &mut film, 2)?;
    gpu.accumulate(camera, kernel, sampling, &mut film, 2)?;
    Ok(film.image())
}

#[derive(Clone, Copy, Type)]
enum Coat {
    Bare(f32),
    Paint(f32, u32),
    Glow { light: f32 },
}

#[kernel]
fn shine(coat: Coat) -> f32 {
    match coat {
        Coat::Paint(x, n) => x * n as f32,
        Coat::Bare(x) => -x,
        Coat::Glow { light } => light + 0.5,
    }
}

#[test]
fn the_kinds_of_the_data_are_part_of_the_program() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let context = gpu.context();
    let inputs: Vec<(u32,)> = (0..4).map(|i| (i,)).collect();
    // One list, whose place and length stay.
    let mut list = [Coat::Bare(1.0); 4];
    let mut run = |i: usize, coat: Coat, counts: (u64, u64)| -> Result<(), Error> {
        list[i] = coat;
        let coats = &list[..];
        let kernel = kernel!(|i: u32| shine(coats[i as usize]));
        let mut found = [0.0; 4];
        gpu.batch(&kernel, &inputs, &mut found)?;
        assert_eq!(found, list.map(shine));
        assert_eq!((context.recorded(), context.printed()), counts, "{found:?}");
        Ok(())
    };
    run(0, Coat::Bare(2.0), (1, 1))?;
    run(1, Coat::Bare(3.0), (1, 1))?;
    run(2, Coat::Paint(0.5, 3), (2, 2))?;
    run(3, Coat::Glow { light: 1.0 }, (3, 3))?;
    run(3, Coat::Paint(2.0, 3), (3, 3))?;
    run(2, Coat::Bare(7.0), (3, 3))?;
    run(3, Coat::Bare(8.0), (3, 3))?;
    Ok(())
}

#[test]
fn a_kernel_is_recorded_once_and_a_program_printed_once() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let points = spheres(300);
    let bvh = Bvh::build(&points)?;
    let context = gpu.context();
    let counts = || (context.recorded(), context.printed(), context.compiled());
    let from = |x: f32| Pinhole::new(vec3(x, 0.0, 3.0), Vec3::ZERO, Vec3::Y, 1.0);
    // Its number has the name, and in one picture the value, of one that passes capture themselves.
    let seed = 7u32;
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let hit = bvh.closest_hit(ray);
        let mut sampler = Sampler { method: SampleMethod::Random, ..sampler };
        let noise = sampler.next_1d();
        if hit.is_hit { vec4(hit.t, noise, seed as f32, 1.0) } else { Vec4::ZERO }
    });
    let expected = |camera: &Pinhole, sampling: &Sampling| {
        picture(&GpuScheduler::with_context(Context::new()?), &kernel, camera, sampling)
    };
    let jittered = |seed| Sampling::new(4).seed(seed).pixels(PixelSampler::Jittered);
    let sampling = jittered(7);
    let same = |name: &str, expected: &Image<Vec4>, found: &Image<Vec4>| {
        compare(name, expected.pixels(), found.pixels()).assert_same(|i| format!("pixel {i}"));
    };
    let found = picture(&gpu, &kernel, &from(0.0), &sampling)?;
    same("first", &expected(&from(0.0), &sampling)?, &found);
    assert_eq!(counts(), (1, 1, 1), "two passes of a kernel");
    // What the frame captures is another number; what the kernel captured stays.
    for (camera, sampling) in
        [(from(1.0), sampling), (from(1.0), jittered(8)), (from(0.0), sampling)]
    {
        let found = picture(&gpu, &kernel, &camera, &sampling)?;
        same("another frame", &expected(&camera, &sampling)?, &found);
    }
    assert_eq!(counts(), (1, 1, 1), "another camera and another seed");
    // A value of the host in the frame is another program.
    let random = jittered(7).method(SampleMethod::Random);
    let found = picture(&gpu, &kernel, &from(0.0), &random)?;
    same("random", &expected(&from(0.0), &random)?, &found);
    assert_eq!(counts(), (2, 2, 2), "another method");
    let found = picture(&gpu, &kernel, &from(1.0), &sampling)?;
    same("the method before", &expected(&from(1.0), &sampling)?, &found);
    assert_eq!(counts(), (2, 2, 2), "a method that was used before");
    // The same closure with another number is another kernel with the same recording.
    for number in 0..200u32 {
        let made = kernel!(|ray: Ray| vec4(ray.direction.x, 0.0, number as f32, 1.0));
        let mut image = Image::filled(8, 8, Vec4::ZERO);
        gpu.frame(&from(0.0), &made, &mut image)?;
        assert!(image.pixels().iter().all(|p| p.z == number as f32), "{number}");
    }
    assert_eq!(counts(), (3, 3, 3), "many kernels of one closure");
    // More programs than are kept.
    for number in 0..70u32 {
        let made = kernel!(|ray: Ray| vec4(ray.direction.x, 0.0, (host(number) + 1) as f32, 1.0));
        let mut image = Image::filled(8, 8, Vec4::ZERO);
        gpu.frame(&from(0.0), &made, &mut image)?;
        assert!(image.pixels().iter().all(|p| p.z == (number + 1) as f32), "{number}");
    }
    assert_eq!(counts(), (73, 73, 73), "many programs");
    let found = picture(&gpu, &kernel, &from(0.0), &sampling)?;
    same("one that was forgotten", &expected(&from(0.0), &sampling)?, &found);
    assert_eq!(counts(), (74, 74, 73), "a kernel that was forgotten");
    // A batch is a program of its own.
    let double = kernel!(|x: f32| x * 2.0);
    let mut doubled = [0.0; 3];
    for _ in 0..2 {
        gpu.batch(&double, &[(1.0,), (2.0,), (3.0,)], &mut doubled)?;
    }
    assert_eq!(doubled, [2.0, 4.0, 6.0]);
    assert_eq!(counts(), (75, 75, 74), "a batch");
    Ok(())
}

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

/// A tree for each time step, the active one switched by reference.
#[test]
fn steps_of_time_are_sent_once_and_compile_nothing() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let context = gpu.context();
    let steps = [200, 300, 250].map(spheres);
    let trees = [Bvh::build(&steps[0])?, Bvh::build(&steps[1])?, Bvh::build(&steps[2])?];
    let args: Vec<(Ray,)> = random_rays(41, 2000).into_iter().map(|r| (r,)).collect();
    let mut uploaded = Vec::new();
    for step in [0, 1, 2, 1, 0, 2] {
        let active = &trees[step];
        let kernel = kernel!(|ray: Ray| active.closest_hit(ray));
        let mut expected = vec![Hit::miss(); args.len()];
        kernel.run(Variant::Scalar, &args, &mut expected);
        let mut found = vec![Hit::miss(); args.len()];
        gpu.batch(&kernel, &args, &mut found)?;
        compare("a step", &expected, &found).assert_same(|i| format!("{:?}", args[i]));
        uploaded.push(context.uploaded_bytes());
    }
    assert_eq!(context.compiled(), 1, "another tree compiled something");
    assert!(uploaded[0] < uploaded[1] && uploaded[1] < uploaded[2]);
    assert!(uploaded[3..].iter().all(|bytes| *bytes == uploaded[2]), "a tree was sent again");
    Ok(())
}

#[test]
fn instances_that_move_send_no_primitives() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let windowed = GpuScheduler::with_context(Context::new()?.with_max_binding_bytes(1 << 17));
    let context = gpu.context();
    let points = spheres(20_000);
    let trees = [Bvh::build(&points)?];
    let at = |x: f32| Instance::new(0, Affine3::from_translation(vec3(x, 0.0, 0.0)));
    let mut scene = Instances::new(&trees)?;
    let group = scene.group(&[at(0.0), at(2.0)])?;
    let args: Vec<(Ray,)> = random_rays(43, 2000).into_iter().map(|r| (r,)).collect();
    let mut sent = Vec::new();
    for frame in 0..4 {
        scene.set_group(group, &[at(0.0), at(2.0 - 0.3 * frame as f32)])?;
        let kernel = kernel!(|ray: Ray| scene.closest_hit(ray));
        let mut expected = vec![Hit::miss(); args.len()];
        kernel.run(Variant::Scalar, &args, &mut expected);
        for gpu in [&gpu, &windowed] {
            let mut found = vec![Hit::miss(); args.len()];
            gpu.batch(&kernel, &args, &mut found)?;
            compare("a frame", &expected, &found).assert_same(|i| format!("{:?}", args[i]));
        }
        sent.push(context.uploaded_bytes());
    }
    let prims = size_of_val(&points[..]) as u64;
    let tree = (trees[0].bytes() + scene.bytes()) as u64;
    assert!(sent[0] >= prims + trees[0].bytes() as u64);
    for pair in sent.windows(2) {
        assert!(pair[1] - pair[0] <= tree, "{} bytes of {prims} + {tree}", pair[1] - pair[0]);
    }
    assert_eq!(context.compiled(), 1, "another transform compiled something");
    Ok(())
}

/// Numbers of many sizes, sums that cancel, and what has no rounding; no denormals, which a device may
/// take for 0, and none among products and quotients.
fn hard_numbers() -> Vec<(f32, f32, f32)> {
    let mut rng = Rng::of("hard numbers");
    let specials = [0.0, -0.0, 1.0, 3.0, f32::INFINITY];
    let mut number = move || match rng.below(8) {
        0 => specials[rng.below(specials.len())],
        1..4 => rng.range(-2.0, 2.0),
        _ => {
            let bits = rng.bits() as u32;
            let exponent = 97 + (bits >> 23) % 61;
            f32::from_bits(bits & 0x807f_ffff | exponent << 23)
        }
    };
    let inputs = (0..RAYS).map(|i| {
        let (a, b) = (number(), number());
        (a, b, if i % 2 == 0 { -(a * b) } else { number() })
    });
    inputs.collect()
}

/// A driver that may fuse operations promises nothing, and its results are near all the same.
#[test]
fn devices_whose_operations_are_fused_are_not_exact() -> Result<(), Error> {
    if gpu().is_none() {
        return Ok(());
    }
    let fused = GpuScheduler::with_context(Context::new()?.with_operations_fused());
    assert!(!fused.context().is_exact());
    let kernel = kernel!(|a: f32, b: f32, c: f32| a * b + c);
    let inputs = [(2.0, 3.0, 1.0), (0.1, 0.2, 0.3)];
    let mut found = [0.0; 2];
    fused.batch(&kernel, &inputs, &mut found)?;
    assert_eq!(found[0], 7.0);
    assert!((found[1] - 0.32).abs() <= 1e-7, "{}", found[1]);
    Ok(())
}

#[test]
fn exact_devices_round_as_the_host() -> Result<(), Error> {
    let Some(gpu) = gpu() else { return Ok(()) };
    if !gpu.context().is_exact() {
        eprintln!("LEFT OUT: {} is not exact", gpu.context().adapter_name());
        return Ok(());
    }
    let kernel = kernel!(|a: f32, b: f32, c: f32| {
        let lengths = vec3(a, b, c) / vec3(b, c, a).abs().sqrt();
        ((a * b + c, a * b - b * c, (a + b) - a), (a / b, a.abs().sqrt(), a * 3.0 * 0.1), lengths)
    });
    let inputs = hard_numbers();
    let mut expected = vec![Default::default(); inputs.len()];
    kernel.run(Variant::Scalar, &inputs, &mut expected);
    let mut found = expected.clone();
    gpu.batch(&kernel, &inputs, &mut found)?;
    compare("exact", &expected, &found).assert_same(|i| format!("{:?}", inputs[i]));
    Ok(())
}
