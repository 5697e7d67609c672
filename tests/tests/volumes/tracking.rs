//! Random estimates of transmittance: their means against the exact cell.

use raydsl::prelude::*;
use raydsl::testing;
use raydsl::volume::{
    ExactCell, Fog, Grid, GridConfig, TransferFunction, Volume, VolumeLight, delta_tracking,
    jackknife_transmittance, ratio_transmittance,
};
use raydsl_tests::rng::Rng as Random;

/// Mean, and variance of the mean.
fn mean(all: impl Iterator<Item = f32>) -> (f64, f64) {
    let all: Vec<f64> = all.map(f64::from).collect();
    let n = all.len() as f64;
    let mean = all.iter().sum::<f64>() / n;
    (mean, all.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n * (n - 1.0)))
}

#[test]
fn estimates_have_the_right_mean() {
    let mut random = Random::of("tracking");
    let size = uvec3(21, 12, 17);
    let voxels: Vec<f32> = (0..size.x * size.y * size.z).map(|_| random.unit()).collect();
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    // Haze, and a peak that most tentative collisions miss.
    let haze = [(0.0, 0.0), (0.5, 0.05), (1.0, 0.3)];
    let peak = [(0.7, 0.0), (0.72, 2.0), (0.74, 0.0)];
    for extinctions in [haze, peak] {
        let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &extinctions);
        let volume = Volume::new(&grid, function.expect("a function"));
        let kernel = kernel!(|ray: Ray, seed: u32| {
            let mut rng = Rng::new(uvec2(seed, 3), 0, 1);
            let delta = delta_tracking(&volume, ray, &mut rng);
            let passed = if delta.is_none() { 1.0 } else { 0.0 };
            let ratio = ratio_transmittance(&volume, ray, &mut rng);
            vec3(passed, ratio, jackknife_transmittance(&volume, ray, 0.5, &mut rng))
        });
        for i in 0..6 {
            let target = size.as_vec3() * (random.point(0.4) + 0.5);
            let direction = random.direction().normalize();
            // Estimates are of a way in the world, whatever the length of the direction.
            let ray = Ray::new(target - direction * 30.0, direction * [1.0, 0.25, 3.0][i % 3]);
            let exact = ExactCell::new().least(0.0);
            let light = volume.integrate(&exact, ray, VolumeLight::new());
            let expected = f64::from(light.transmittance());
            let inputs: Vec<(Ray, u32)> = (0..4096).map(|seed| (ray, seed)).collect();
            let scalar = testing::run(&kernel, Variant::Scalar, &inputs);
            let (delta, _) = mean(scalar.iter().map(|v| v.x));
            let sigma = (expected * (1.0 - expected) / 4096.0).sqrt();
            assert!((delta - expected).abs() < 4.5 * sigma, "{delta}, not {expected}");
            let (ratio, ratio_variance) = mean(scalar.iter().map(|v| v.y));
            let sigma = ratio_variance.sqrt() + 1e-6;
            assert!((ratio - expected).abs() < 4.5 * sigma, "{ratio}, not {expected}");
            let (jackknife, variance) = mean(scalar.iter().map(|v| v.z));
            let bias = (jackknife - expected).abs();
            assert!(bias < 2e-3 + 4.5 * variance.sqrt(), "{jackknife}, not {expected}");
            assert!(variance < ratio_variance, "{variance} and {ratio_variance}");
            for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
                if testing::can_run(variant, "tracking") {
                    let found = testing::run(&kernel, variant, &inputs);
                    assert!(found == scalar, "{}", variant.name());
                }
            }
            if testing::can_run(Variant::Wgsl, "tracking") {
                let found = testing::run(&kernel, Variant::Wgsl, &inputs);
                // A collision that rounding decides changes the rest of a walk.
                let same = |(a, b): (&Vec3, &Vec3)| (*a - *b).abs().max_element() < 1e-4;
                let same = scalar.iter().zip(&found).filter(|pair| same(*pair)).count();
                assert!(same * 100 > scalar.len() * 99, "WGSL: {same} of {}", scalar.len());
            }
        }
    }
}

/// Where the majorant of a macro-cell is thick, its own depth counts: of a narrow peak little.
#[test]
fn peaks_in_thick_macro_cells_have_their_own_depth() {
    let mut random = Random::of("peaks");
    let size = uvec3(21, 12, 17);
    let voxels: Vec<f32> = (0..size.x * size.y * size.z).map(|_| random.unit()).collect();
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    let peak = [(0.7, 0.0), (0.7002, 200.0), (0.7004, 0.0)];
    let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &peak);
    let volume = Volume::new(&grid, function.expect("a function"));
    for i in 0..6 {
        let target = size.as_vec3() * (random.point(0.4) + 0.5);
        let direction = random.direction().normalize();
        let ray = Ray::new(target - direction * 30.0, direction * [1.0, 0.25, 3.0][i % 3]);
        let exact = ExactCell::new().least(0.0);
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        let expected = f64::from(light.transmittance());
        assert!((0.01..0.99).contains(&expected), "{expected}");
        let (mut passed, mut ratios) = (0, Vec::new());
        for seed in 0..2000 {
            let mut rng = Rng::new(uvec2(seed, 3), 0, 1);
            ratios.push(ratio_transmittance(&volume, ray, &mut rng));
            passed += u32::from(delta_tracking(&volume, ray, &mut rng).is_none());
        }
        let (ratio, variance) = mean(ratios.into_iter());
        let bound = 4.5 * variance.sqrt() + 1e-3;
        assert!((ratio - expected).abs() < bound, "{ratio}, not {expected}");
        let delta = f64::from(passed) / 2000.0;
        let sigma = (expected * (1.0 - expected) / 2000.0).sqrt();
        assert!((delta - expected).abs() < 4.5 * sigma, "{delta}, not {expected}");
    }
}

