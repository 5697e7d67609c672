//! Coverage of volumes, in media whose light is known.

use std::f64::consts::PI;

use glam::DVec3;
use raydsl::integrators::{PathLimits, PathOptions, volume_path};
use raydsl::kernel;
use raydsl::light::{AnyLight, DirectionalLight, Environment, Lights, PointLight};
use raydsl::prelude::*;
use raydsl::render::Metric;
use raydsl::volume::{
    Collision, ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight, collision,
    ratio_transmittance,
};
use raydsl_tests::transport::{
    BALL, Ball, Dome, FLOOR, Paint, Plate, cube, medium, murk, paint, shining_sphere,
};

use crate::coverage::{CLAIMED, Estimator, Known, Runs, Table};
use crate::paths::sky;

/// The part of a ray that is in the unit sphere.
#[kernel]
fn in_ball(ray: Ray) -> Ray {
    let (o, d) = (ray.origin, ray.direction);
    let (square, along) = (d.dot(d), o.dot(d));
    let root = max(along * along - square * (o.dot(o) - 1.0), 0.0).sqrt();
    let begin = max(ray.t_min, (-along - root) / square);
    let end = min(ray.t_max, (root - along) / square);
    ray.with_range(begin, max(begin, end))
}

/// A medium in the unit sphere, and what paths through it meet.
#[derive(Clone, Copy)]
pub(crate) struct Media<'a> {
    pub(crate) volume: &'a Volume<'a, f32>,
    /// Whether the medium emits its colour, or scatters it.
    pub(crate) emits: bool,
    pub(crate) anisotropy: f32,
    pub(crate) dome: &'a [Ball],
    pub(crate) floor: &'a [Plate],
    pub(crate) paint: Paint,
    pub(crate) lights: &'a [AnyLight],
    pub(crate) sky: &'a Environment,
    pub(crate) limits: PathLimits,
}

impl Media<'_> {
    /// Hands the kernel to `f`: one for all cases, as each of its own takes rustc half a minute.
    pub(crate) fn with(&self, f: &mut dyn FnMut(&Estimator<'_>)) {
        let &Self { volume, emits, anisotropy, dome, floor, paint, lights, sky, limits } = self;
        let scene = Dome { dome, floor };
        let lights = Lights::new(lights, cube()).expect("finite powers").with_environment(sky);
        let options = PathOptions::new();
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            volume_path::<_, _, Paint>(
                &scene,
                |_hit: Hit, _point: ShadingPoint| paint,
                |ray: Ray, rng: Rng| {
                    let mut rng = rng;
                    let met = collision(volume, anisotropy, in_ball(ray), &mut rng);
                    let none = vec3(0.0, 0.0, 0.0);
                    let emission = if emits { met.albedo } else { none };
                    Collision { emission, albedo: if emits { none } else { met.albedo }, ..met }
                },
                |ray: Ray, rng: Rng| {
                    let mut rng = rng;
                    ratio_transmittance(volume, in_ball(ray), &mut rng)
                },
                &lights,
                host(options),
                limits,
                ray,
                sampler,
            )
            .color
            .x
        });
        f(&kernel);
    }
}

