//! Pictures without variance converge at once, and their error is below the floor of `f32`.

use raydsl::integrators::{LightSampling, PathLimits, PathOptions};
use raydsl::light::AnyLight;
use raydsl::prelude::*;
use raydsl::render::{Budget, Metric, Outcome, Reached, Target, Until};
use raydsl::volume::{Grid, GridConfig, TransferFunction, Volume};
use raydsl_tests::transport::{BALL, Paint, medium, paint, shining_sphere};

use crate::coverage::Estimator;
use crate::media::{Media, uneven, with_opacity};
use crate::paths::{Paths, sky};

/// The relative rounding of a value in a film: half a unit in the last place where it is computed, half
/// a unit where it is averaged.
const FLOOR: f64 = 1.0 / (1 << 23) as f64;

/// Samples per pixel of the pilot.
const PILOT: u32 = 64;

/// The least number of samples: of eight replications, 1 sample each, 8 each for the pilot, and as many
/// fresh ones.
const LEAST: u32 = 8 * (1 + 8 + 8);

/// Renders by every metric, with and without adaptive sampling: the run ends with the least number of
/// samples that it can, its bound is at most the floor, and so is the true error.
#[track_caller]
fn assert_certain(name: &str, exact: f64, kernel: &Estimator<'_>) {
    // The film looks at the ball.
    let camera = Orthographic::new(vec3(0.01, 0.02, 3.0), vec3(0.01, 0.02, 0.0), Vec3::Y, 0.5);
    let floor = FLOOR * exact;
    for metric in [Metric::Rmse, Metric::RelMse, Metric::Mean] {
        for method in [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol] {
            let of_root = |root: f64| match metric {
                Metric::RelMse => root * root / (exact * exact + 0.01),
                _ => root,
            };
            // Twice the floor is the least that can be asked for; of nothing any tolerance.
            let tolerance = of_root(2.1 * floor).max(1e-30);
            let target = Target::new(metric, tolerance).pilot(PILOT);
            let until = Until::new(target, Budget::of_samples(100_000));
            for until in [until, until.adaptive()] {
                let mut film = Film::new(5, 3);
                let scheduler = SimpleScheduler::new().variant(Variant::widest());
                let sampling = Sampling::new(1).method(method).seed(7);
                let reached = scheduler
                    .render_until(&camera, kernel, &sampling, &mut film, &until)
                    .expect("a target and a budget");
                let Reached { outcome, estimate, spent, .. } = reached;
                let what = format!("{name} {metric:?} {method:?}: {reached:?}");
                assert_eq!((outcome, spent), (Outcome::Converged, LEAST), "{what}");
                assert!(estimate.high <= of_root(floor) * (1.0 + 1e-6), "{what}");
                for pixel in film.image().pixels() {
                    let off = (f64::from(pixel.x) - exact).abs();
                    assert!(off <= floor, "{what}: {off:e} of {floor:e}");
                }
            }
        }
    }
}

/// A mirror in a white furnace; between mirrors that shine, by the geometric series; light that is only
/// emitted; and a furnace that is black.
#[test]
fn paths_without_variance_converge_at_once() {
    let (white, black) = (sky(1.0), sky(0.0));
    let mirror = |albedo: f32| Paint { mirrored: 1.0, ..paint(albedo) };
    let furnace = Paths {
        dome: &BALL,
        floor: &[],
        paints: [mirror(0.75); 2],
        lights: &[],
        sky: &white,
        options: PathOptions::new(),
        limits: PathLimits::new(2),
    };
    furnace.with(&mut |kernel| assert_certain("a mirror in a furnace", 0.75, kernel));
    for lights in [LightSampling::HitsAlone, LightSampling::LightsAlone] {
        let options = PathOptions { lights, ..PathOptions::new() };
        let alone = Paths { options, ..furnace };
        alone.with(&mut |kernel| assert_certain("with one kind of samples", 0.75, kernel));
    }
    // Rays from outside meet the shining sphere.
    let lamp = [shining_sphere(0.7)];
    let lights: &[AnyLight] = &lamp;
    let glowing = Paint { light: 0, ..paint(0.0) };
    let limits = PathLimits::new(0);
    let lamp = Paths { paints: [glowing; 2], lights, sky: &black, limits, ..furnace };
    lamp.with(&mut |kernel| assert_certain("a lamp", 0.7f32.into(), kernel));
    let dark = Paths { sky: &black, ..furnace };
    dark.with(&mut |kernel| assert_certain("nothing", 0.0, kernel));
}

/// An opaque medium that emits 0.8, wherever light collides in it; and integrals over cells.
#[test]
fn media_without_variance_converge_at_once() {
    let voxels = uneven();
    let grid = medium(&voxels).expect("27 voxels");
    let colors = [(0.0, Vec3::splat(0.8))];
    let dense = TransferFunction::from_extinction(&colors, &[(0.0, 1e6)]).expect("a colour");
    let slab = Volume::new(&grid, dense);
    let black = sky(0.0);
    let opaque = Media {
        volume: &slab,
        emits: true,
        anisotropy: 0.0,
        dome: &[],
        floor: &[],
        paint: paint(0.0),
        lights: &[],
        sky: &black,
        limits: PathLimits::new(4),
    };
    opaque.with(&mut |kernel| assert_certain("an opaque slab", 0.8f32.into(), kernel));
    with_opacity(&slab, false, &mut |kernel| assert_certain("an opaque slab's cells", 1.0, kernel));

    // P-V1's slab.
    let unit = GridConfig::new().origin(Vec3::splat(-0.5));
    let grid = Grid::new(&[1.0f32; 8][..], uvec3(2, 2, 2), unit).expect("eight voxels");
    let thin = TransferFunction::from_extinction(&colors, &[(0.0, 2.5)]).expect("a colour");
    let exact = 1.0 - (-2.5f64).exp();
    with_opacity(&Volume::new(&grid, thin), false, &mut |kernel| {
        assert_certain("the cells of a slab", exact, kernel);
    });
}
