//! Slices that the application owns, read by kernels in every variant.

#![allow(clippy::needless_range_loop, reason = "what kernels are written in")]

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::check::{every_variant, inputs};
use raydsl_tests::kernels::{Matter, Surface};
use raydsl_tests::rng::Rng;
use raydsl_tests::values::{Numbers, random};

#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Ball {
    center: Vec3,
    radius: f32,
    id: u32,
}

#[test]
fn numbers() {
    let weights: Vec<f32> = (0..37).map(|i| (i as f32 * 0.7).fract()).collect();
    let kernel = kernel!(|x: f32, n: u32| {
        let mut sum = weights[n as usize % weights.len()];
        for i in 0..weights.len() {
            if weights[i] > 0.8 {
                continue;
            }
            sum += weights[i] * x;
        }
        sum
    });
    every_variant(&kernel, &inputs(1));
}

#[kernel]
fn nearest(balls: &[Ball], at: Vec3, limit: u32) -> u32 {
    let mut best = 1e30;
    let mut id = 0xffff_ffffu32;
    for i in 0..balls.len() {
        let ball = balls[i];
        if ball.id > limit {
            continue;
        }
        let d = (ball.center - at).length() - ball.radius;
        if d < best {
            best = d;
            id = ball.id;
        }
    }
    id
}

#[test]
fn structs_by_reference() {
    let mut rng = Rng::new(3);
    let mut number = || random::<f32>(&mut rng, Numbers::Tame);
    let balls: Vec<Ball> = (0..23)
        .map(|i| Ball {
            center: vec3(number(), number(), number()),
            radius: number().abs(),
            id: i * 2,
        })
        .collect();
    let kernel = kernel!(|x: f32, y: f32, n: u32| nearest(&balls, vec3(x, y, 0.5), n));
    every_variant(&kernel, &inputs(2));
    let none: &[Ball] = &[];
    let kernel = kernel!(|x: f32, n: u32| nearest(none, vec3(x, x, x), n));
    every_variant(&kernel, &inputs(2));
}

#[test]
fn many_types() {
    let points: Vec<Vec3> = (0..9).map(|i| vec3(i as f32, 0.5, -1.0)).collect();
    let pairs: Vec<(i32, f32)> = (0..5).map(|i| (3 - i, i as f32)).collect();
    let matters = [Matter::Glass, Matter::Matte, Matter::Mirror];
    let surfaces: Vec<Surface> =
        (0..4).map(|i| Surface { roughness: i as f32, matter: matters[i % 3] }).collect();
    let (matters, flags) = (&matters[..], &[true, false, true][..]);
    let kernel = kernel!(|x: f32, n: u32| {
        let p = points[n as usize % points.len()];
        let (i, f) = pairs[n as usize % 5];
        let matter = matters[n as usize % matters.len()];
        let mut sum = p.x * x + f + i as f32 + matters[1].albedo();
        if matter == Matter::Glass || flags[n as usize % 3] {
            sum += surfaces[n as usize % surfaces.len()].matter.albedo();
        }
        if flags.is_empty() { 0.0 } else { sum }
    });
    every_variant(&kernel, &inputs(4));
}

/// A captured variant decides a `match` while the kernel is recorded.
#[test]
fn captured_enums_prune() {
    for matter in [Matter::Matte, Matter::Mirror, Matter::Glass] {
        let kernel = kernel!(|x: f32, n: u32| match matter {
            Matter::Matte => x * 123.0,
            Matter::Mirror => x + n as f32,
            Matter::Glass => -x,
        });
        every_variant(&kernel, &inputs(5));
        let wgsl = kernel.wgsl();
        assert_eq!(wgsl.contains("123"), matter == Matter::Matte, "{wgsl}");
        // The one test is whether the invocation has an input.
        assert_eq!(wgsl.matches("if (").count(), 1, "{wgsl}");
    }
}

/// Every way to go through the elements.
#[test]
fn loops_over_elements() {
    let balls: Vec<Ball> = (0..11)
        .map(|i| Ball { center: vec3(i as f32 - 5.0, 0.5, 1.0), radius: 0.25, id: i * 3 })
        .collect();
    let weights = [0.5, -1.5, 2.0];
    let kernel = kernel!(|x: f32, n: u32| {
        let mut sum = 0.0;
        for ball in balls.iter() {
            if ball.center.x > x {
                continue;
            }
            sum += ball.radius;
        }
        for (i, ball) in balls.iter().enumerate() {
            if i as u32 > n {
                break;
            }
            sum += (ball.id + i as u32) as f32;
        }
        let table = [x, 2.0, n as f32];
        for (i, t) in table.iter().enumerate() {
            sum += t * weights[i];
        }
        for &Ball { radius, id, .. } in &balls {
            if id == 9 {
                sum -= radius;
            }
        }
        for w in weights {
            sum += w * w;
        }
        'outer: for a in &balls {
            for w in weights.iter() {
                if a.center.x * w > x {
                    continue 'outer;
                }
                if a.id > n {
                    break 'outer;
                }
                sum += 1.0;
            }
        }
        sum
    });
    every_variant(&kernel, &inputs(8));
}