/// Hands the kernel of the integrals over cells to `f`: opacity, of all of the grid or of what is in
/// the unit sphere.
pub(crate) fn with_opacity(
    volume: &Volume<'_, f32>,
    is_ball: bool,
    f: &mut dyn FnMut(&Estimator<'_>),
) {
    let exact = ExactCell::new().least(0.0);
    let kernel = kernel!(|ray: Ray, _sampler: Sampler| {
        let ray = if is_ball { in_ball(ray) } else { ray };
        volume.integrate(&exact, ray, VolumeLight::new()).opacity()
    });
    f(&kernel);
}

/// 27 voxels from 0 to below 1.
pub(crate) fn uneven() -> Vec<f32> {
    let mut rng = Rng::new(uvec2(3, 5), 0, 1);
    (0..27).map(|_| rng.next_f32()).collect()
}

/// The integral of a function by the midpoint rule.
fn integral(length: f64, f: impl Fn(f64) -> f64) -> f64 {
    const N: u32 = 20_000;
    let step = length / f64::from(N);
    (0..N).map(|i| f((f64::from(i) + 0.5) * step)).sum::<f64>() * step
}

/// The extinction at a point of the medium: 0.2, and 2.8 times the trilinear value of the voxels.
fn extinction(voxels: &[f32], p: DVec3) -> f64 {
    let corner = |x: usize, y: usize, z: usize| {
        let weight = |p: f64, i: usize| (1.0 - (p - (i as f64 - 1.0)).abs()).max(0.0);
        weight(p.x, x) * weight(p.y, y) * weight(p.z, z) * f64::from(voxels[x + 3 * (y + 3 * z)])
    };
    let all = (0..27).map(|i| corner(i % 3, i / 3 % 3, i / 9));
    0.2 + 2.8 * all.sum::<f64>()
}

/// The transmittance from a point of the unit sphere to its surface.
fn to_surface(voxels: &[f32], from: DVec3, way: DVec3) -> f64 {
    let along = from.dot(way);
    let length = (along * along - from.length_squared() + 1.0).sqrt() - along;
    (-integral(length, |t| extinction(voxels, from + way * t))).exp()
}

/// P-V5: the mean opacity of a sphere of radius 1 and extinction 2 over its disk, in a square around
/// it.
fn sphere_in_square() -> f64 {
    let t = 4.0f64;
    PI / 4.0 * (1.0 - 2.0 * (1.0 - (1.0 + t) * (-t).exp()) / (t * t))
}

fn downwards(height: f32) -> Orthographic {
    Orthographic::new(vec3(0.0, 0.0, 3.0), Vec3::ZERO, Vec3::Y, height)
}

const USUAL: Runs = Runs { random: 0.3, sobol: 0.2, pilot: 64, samples: 200 };
/// Of what has little variance.
const SMOOTH: Runs = Runs { random: 0.03, sobol: 0.006, pilot: 64, samples: 400 };
const FEW: (u32, u32) = (4, 4);

/// P-V5 by collisions and by cells, and P-V12, a wedge.
#[test]
fn the_confidence_of_opacities_is_as_claimed() {
    let mut table = Table::new();
    let even = [9.0 / 14.0; 27];
    let grid = medium(&even).expect("27 voxels");
    let volume = Volume::new(&grid, murk(1.0).expect("white"));
    let (black, jittered) = (sky(0.0), PixelSampler::Jittered);
    let truth = vec![sphere_in_square(); 16];
    let camera = downwards(2.0);
    let disk = Known { camera, pixels: jittered, film: FEW, metric: Metric::Mean, truth };
    let glow = Media {
        volume: &volume,
        emits: true,
        anisotropy: 0.0,
        dome: &[],
        floor: &[],
        paint: paint(0.0),
        lights: &[],
        sky: &black,
        limits: PathLimits::new(1),
    };
    let coarse = Runs { sobol: 0.015, ..SMOOTH };
    glow.with(&mut |kernel| table.row("a sphere by collisions", CLAIMED, coarse, &disk, kernel));
    with_opacity(&volume, true, &mut |kernel| {
        table.row("a sphere by exact cells", CLAIMED, SMOOTH, &disk, kernel);
    });

    // Optical depth goes from 0 to 4 over the film.
    let ramp = [0.0f32, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0];
    let grid = Grid::new(&ramp[..], uvec3(2, 2, 2), GridConfig::new().origin(Vec3::splat(-0.5)));
    let grid = grid.expect("eight voxels");
    let linear = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 0.0), (1.0, 4.0)]);
    let wedge = Volume::new(&grid, linear.expect("white"));
    let mean = |i: u32| 1.0 - (-f64::from(i)).exp() * (1.0 - (-1.0f64).exp());
    let truth = (0..16).map(|i| mean(i % 4)).collect();
    let metric = Metric::Rmse;
    let film = Known { camera: downwards(1.0), pixels: jittered, film: FEW, metric, truth };
    with_opacity(&wedge, false, &mut |kernel| {
        table.row("a wedge by exact cells", CLAIMED, SMOOTH, &film, kernel);
    });
    table.finish();
}