/// A range that ends before it begins absorbs nothing, and adds nothing.
#[test]
fn empty_ranges_of_fog_are_clear() {
    let fog = Fog { extinction: 0.5, albedo: Vec3::ONE, anisotropy: 0.0 };
    let ray = Ray::new(Vec3::ZERO, Vec3::Z);
    for (first, last, expected) in [(1.0, 3.0, (-1.0f32).exp()), (2.0, 2.0, 1.0), (3.0, 1.0, 1.0)] {
        let found = fog.transmittance(ray.with_range(first, last));
        assert!((found - expected).abs() < 1e-6, "{first} to {last}: {found}");
    }
}

/// A collision is where the light of the exact cell says.
#[test]
fn collisions_are_distributed_as_the_optical_depth() {
    let grid = super::column(40, 4.0, |t| t);
    let volume = super::volume(&grid, super::linear(1.0, 1.0, 1.0));
    let mut counts = [0u32; 4];
    let count = 20_000;
    for seed in 0..count {
        let mut rng = Rng::new(uvec2(seed, 0), 0, 2);
        if let Some(t) = delta_tracking(&volume, super::along(), &mut rng) {
            assert!((1.0..5.0).contains(&t), "{t}");
            counts[(t - 1.0) as usize] += 1;
        }
    }
    // Extinction is `t / 4` of a length `t`.
    let passed = |t: f64| (-t * t / 8.0).exp();
    for (i, found) in counts.into_iter().enumerate() {
        let share = passed(i as f64) - passed(i as f64 + 1.0);
        let sigma = (share * (1.0 - share) * f64::from(count)).sqrt();
        let off = (f64::from(found) - share * f64::from(count)).abs();
        assert!(off < 4.5 * sigma, "{i}: {found}");
    }
}

/// A wall of opacity 1 behind clear air lets nothing through, however short a way it is in a
/// macro-cell, also from within and along rays of any length; and a collision is on its surface.
#[test]
fn walls_are_not_passed() {
    let size = uvec3(9, 9, 33);
    let wall = |z: u32| if z == 20 || z == 21 { 1.0 } else { 0.0 };
    let voxels: Vec<f32> = (0..size.element_product()).map(|i| wall(i / 81)).collect();
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    let function = TransferFunction::new(&[(0.0, Vec3::ONE)], &[(0.9, 0.0), (0.95, 1.0)], 1.0);
    let volume = Volume::new(&grid, function.expect("a function"));
    for (ray, scale) in [
        (Ray::new(vec3(4.0, 4.0, -5.0), Vec3::Z), 1.0),
        (Ray::new(vec3(4.0, 4.0, 3.0), Vec3::Z), 1.0),
        (Ray::new(vec3(4.0, 4.0, 3.0), Vec3::Z * 0.25), 4.0),
    ] {
        for seed in 0..200 {
            let mut rng = Rng::new(uvec2(seed, 0), 0, 5);
            let t = delta_tracking(&volume, ray, &mut rng).expect("nothing passes");
            let z = ray.origin.z + t / scale;
            assert!((19.89..19.96).contains(&z), "{ray:?}: {z}");
            assert!(ratio_transmittance(&volume, ray, &mut rng) < 1e-20);
        }
    }
    // The air behind the wall is as clear as that before it.
    let behind = Ray::new(vec3(4.0, 4.0, 22.2), Vec3::Z);
    let mut rng = Rng::new(uvec2(0, 0), 0, 6);
    assert_eq!(delta_tracking(&volume, behind, &mut rng), None);
    assert_eq!(ratio_transmittance(&volume, behind, &mut rng), 1.0);
}

/// Extinctions without bound end all walks.
#[test]
fn walks_end() {
    let grid = super::column(3, 1e6, |t| t);
    let peak = [(0.5, 0.0), (0.500_001, 3e38), (0.500_002, 0.0)];
    let peak = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &peak).expect("a function");
    let volume = super::volume(&grid, peak);
    let mut rng = Rng::new(uvec2(0, 0), 0, 2);
    let _ = delta_tracking(&volume, super::along(), &mut rng);
    let ratio = ratio_transmittance(&volume, super::along(), &mut rng);
    let jackknife = jackknife_transmittance(&volume, super::along(), 1e3, &mut rng);
    assert!((0.0..=1.0).contains(&ratio) && jackknife.abs() <= 1.0, "{ratio} and {jackknife}");
}
