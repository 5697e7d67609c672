//! Integrators against the oracle, and against each other in every variant.

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl::testing::FilmTest;
use raydsl::volume::{
    Adaptive, Centering, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, MeanExtinction,
    Midpoint, PreIntegrated, ShadedCell, TransferFunction, Volume, VolumeIntegrator, VolumeLight,
};
pub(crate) use raydsl_tests::close::assert_close;
use raydsl_tests::close::functions;
use raydsl_tests::rng::Rng;

use super::oracle::{self, Field};
use super::{along, column, linear, volume};

fn grids() -> Vec<(Vec<f32>, UVec3, GridConfig)> {
    let mut rng = Rng::of("agreement");
    let noise: Vec<f32> = (0..7 * 5 * 6).map(|_| rng.unit()).collect();
    let ball = |i: usize| {
        let at = vec3((i % 20) as f32, (i / 20 % 20) as f32, (i / 400) as f32);
        (1.0 - at.distance(Vec3::splat(9.5)) / 9.0).clamp(0.0, 1.0)
    };
    vec![
        (noise.clone(), uvec3(7, 5, 6), GridConfig::new().spacing(vec3(1.0, 0.5, 2.0))),
        (noise, uvec3(5, 6, 7), GridConfig::new().centering(Centering::Cell)),
        (
            (0..8000).map(ball).collect(),
            uvec3(20, 20, 20),
            GridConfig::new().spacing(Vec3::splat(0.25)),
        ),
    ]
}

fn rays(grid: &Grid<'_, f32>, count: usize) -> Vec<(Ray,)> {
    let mut rng = Rng::of("rays");
    let size = grid.config().to_world.transform_point3(grid.size().as_vec3());
    let ray = |i| {
        let target = size * (rng.point(0.5) + 0.5);
        let mut direction = rng.direction();
        if i % 5 == 0 {
            direction = rng.pick(&[Vec3::X, Vec3::Y, -Vec3::Z, vec3(1.0, 1.0, 0.0)]);
        }
        let ray = Ray::new(target - direction * 20.0, direction);
        (if i % 7 == 0 { ray.with_range(19.0, 21.5) } else { ray },)
    };
    (0..count).map(ray).collect()
}

/// Asserts that opacity is from 0 to 1, and radiance at most that of the brightest colour, 1.
#[track_caller]
fn assert_bounded(light: VolumeLight) {
    assert!(light.opacity() >= 0.0 && light.opacity() <= 1.0, "{light:?}");
    let (least, most) = (light.radiance.min_element(), light.radiance.max_element());
    assert!(least >= 0.0 && most <= light.opacity() * (1.0 + 2e-6), "{light:?}");
}

/// The exact cell, and steps to a tolerance from any first step.
#[test]
fn integrals_are_those_of_the_oracle() {
    let (mut honoured, mut all) = (0, 0);
    for (voxels, size, config) in grids() {
        let grid = Grid::new(&voxels[..], size, config).expect("a grid");
        let field = Field::new(&voxels, &grid);
        for transfer in functions() {
            let volume = Volume::new(&grid, transfer);
            let exact = ExactCell::new().least(0.0);
            let mut worst = 0.0f64;
            for (ray,) in &rays(&grid, 60) {
                let expected = oracle::integrate(&field, volume.transfer(), *ray, 1000);
                let opacity = -(-expected.depth).exp_m1();
                let off = |light: VolumeLight| {
                    let off = (light.radiance.as_dvec3() - expected.radiance).abs().max_element();
                    off.max((f64::from(light.opacity()) - opacity).abs())
                };
                let light = volume.integrate(&exact, *ray, VolumeLight::new());
                assert_bounded(light);
                worst = worst.max(off(light) / opacity.max(1e-3));
                for tolerance in [1e-2, 1e-3, 1e-4] {
                    for start in [1e-3, 0.3, f32::MAX] {
                        let adaptive = Adaptive::new(tolerance).start(start);
                        let light = volume.integrate(&adaptive, *ray, VolumeLight::new());
                        assert_bounded(light);
                        let off = off(light);
                        all += 1;
                        honoured += usize::from(off <= f64::from(tolerance));
                        let most = 4.0 * f64::from(tolerance);
                        assert!(off <= most, "{ray:?}, {tolerance} from {start}: off by {off}");
                    }
                }
            }
            assert!(worst < 1e-4, "{size}: off by {worst}");
        }
    }
    assert!(honoured * 100 >= all * 99, "{honoured} of {all} rays are within the tolerance");
}

/// Single samples are within bounds of each other; of one ray more decisions are open than can be
/// followed, so films say whether a device is right: their means agree.
#[test]
fn variants_agree() {
    for (i, (voxels, size, config)) in grids().into_iter().enumerate() {
        let grid = Grid::new(&voxels[..], size, config).expect("a grid");
        let middle = config.to_world.transform_point3(size.as_vec3()) * 0.5;
        let camera = Pinhole::new(middle + vec3(5.0, 9.0, 18.0), middle, Vec3::Y, 0.5);
        for (j, transfer) in functions().into_iter().enumerate() {
            let volume = Volume::new(&grid, transfer);
            let inputs = rays(&grid, 200);
            macro_rules! check {
                ($integrator:expr, $bound:expr) => {
                    let integrator = $integrator;
                    for (ray,) in &inputs {
                        assert_bounded(integrator.integrate(&volume, *ray, VolumeLight::new()));
                    }
                    let kernel = kernel!(|ray: Ray| {
                        volume.integrate(&integrator, ray, VolumeLight::new()).rgba()
                    });
                    if i == 0 && j < 3 {
                        assert_variants_agree!(&kernel, &FilmTest::new(&camera, 12, 12));
                    }
                    assert_close(&kernel, &inputs, $bound);
                };
            }
            // A sample that rounding moves across a step differs by the step.
            check!(Euler::new(0.3), 2e-2);
            check!(ExponentialLeft::new(0.3), 2e-2);
            check!(Midpoint::new(0.3), 2e-2);
            check!(MeanExtinction::new(0.3), 2e-2);
            check!(PreIntegrated::new(0.3), 1e-3);
            check!(Adaptive::new(1e-3), 2e-3);
            check!(ExactCell::new(), 1e-4);
            check!(ShadedCell::new(vec3(0.6, 0.0, 0.8), 0.5), 1e-3);
        }
    }
}

