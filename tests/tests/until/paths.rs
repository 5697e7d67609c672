//! Coverage of the path tracer, in scenes whose light is known.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use raydsl::integrators::{LightSampling, PathLimits, PathOptions, path_with};
use raydsl::kernel;
use raydsl::light::{AnyLight, DiskShape, Environment, Lights, PointLight, RectangleShape};
use raydsl::prelude::*;
use raydsl::render::Metric;
use raydsl_tests::transport::{BALL, Ball, Dome, FLOOR, Paint, Plate, area, cube, paint};

use crate::coverage::{CLAIMED, Estimator, Known, Runs, Table};

/// What paths are traced through.
#[derive(Clone, Copy)]
pub(crate) struct Paths<'a> {
    pub(crate) dome: &'a [Ball],
    pub(crate) floor: &'a [Plate],
    /// Materials of the dome and of the floor.
    pub(crate) paints: [Paint; 2],
    pub(crate) lights: &'a [AnyLight],
    pub(crate) sky: &'a Environment,
    pub(crate) options: PathOptions,
    pub(crate) limits: PathLimits,
}

impl Paths<'_> {
    /// Hands the kernel to `f`: one for all cases, as each of its own takes rustc half a minute.
    pub(crate) fn with(&self, f: &mut dyn FnMut(&Estimator<'_>)) {
        let &Self { dome, floor, paints, lights, sky, options, limits } = self;
        let scene = Dome { dome, floor };
        let lights = Lights::new(lights, cube()).expect("finite powers").with_environment(sky);
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            let surface = |hit: Hit, _point: ShadingPoint| {
                if hit.inst_id == 0 { paints[0] } else { paints[1] }
            };
            path_with::<_, _, Paint>(&scene, surface, &lights, host(options), limits, ray, sampler)
                .color
                .x
        });
        f(&kernel);
    }
}

pub(crate) fn sky(radiance: f32) -> Environment {
    Environment::constant(Vec3::splat(radiance)).expect("radiance")
}

/// A square of the floor from above, 4 x 4 pixels, of which (1, 1) has its middle at the origin.
fn above() -> Orthographic {
    let eye = vec3(0.125, 0.125, 0.9);
    Orthographic::new(eye, eye - Vec3::Z, Vec3::Y, 1.0)
}

fn known<C>(camera: C, truth: Vec<f64>) -> Known<C> {
    let (pixels, film) = (PixelSampler::Center, (4, 4));
    Known { camera, pixels, film, metric: Metric::Rmse, truth }
}

/// Radiance of a white floor at (x, y) under a square of radiance 1 and edge 2 at height 1: four
/// form factors of a rectangle with a corner above the point. (Howell, "A Catalog of Radiation Heat
/// Transfer Configuration Factors", C-11.)
fn under_square(x: f64, y: f64) -> f64 {
    let corner = |a: f64, b: f64| {
        let (p, q) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / p * (b / p).atan() + b / q * (a / q).atan()) / TAU
    };
    [1.0 - x, 1.0 + x].iter().map(|&a| corner(a, 1.0 - y) + corner(a, 1.0 + y)).sum()
}

/// Columns and rows of a sky with a sun, and the sun's texel.
const SKY: (u32, u32) = (128, 64);
const SUN: (u32, u32) = (37, 10);
const SKY_RADIANCE: f32 = 0.5;
const SUN_RADIANCE: f32 = 2000.0;

fn sunny() -> Environment {
    let mut texels = vec![Vec3::splat(SKY_RADIANCE); (SKY.0 * SKY.1) as usize];
    texels[(SUN.1 * SKY.0 + SUN.0) as usize] = Vec3::splat(SUN_RADIANCE);
    let sky = Environment::new(&texels, uvec2(SKY.0, SKY.1)).expect("radiance");
    sky.rotated(Mat3::from_rotation_x(std::f32::consts::FRAC_PI_2))
}

/// The irradiance that this sky gives: what is bilinear has the mean of a row at its middle, and is
/// linear between rows. By the midpoint rule over angles from the zenith.
fn irradiance_of_sky() -> f64 {
    const N: u32 = 100_000;
    let row_of_sun = (SUN_RADIANCE - SKY_RADIANCE) / SKY.0 as f32;
    let of_row = |angle: f64| {
        let from_sun = (angle / PI * f64::from(SKY.1) - 0.5 - f64::from(SUN.1)).abs();
        f64::from(SKY_RADIANCE) + f64::from(row_of_sun) * (1.0 - from_sun).max(0.0)
    };
    let each = |i: u32| {
        let angle = (f64::from(i) + 0.5) / f64::from(N) * FRAC_PI_2;
        of_row(angle) * angle.cos() * angle.sin()
    };
    TAU * FRAC_PI_2 / f64::from(N) * (0..N).map(each).sum::<f64>()
}