/// What a condition guards is not read.
#[test]
fn guarded_elements() {
    let none: &[f32] = &[];
    let one = &[3.0f32][..];
    let has = false;
    let kernel = kernel!(|x: f32, n: u32| {
        let mut sum = x;
        if none.len() > 3 && none[3] > 1.0 {
            sum = 2.0;
        }
        if one.len() > 3 && one[3] > 1.0 {
            sum += 2.0;
        }
        if host(has) && none[0] > 1.0 {
            sum = 4.0;
        }
        let k = if none.len() > n as usize { none[n as usize] } else { x };
        let last = if one.len() > 2 { one[2] } else { one[0] };
        sum + k + last
    });
    every_variant(&kernel, &inputs(9));
}

/// Of one slice only the length is read, of another nothing.
#[test]
fn lengths_alone() {
    let balls = [1.0f32; 5];
    let (balls, others) = (&balls[..], &[2.0f32; 3][..]);
    let kernel = kernel!(|x: f32, n: u32| {
        let mut sum = x;
        for _ in balls.iter() {
            sum += 1.0;
        }
        for i in 0..others.len() {
            sum -= i as f32;
        }
        if n as usize > balls.len() { sum } else { -sum }
    });
    every_variant(&kernel, &inputs(10));
    let wgsl = kernel.wgsl();
    assert!(wgsl.contains("len_of_balls") && !wgsl.contains("balls_at"), "{wgsl}");
}

/// Slices that live in the application's own buffers.
#[cfg(feature = "gpu")]
mod windows {
    use raydsl::gpu::{Context, GpuError, GpuScheduler, GpuWindow, WindowError};
    use raydsl::prelude::*;
    use raydsl::shading::{Mesh, MeshAttributes};
    use wgpu::BufferUsages as Usage;

    use super::{Ball, inputs, nearest};

    /// A device of its own: its counter of uploads counts for one test.
    fn own_device() -> Option<GpuScheduler> {
        raydsl_tests::gpu::gpu()?;
        Some(GpuScheduler::new().expect("there is one device already"))
    }

    fn balls() -> Vec<Ball> {
        let center = |i: u32| vec3(i as f32 - 4.0, 0.5, (i % 3) as f32);
        (0..13).map(|i| Ball { center: center(i), radius: 0.25, id: i * 2 }).collect()
    }

    fn bytes(balls: &[Ball]) -> Vec<u8> {
        let floats = |b: &Ball| [b.center.x, b.center.y, b.center.z, b.radius].map(f32::to_bits);
        let words = balls.iter().flat_map(|b| floats(b).into_iter().chain([b.id]));
        words.flat_map(u32::to_le_bytes).collect()
    }