/// Steps of any length give the same opacity of a homogeneous slab, by every integrator but
/// Euler's.
#[test]
fn opacity_of_a_slab_does_not_depend_on_the_step() {
    let grid = column(16, 16.0, |_| 0.5);
    let expected = -(-0.3f64 * 16.0).exp_m1() as f32;
    let volume = volume(&grid, linear(0.6, 1.0, 1.0));
    let none = VolumeLight::new();
    for step in [0.25, 0.3, 1.0, 2.5, 7.0, 16.0] {
        let found = [
            volume.integrate(&ExponentialLeft::new(step), along(), none),
            volume.integrate(&Midpoint::new(step), along(), none),
            volume.integrate(&MeanExtinction::new(step), along(), none),
            volume.integrate(&PreIntegrated::new(step), along(), none),
            volume.integrate(&Adaptive::new(1e-5).start(step), along(), none),
            volume.integrate(&ExactCell::new(), along(), none),
        ];
        for light in found {
            assert!((light.opacity() - expected).abs() < 1e-5, "{step}: {}", light.opacity());
        }
        let euler = volume.integrate(&Euler::new(step), along(), none).opacity();
        assert!((euler - expected).abs() > 1e-4, "{step}: {euler}");
    }
}

/// A volume whose grid is cut in two along the ray, or passed in parts, is the same volume.
#[test]
fn parts_of_a_ray_add_up() {
    let (voxels, size, config) = &grids()[2];
    let grid = Grid::new(&voxels[..], *size, *config).expect("a grid");
    for transfer in functions() {
        let volume = Volume::new(&grid, transfer);
        let exact = ExactCell::new().least(0.0);
        for (ray,) in rays(&grid, 60) {
            let whole = volume.integrate(&exact, ray, VolumeLight::new());
            let mut parts = VolumeLight::new();
            let (enter, leave) = volume.grid().span(ray);
            let ends = [enter, enter * 0.7 + leave * 0.3, enter * 0.2 + leave * 0.8, leave];
            for ends in ends.windows(2) {
                parts = volume.integrate(&exact, ray.with_range(ends[0], ends[1]), parts);
            }
            let off = (whole.rgba() - parts.rgba()).abs().max_element();
            assert!(off < 2e-5, "{ray:?}: {} and {}", whole.rgba(), parts.rgba());
        }
    }
}

/// Space without extinction is skipped, and nothing changes.
#[test]
fn skipping_changes_nothing() {
    let size = uvec3(40, 40, 40);
    let ball = |i: u32| {
        let at = uvec3(i % 40, i / 40 % 40, i / 1600).as_vec3();
        (1.0 - at.distance(vec3(12.0, 25.0, 18.0)) / 9.0).max(0.0)
    };
    let voxels: Vec<f32> = (0..64_000).map(ball).collect();
    let grid = Grid::new(&voxels[..], size, GridConfig::new()).expect("a grid");
    let colors = [(0.0, Vec3::ONE)];
    let ball = [(0.1, 0.0), (0.5, 2.0)];
    // The same but for an extinction that no rounding keeps: no macro-cell is empty.
    let full = [(0.0, 1e-30), (0.1, 1e-30), (0.5, 2.0)];
    let [ball, full] = [&ball[..], &full[..]]
        .map(|knots| TransferFunction::from_extinction(&colors, knots).expect("a function"));
    let (skipped, full) = (Volume::new(&grid, ball), Volume::new(&grid, full));
    let empty = skipped.majorants().iter().filter(|m| **m == 0.0).count();
    assert!(empty > skipped.majorants().len() / 3, "{empty}");
    assert!(full.majorants().iter().all(|m| *m > 0.0));
    for (ray,) in rays(&grid, 100) {
        let none = VolumeLight::new();
        let pairs = [
            [&skipped, &full].map(|v| v.integrate(&Midpoint::new(0.37), ray, none)),
            [&skipped, &full].map(|v| v.integrate(&MeanExtinction::new(0.37), ray, none)),
            [&skipped, &full].map(|v| v.integrate(&ExponentialLeft::new(0.37), ray, none)),
            [&skipped, &full].map(|v| v.integrate(&PreIntegrated::new(0.37), ray, none)),
            [&skipped, &full].map(|v| v.integrate(&ExactCell::new(), ray, none)),
        ];
        for [a, b] in pairs {
            let off = (a.rgba() - b.rgba()).abs().max_element();
            assert!(off < 2e-6, "{ray:?}: {} and {}", a.rgba(), b.rgba());
        }
    }
}