/// In a medium that differs from place to place: a floor in the sun, by ratio tracking; a cavity
/// whose walls shine, where the medium is not seen; and of an even one, light of a lamp that is
/// scattered once.
#[test]
fn the_confidence_of_scattered_light_is_as_claimed() {
    let mut table = Table::new();
    let voxels = uneven();
    let grid = medium(&voxels).expect("27 voxels");
    let black = sky(0.0);
    let (pixels, metric) = (PixelSampler::Center, Metric::Rmse);

    let to_sun = DVec3::new(0.6, 0.0, 0.8);
    let sun = DirectionalLight {
        direction: to_sun.as_vec3(),
        irradiance: Vec3::splat(PI as f32),
        sine: 0.0,
    };
    let at = |i: u32| (f64::from(i) - 1.5) / 4.0;
    let lit = |i: u32| {
        let p = DVec3::new(at(i % 4), at(i / 4), 0.0);
        0.5 * to_sun.z * to_surface(&voxels, p, DVec3::Z) * to_surface(&voxels, p, to_sun)
    };
    let absorbing = Volume::new(&grid, murk(0.0).expect("black"));
    let in_sun = Media {
        volume: &absorbing,
        emits: false,
        anisotropy: 0.0,
        dome: &[],
        floor: &FLOOR,
        paint: paint(0.5),
        lights: &[AnyLight::Directional(sun)],
        sky: &black,
        limits: PathLimits::new(1),
    };
    let truth = (0..16).map(lit).collect();
    let film = Known { camera: downwards(1.0), pixels, film: FEW, metric, truth };
    in_sun.with(&mut |kernel| {
        table.row("a floor in the sun, in smoke", CLAIMED, USUAL, &film, kernel)
    });

    let white = Volume::new(&grid, murk(1.0).expect("white"));
    let cavity = Media {
        volume: &white,
        anisotropy: 0.6,
        dome: &BALL,
        floor: &[],
        paint: Paint { light: 0, ..paint(0.5) },
        lights: &[shining_sphere(0.5)],
        limits: PathLimits { bounces: 400, roulette: 3 },
        ..in_sun
    };
    let camera = Pinhole::new(vec3(0.1, 0.2, 0.0), vec3(0.1, 0.8, 0.8), Vec3::Z, 1.0);
    let film = Known { camera, pixels, film: FEW, metric, truth: vec![1.0; 16] };
    let long = Runs { random: 0.15, sobol: 0.1, ..USUAL };
    cavity.with(&mut |kernel| table.row("a cavity full of smoke", CLAIMED, long, &film, kernel));

    let even = [0.5; 27];
    let even_grid = medium(&even).expect("27 voxels");
    let fog = Volume::new(&even_grid, murk(0.7).expect("grey"));
    let lamp = PointLight { position: Vec3::ZERO, intensity: Vec3::ONE };
    let lights = &[AnyLight::Point(lamp)];
    let once =
        Media { volume: &fog, paint: paint(0.0), lights, limits: PathLimits::new(1), ..cavity };
    let eye = DVec3::new(-0.6, -0.5, 0.0);
    let camera = Pinhole::new(eye.as_vec3(), eye.as_vec3() + Vec3::X, Vec3::Z, 0.6);
    // Looking along x, with z up, the right is -y.
    let edge = f64::from(0.6f32 / 2.0).tan();
    let truth = (0..16).map(|i| {
        let (right, up) = (2.0 * edge * at(i % 4), 2.0 * edge * at(i / 4));
        scattered_once(eye, DVec3::new(1.0, -right, up).normalize())
    });
    let film = Known { camera, pixels, film: FEW, metric, truth: truth.collect() };
    once.with(&mut |kernel| table.row("a lamp in fog", CLAIMED, USUAL, &film, kernel));
    table.finish();
}

/// Light of a lamp at the origin that a medium of extinction 1.6 and albedo 0.7, with a mean cosine of
/// 0.6, scatters once to a point of the unit sphere.
fn scattered_once(eye: DVec3, way: DVec3) -> f64 {
    let (extinction, albedo, g) = (1.6, 0.7, 0.6);
    let along = eye.dot(way);
    let length = (along * along - eye.length_squared() + 1.0).sqrt() - along;
    integral(length, |t| {
        let p = eye + way * t;
        let cos = way.dot(-p) / p.length();
        let phase = (1.0 - g * g) / (4.0 * PI) / (1.0 + g * g - 2.0 * g * cos).powf(1.5);
        extinction * albedo * phase * (-extinction * (t + p.length())).exp() / p.length_squared()
    })
}
