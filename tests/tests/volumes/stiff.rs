//! Emission and absorption with known results, thin and thick.

use raydsl::prelude::*;
use raydsl::volume::{ExactCell, VolumeLight};

use super::{along, column, linear, volume};

/// Relative difference.
fn off(found: f32, expected: f64) -> f64 {
    (f64::from(found) - expected).abs() / expected.abs()
}

/// One cell of any optical depth: opacity without loss.
#[test]
fn opacity_of_a_homogeneous_cell() {
    for depth in [1e-8f32, 1e-6, 1e-3, 1.0, 1e3, 1e6] {
        let grid = column(1, 1.0, |_| 1.0);
        let volume = volume(&grid, linear(depth, 1.0, 1.0));
        let expected = -(-f64::from(depth)).exp_m1();
        let exact = ExactCell::new().least(0.0);
        let light = volume.integrate(&exact, along(), VolumeLight::new());
        assert!(off(light.opacity(), expected) < 1e-6, "{depth}: {}", light.opacity());
        assert!(off(light.radiance.x, expected) < 1e-6, "{depth}: {}", light.radiance.x);
    }
}

/// Linear extinction and colour: `extinction = s t / D`, `color = t / D`, `D = 2`.
#[test]
fn linear_ramps() {
    for (scale, expected) in [
        (1e-6f32, 6.6666626666680952e-7),
        (4.0, 0.42272505649247666),
        (400.0, 0.044311346272637901),
        (4e4, 0.0044311346272637901),
        (4e6, 0.00044311346272637901),
    ] {
        for count in [1, 3, 64, 1024] {
            let grid = column(count, 2.0, |t| t);
            let volume = volume(&grid, linear(scale, 0.0, 1.0));
            let exact = ExactCell::new().least(0.0);
            let light = volume.integrate(&exact, along(), VolumeLight::new());
            let off = off(light.radiance.x, expected);
            println!("{scale:e} {count}: {} off by {off:.1e}", light.radiance.x);
            assert!(off < 1e-5, "{scale}, {count} cells: {} off by {off}", light.radiance.x);
            let kernel =
                kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).radiance.x);
            let f64_off = (kernel.reference((along(),))[0] - expected).abs() / expected;
            println!("    in f64 off by {f64_off:.1e}");
        }
    }
}
