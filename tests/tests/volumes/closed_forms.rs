//! Media whose optical depths are known, in every variant and in `f64`.

use raydsl::prelude::*;
use raydsl::testing;
use raydsl::volume::{Cut, ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight};

use super::cuts::Ball;
use super::{along, column, linear, volume};

/// Extinction that is the value.
fn value_itself() -> TransferFunction {
    linear(1.0, 1.0, 1.0)
}

/// Asserts the mean optical depth and transmittance of rays, in every variant and in `f64`.
#[track_caller]
fn assert_means(volume: &Volume<'_, f32>, rays: &[(Ray,)], [depth, passed]: [f64; 2]) {
    let exact = ExactCell::new().least(0.0);
    let kernel = kernel!(|ray: Ray| {
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        (light.depth, light.transmittance())
    });
    let check = |name: &str, found: [f64; 2], bound: f64| {
        for (found, expected) in found.into_iter().zip([depth, passed]) {
            let off = (found - expected).abs() / expected;
            assert!(off <= bound, "{name}: {found}, not {expected}: off by {off}");
        }
    };
    let mean =
        |all: &[[f64; 2]]| [0, 1].map(|i| all.iter().map(|v| v[i]).sum::<f64>() / all.len() as f64);
    for variant in Variant::ALL {
        if testing::can_run(variant, "closed forms") {
            let found = testing::run(&kernel, variant, rays);
            let found: Vec<[f64; 2]> = found.iter().map(|v| [v.0.into(), v.1.into()]).collect();
            let bound = if variant == Variant::Wgsl { 1e-4 } else { 1e-5 };
            check(variant.name(), mean(&found), bound);
        }
    }
    let reference: Vec<[f64; 2]> =
        rays.iter().map(|ray| kernel.reference(*ray).try_into().expect("two numbers")).collect();
    check("f64", mean(&reference), 4e-6);
}

/// A blob `3 exp(-r² / 2 s²)` with `s` of 0.25, passed at 0.375. Along a line of voxels the sum over
/// cells is the rule of trapezoids, whose error of a Gaussian is far below rounding.
#[test]
fn a_gaussian_blob() {
    let (side, cell) = (129u32, 3.0 / 128.0);
    let at = |i: u32| f64::from(i) * cell - 1.5;
    let value = |i: u32| {
        let (x, y, z) = (at(i % side), at(i / side % side), at(i / (side * side)));
        (3.0 * (-(x * x + y * y + z * z) / 0.125).exp()) as f32
    };
    let voxels: Vec<f32> = (0..side * side * side).map(value).collect();
    let config = GridConfig::new().spacing(Vec3::splat(cell as f32)).origin(Vec3::splat(-1.5));
    let grid = Grid::new(voxels, UVec3::splat(side), config).expect("a grid");
    let scaled = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 0.0), (3.0, 3.0)]);
    let volume = Volume::new(&grid, scaled.expect("a function"));
    let ray = Ray::new(vec3(0.375, 0.0, -4.0), Vec3::Z);
    assert_means(&volume, &[(ray,)], [0.610_337_290_581_868_04, 0.543_167_632_847_375_13]);
}

/// A halo `0.5 / r²`, passed at 0.3 from -1 to 2.
#[test]
fn a_halo() {
    let halo = |share: f32| {
        let t = 3.0 * f64::from(share) - 1.0;
        (0.5 / (0.09 + t * t)) as f32
    };
    let grid = column(4096, 3.0, halo);
    let scaled = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 0.0), (8.0, 8.0)]);
    let depth = 4.502_076_519_170_714_8;
    assert_means(
        &volume(&grid, scaled.expect("a function")),
        &[(along(),)],
        [depth, (-depth).exp()],
    );
}

/// An atmosphere `0.8 exp(-z / 1.5)` of a height of 3, passed at 60 degrees from the vertical.
#[test]
fn an_atmosphere() {
    let size = uvec3(2, 2, 2049);
    let value = |z: u32| (0.8 * (-f64::from(z) / 2048.0 * 2.0).exp()) as f32;
    let voxels: Vec<f32> = (0..size.z).flat_map(|z| [value(z); 4]).collect();
    let config =
        GridConfig::new().spacing(vec3(8.0, 8.0, 3.0 / 2048.0)).origin(vec3(-1.0, -1.0, 0.0));
    let grid = Grid::new(voxels, size, config).expect("a grid");
    let ray = Ray::new(Vec3::ZERO, vec3(3f32.sqrt(), 0.0, 1.0) * 0.5);
    let depth = 2.075_195_320_232_129_5;
    assert_means(&volume(&grid, value_itself()), &[(ray,)], [depth, (-depth).exp()]);
}

/// A wedge: over the footprint of a pixel the optical depth runs from 0 to 4.
#[test]
fn a_wedge() {
    let voxels: Vec<f32> = (0..8).map(|i| (i % 2) as f32).collect();
    let grid = Grid::new(voxels, UVec3::splat(2), GridConfig::new()).expect("a grid");
    let rays: Vec<(Ray,)> = (0..1000)
        .map(|i| (Ray::new(vec3((i as f32 + 0.5) / 1000.0, 0.5, -1.0), Vec3::Z),))
        .collect();
    assert_means(&volume(&grid, linear(4.0, 1.0, 1.0)), &rays, [2.0, 0.245_421_090_277_816_45]);
}

/// A ball of radius 1 and extinction 2: its opacity at 0.6 from the middle, and the mean of a disc.
#[test]
fn an_isothermal_ball() {
    let ball = [Ball { center: Vec3::ZERO, radius: 1.0 }];
    let ball = &ball[..];
    let config = GridConfig::new().spacing(Vec3::splat(4.0)).origin(Vec3::splat(-2.0));
    let grid = Grid::new(&[2.0f32; 8][..], UVec3::splat(2), config).expect("a grid");
    let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 2.0)]);
    let volume = Volume::new(&grid, function.expect("a function"));
    let exact = ExactCell::new().least(0.0);
    let kernel = kernel!(|ray: Ray| {
        let mut light = VolumeLight::new();
        let mut cut = Cut::new(ball, ray);
        while let Some(part) = cut.next_inside(ball) {
            light = volume.integrate(&exact, part, light);
        }
        light.opacity()
    });
    let ray = |aside: f64| (Ray::new(vec3(aside as f32, 0.0, -3.0), Vec3::Z),);
    // Rings of equal area.
    let mut rays: Vec<(Ray,)> =
        (0..4000).map(|i| ray(((i as f64 + 0.5) / 4000.0).sqrt())).collect();
    rays.push(ray(0.6));
    for variant in Variant::ALL {
        if testing::can_run(variant, "closed forms") {
            let found = testing::run(&kernel, variant, &rays);
            let bound = if variant == Variant::Wgsl { 1e-4 } else { 1e-5 };
            let mean = found[..4000].iter().map(|a| f64::from(*a)).sum::<f64>() / 4000.0;
            for (found, expected) in [
                (f64::from(found[4000]), 0.959_237_796_021_633_78),
                (mean, 0.886_447_274_305_458_86),
            ] {
                assert!((found - expected).abs() < bound, "{}: {found}", variant.name());
            }
        }
    }
}