#[test]
fn form_factors_are_those_of_tables() {
    assert!((PI * under_square(0.0, 0.0) - 1.740_839_502_734_206_4).abs() < 1e-12);
    let dark = f64::from(SKY_RADIANCE) * PI;
    assert!(irradiance_of_sky() > 1.5 * dark && irradiance_of_sky() < 3.0 * dark);
}

/// P-GI4 with roulette from the first bounce on, P-GI5, P-D2, and a sky with a small sun: the claimed
/// 95 % are between 93 and 99 % of the seeds.
#[test]
fn the_confidence_of_paths_is_as_claimed() {
    let mut table = Table::new();
    let (black, sunny) = (sky(0.0), sunny());
    let lamp = PointLight { position: Vec3::ZERO, intensity: Vec3::splat(PI as f32) };
    let lamp = [AnyLight::Point(lamp)];
    let paths = Paths {
        dome: &BALL,
        floor: &[],
        paints: [paint(0.5); 2],
        lights: &lamp,
        sky: &black,
        options: PathOptions::new(),
        limits: PathLimits { bounces: 64, roulette: 0 },
    };
    let inside = Pinhole::new(vec3(0.1, 0.2, 0.0), vec3(0.1, 0.8, 0.8), Vec3::Z, 1.0);
    let cavity = known(inside, vec![1.0; 16]);
    let usual = Runs { random: 0.1, sobol: 0.06, pilot: 64, samples: 400 };
    let smooth = Runs { random: 0.03, sobol: 0.015, ..usual };
    paths.with(&mut |kernel| table.row("a lamp in a sphere", CLAIMED, usual, &cavity, kernel));

    // The lower two rows show the floor: there a ray falls by 0.13 of its way or more, and the camera
    // is 0.05 above it.
    let shape = DiskShape { center: Vec3::ZERO, normal: Vec3::Z, radius: 1.0 };
    let shining = [AnyLight::Disk(area(shape, 1.0, false))];
    let eye = vec3(0.0, 0.0, 0.05);
    let (floor, dome) = (1.192_660_550_458_715_6, 0.642_201_834_862_385_3);
    let truth = [[floor; 8], [dome; 8]].concat();
    let under_dome = known(Pinhole::new(eye, eye + Vec3::X, Vec3::Z, 1.0), truth);
    let paints = [paint(0.7), Paint { light: 0, ..paint(0.3) }];
    let limits = PathLimits::new(64);
    let dome = Paths { floor: &FLOOR, paints, lights: &shining, limits, ..paths };
    dome.with(&mut |kernel| {
        table.row("a floor that lights a dome", CLAIMED, usual, &under_dome, kernel)
    });

    // The lamp is no surface, so samples of it alone find it.
    let (corner, u_edge, v_edge) =
        (vec3(-1.0, -1.0, 1.0), vec3(0.0, 2.0, 0.0), vec3(2.0, 0.0, 0.0));
    let square = [AnyLight::Rectangle(area(RectangleShape { corner, u_edge, v_edge }, 1.0, false))];
    let at = |i: u32| (f64::from(i) - 1.0) / 4.0;
    let truth = (0..16).map(|i| under_square(at(i % 4), at(i / 4))).collect();
    let options = PathOptions { lights: LightSampling::LightsAlone, ..PathOptions::new() };
    let open = Paths {
        dome: &[],
        floor: &FLOOR,
        paints: [paint(1.0); 2],
        lights: &square,
        options,
        limits: PathLimits::new(1),
        ..paths
    };
    let floor = known(above(), truth);
    open.with(&mut |kernel| {
        table.row("a square lamp over a floor", CLAIMED, smooth, &floor, kernel)
    });

    let options = PathOptions::new();
    let paints = [paint(0.5); 2];
    let outside = Paths { paints, lights: &[], sky: &sunny, options, ..open };
    let floor = known(above(), vec![0.5 / PI * irradiance_of_sky(); 16]);
    let sunlit = Runs { random: 0.06, sobol: 0.03, ..usual };
    outside
        .with(&mut |kernel| table.row("a sky with a small sun", CLAIMED, sunlit, &floor, kernel));
    table.finish();
}
