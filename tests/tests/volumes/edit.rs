//! What a change leaves as it is: another transfer function on a device prints and compiles
//! nothing, smaller bindings, other threads and tiles have the same picture.

use raydsl::gpu::{Context, GpuScheduler};
use raydsl::prelude::*;
use raydsl::render::Renderer;
use raydsl::volume::{ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight};
use raydsl_tests::gpu::gpu;

use super::{along, column, linear, volume};

fn opacity(gpu: &GpuScheduler, volume: &Volume<'_, f32>) -> f32 {
    let exact = ExactCell::new();
    let kernel = kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).opacity());
    let mut found = [0.0];
    gpu.batch(&kernel, &[(along(),)], &mut found).expect("a device that works");
    found[0]
}

#[test]
fn a_device_keeps_its_program_when_the_function_changes() {
    let Some(gpu) = gpu() else { return };
    let grid = column(8, 1.0, |_| 1.0);
    let mut volume = volume(&grid, linear(1.0, 0.0, 1.0));
    let context = gpu.context();
    let counts = || (context.printed(), context.compiled());
    assert!((opacity(gpu, &volume) - 0.632_120_6).abs() < 1e-5);
    let first = counts();
    // Other numbers, and another number of knots.
    volume.set_transfer(linear(2.0, 0.5, 0.0));
    assert!((opacity(gpu, &volume) - 0.864_664_7).abs() < 1e-5);
    let knots: Vec<(f32, f32)> = (0..100).map(|i| (i as f32 * 0.01, 3.0)).collect();
    let colors = [(0.0, Vec3::ONE)];
    let many = TransferFunction::from_extinction(&colors, &knots).expect("a function");
    volume.set_transfer(many);
    assert!((opacity(gpu, &volume) - 0.950_212_9).abs() < 1e-5);
    assert_eq!(counts(), first);
}

/// A field larger than a binding of the device is read through several.
#[test]
fn a_field_may_exceed_a_binding() {
    if gpu().is_none() {
        return;
    }
    let size = uvec3(50, 40, 60);
    let at = |i: u32| uvec3(i % size.x, i / size.x % size.y, i / (size.x * size.y)).as_vec3();
    let voxels: Vec<f32> = (0..size.x * size.y * size.z)
        .map(|i| 1.0 - at(i).distance(vec3(25.0, 20.0, 30.0)) / 40.0)
        .collect();
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    let volume = volume(&grid, linear(0.05, 0.2, 1.0));
    let exact = ExactCell::new();
    let kernel = kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).rgba());
    let rays: Vec<(Ray,)> = (0..64)
        .map(|i| {
            let side = vec3((i % 8) as f32 * 6.0, (i / 8) as f32 * 5.0, 0.0);
            (Ray::new(side + vec3(2.0, 2.0, -5.0), vec3(0.1, 0.05, 1.0)),)
        })
        .collect();
    // 480,000 bytes in bindings of 65,536.
    let context = Context::new().expect("as that of the tests").with_max_binding_bytes(1 << 16);
    let small = GpuScheduler::with_context(context);
    let mut found = vec![Vec4::ZERO; rays.len()];
    small.batch(&kernel, &rays, &mut found).expect("several bindings");
    for (ray, found) in rays.iter().zip(found) {
        let expected = kernel.call(*ray);
        assert!((found - expected).abs().max_element() < 1e-4, "{ray:?}: {found}, not {expected}");
    }
    // More than a program has bindings.
    let context = Context::new().expect("as before").with_max_binding_bytes(256);
    let mut found = vec![Vec4::ZERO; rays.len()];
    let error = GpuScheduler::with_context(context).batch(&kernel, &rays, &mut found);
    let error = error.expect_err("1875 bindings").to_string();
    assert!(error.contains("storage buffers") && error.contains("use fewer"), "{error}");
}

/// The picture of a volume has the same bits whatever runs it.
#[test]
fn threads_and_tiles_leave_no_trace() {
    let size = uvec3(20, 21, 22);
    let voxels: Vec<f32> = (0..size.x * size.y * size.z).map(|i| (i % 97) as f32 / 97.0).collect();
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    let volume = volume(&grid, linear(0.2, 0.2, 1.0));
    let exact = ExactCell::new();
    let kernel = kernel!(|ray: Ray| {
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        Shaded { color: light.radiance, depth: light.depth, id: 0u32 }
    });
    let camera = Pinhole::new(vec3(50.0, 40.0, 30.0), vec3(10.0, 10.0, 11.0), Vec3::Z, 0.7);
    let mut pictures = Vec::new();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        for edge in [1, 5, 16, 64] {
            let mut image = Image::new(37, 29);
            let scheduler = TiledScheduler::new().tile(edge);
            pool.install(|| scheduler.frame(&camera, &kernel, &mut image));
            let bits = |s: &Shaded| (s.color.to_array().map(f32::to_bits), s.depth.to_bits());
            pictures.push(image.pixels().iter().map(bits).collect::<Vec<_>>());
        }
    }
    assert!(pictures.iter().all(|p| *p == pictures[0]));
}