    fn buffer(gpu: &GpuScheduler, size: u64, usage: Usage) -> wgpu::Buffer {
        gpu.context().device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("the application's"),
            size,
            usage: usage | Usage::COPY_DST,
            mapped_at_creation: false,
        })
    }

    fn filled(gpu: &GpuScheduler, balls: &[Ball], offset: u64) -> GpuWindow {
        let bytes = bytes(balls);
        let size = bytes.len() as u64;
        let buffer = buffer(gpu, offset + size + 64, Usage::STORAGE);
        gpu.context().queue().write_buffer(&buffer, offset, &bytes);
        GpuWindow { buffer, offset, size }
    }

    fn found(gpu: &GpuScheduler, kernel: &Kernel<'_, (f32, u32), u32>) -> Vec<u32> {
        let inputs = inputs(11);
        let mut found = vec![0; inputs.len()];
        gpu.batch(kernel, &inputs, &mut found).expect("the device runs it");
        let mut expected = vec![0; inputs.len()];
        kernel.run(Variant::Scalar, &inputs, &mut expected);
        assert_eq!(found, expected);
        found
    }

    #[test]
    fn nothing_is_uploaded() -> Result<(), GpuError> {
        let Some(gpu) = own_device() else { return Ok(()) };
        let all = balls();
        // As a captured slice, and as an argument.
        let kernel = kernel!(|x: f32, n: u32| {
            let near = nearest(&all, vec3(x, 0.0, 1.0), 100);
            near * 100 + all[n as usize % all.len()].id
        });
        {
            let _window = gpu.with_gpu(&all, filled(&gpu, &all, 256))?;
            found(&gpu, &kernel);
            found(&gpu, &kernel);
            assert_eq!(gpu.context().uploaded_bytes(), 0);
            // A part has the address of the whole, and is another slice.
            let part = &all[..5];
            let of_part =
                kernel!(|x: f32, n: u32| part[n as usize % part.len()].id + (x > 0.0) as u32);
            found(&gpu, &of_part);
            assert_eq!(gpu.context().uploaded_bytes(), 5 * 20);
            found(&gpu, &kernel);
            assert_eq!(gpu.context().uploaded_bytes(), 5 * 20);
        }
        found(&gpu, &kernel);
        assert_eq!(gpu.context().uploaded_bytes(), 18 * 20);
        Ok(())
    }

    /// It is the window that is read.
    #[test]
    fn the_window_counts() -> Result<(), GpuError> {
        let Some(gpu) = own_device() else { return Ok(()) };
        let all = balls();
        let others: Vec<Ball> = all.iter().map(|b| Ball { id: b.id + 7, ..*b }).collect();
        let kernel = kernel!(|n: u32| all[n as usize % 13].id);
        let _window = gpu.with_gpu(&all, filled(&gpu, &others, 0))?;
        let inputs: Vec<(u32,)> = (0..20).map(|n| (n,)).collect();
        let mut found = vec![0; inputs.len()];
        gpu.batch(&kernel, &inputs, &mut found)?;
        let expected: Vec<u32> = (0..20).map(|n| n % 13 * 2 + 7).collect();
        assert_eq!(found, expected);
        Ok(())
    }

    fn window_of(gpu: &GpuScheduler, numbers: &[f32]) -> GpuWindow {
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let size = bytes.len() as u64;
        let buffer = buffer(gpu, size, Usage::STORAGE);
        gpu.context().queue().write_buffer(&buffer, 0, &bytes);
        GpuWindow { buffer, offset: 0, size }
    }

    /// Positions and attributes of a mesh stay in the application's buffers.
    #[test]
    fn meshes_are_not_uploaded() -> Result<(), Box<dyn core::error::Error>> {
        let [Some(gpu), Some(other)] = [own_device(), own_device()] else { return Ok(()) };
        let at = |i: u32| vec3((i % 5) as f32, (i / 5) as f32, 4.0 + 0.1 * (i % 3) as f32);
        let positions: Vec<Vec3> = (0..25).map(at).collect();
        let normals: Vec<Vec3> = positions.iter().map(|p| *p - vec3(2.0, 2.0, 9.0)).collect();
        let uvs: Vec<Vec2> = positions.iter().map(|p| vec2(p.x, p.y) * 0.25).collect();
        let squares = (0..20).filter(|i| i % 5 != 4);
        let triangles: Vec<IndexedTriangle> = squares
            .flat_map(|i| [[i, i + 1, i + 6], [i, i + 6, i + 5]])
            .map(|vertices| IndexedTriangle { vertices })
            .collect();
        let tree = Bvh::build_sharing(&triangles, &positions, &BuildConfig::default())?;
        let attributes = MeshAttributes { normals: &normals, uvs: &uvs, ..Default::default() };
        let mesh = Mesh::new(&tree, attributes)?;
        let kernel = kernel!(|x: f32, y: f32| {
            let ray = Ray::new(vec3(x, y, 0.0), Vec3::Z);
            let hit = mesh.closest_hit(ray);
            let seen = mesh.shading_point(ray, hit);
            if hit.is_hit { seen.uv.extend(seen.shading_normal.z) } else { Vec3::ZERO }
        });
        let inputs: Vec<(f32, f32)> =
            (0..100).map(|i| ((i % 10) as f32 * 0.5, (i / 10) as f32 * 0.5)).collect();
        let run = |gpu: &GpuScheduler| {
            let mut found = vec![Vec3::ZERO; inputs.len()];
            gpu.batch(&kernel, &inputs, &mut found).map(|_| found)
        };
        let expected = run(&other)?;
        assert!(expected.iter().filter(|v| v.z != 0.0).count() > 50);

        let numbers = |v: &[Vec3]| v.iter().flat_map(|v| v.to_array()).collect::<Vec<f32>>();
        let of_uvs: Vec<f32> = uvs.iter().flat_map(|v| v.to_array()).collect();
        let view = tree.view();
        let _positions = gpu.with_gpu(view.shared(), window_of(&gpu, &numbers(&positions)))?;
        let _normals = gpu.with_gpu(&normals, window_of(&gpu, &numbers(&normals)))?;
        let _uvs = gpu.with_gpu(&uvs, window_of(&gpu, &of_uvs))?;
        assert_eq!(run(&gpu)?, expected);
        let kept = other.context().uploaded_bytes() - gpu.context().uploaded_bytes();
        assert_eq!(kept, 25 * (12 + 12 + 8));
        Ok(())
    }

    fn problem(gpu: &GpuScheduler, slice: &[Ball], window: GpuWindow) -> WindowError {
        let error = gpu.with_gpu(slice, window).expect_err("the window is wrong");
        assert!(error.to_string().contains("Ball"), "{error}");
        match error {
            GpuError::Window { problem, .. } => problem,
            other => panic!("{other}"),
        }
    }

    #[test]
    fn wrong_windows_are_refused() -> Result<(), GpuError> {
        let Some(gpu) = own_device() else { return Ok(()) };
        let all = balls();
        let right = filled(&gpu, &all, 0);
        let limit = u64::from(gpu.context().device().limits().min_storage_buffer_offset_alignment);
        let offset = limit / 2;
        let unaligned = problem(&gpu, &all, GpuWindow { offset, ..right.clone() });
        assert_eq!(unaligned, WindowError::Unaligned { offset, limit });
        assert!(unaligned.to_string().contains("min_storage_buffer_offset_alignment"));
        // Too small, and with the padding that WGSL's own structs would have.
        for size in [12 * 20, 13 * 32] {
            let wrong = problem(&gpu, &all, GpuWindow { size, ..right.clone() });
            assert_eq!(wrong, WindowError::WrongSize { size, len: 13, stride: 20, needed: 260 });
        }
        let end = right.buffer.size();
        for offset in [limit * 8, u64::MAX - limit + 1] {
            let past = problem(&gpu, &all, GpuWindow { offset, ..right.clone() });
            assert_eq!(past, WindowError::PastEnd { offset, size: 260, limit: end });
        }
        let no_storage = GpuWindow { buffer: buffer(&gpu, 260, Usage::VERTEX), ..right.clone() };
        assert_eq!(problem(&gpu, &all, no_storage), WindowError::NotStorage);
        assert_eq!(problem(&gpu, &[], right.clone()), WindowError::Empty);
        let taken = gpu.with_gpu(&all, right.clone())?;
        assert_eq!(problem(&gpu, &all, right.clone()), WindowError::Taken);
        drop(taken);
        // Whatever was refused has left nothing behind.
        drop(gpu.with_gpu(&all, right)?);
        Ok(())
    }

    /// Two devices of one instance, as an application may have.
    fn two_devices() -> Option<[GpuScheduler; 2]> {
        raydsl_tests::gpu::gpu()?;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()));
        let adapter = adapter.expect("there is an adapter");
        Some([(); 2].map(|()| {
            let made = pollster::block_on(adapter.request_device(&Default::default()));
            let (device, queue) = made.expect("the adapter gives devices");
            GpuScheduler::with_context(Context::from_wgpu(None, device, queue))
        }))
    }

    #[test]
    fn buffers_of_another_device_are_refused() {
        let Some([gpu, other]) = two_devices() else { return };
        let all = balls();
        // Neither number may be the other's.
        let (_, foreign) = (filled(&other, &all, 0), filled(&other, &all, 0));
        let refused = problem(&gpu, &all, foreign);
        assert!(matches!(refused, WindowError::Foreign { .. }), "{refused}");
    }

    #[test]
    fn foreign_and_destroyed_buffers_are_refused() {
        let (Some(gpu), Some(other)) = (own_device(), own_device()) else { return };
        let all = balls();
        let foreign = problem(&gpu, &all, filled(&other, &all, 0));
        assert!(matches!(foreign, WindowError::Foreign { .. }), "{foreign}");
        assert!(foreign.to_string().contains("Context::device()"), "{foreign}");
        let destroyed = filled(&gpu, &all, 0);
        destroyed.buffer.destroy();
        let kernel = kernel!(|n: u32| all[n as usize % 13].id);
        let mut found = [0];
        let outcome = gpu.with_gpu(&all, destroyed).and_then(|window| {
            let outcome = gpu.batch(&kernel, &[(1,)], &mut found);
            drop(window);
            outcome
        });
        assert!(outcome.is_err(), "{outcome:?}");
    }
}
