//! Another transfer function, on a device: nothing is printed or compiled again.

use raydsl::gpu::GpuScheduler;
use raydsl::prelude::*;
use raydsl::render::Renderer;
use raydsl::volume::{ExactCell, TransferFunction, Volume, VolumeLight};
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
