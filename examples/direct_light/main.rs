//! Coloured shadows. Learn here how a primitive of yours says what the kernels of the library ask
//! of it, and how lights are given to them.
//!
//! `cargo run --release --example direct_light -- [FOLDER] [VARIANT]` writes `direct_light.png` to
//! FOLDER (`out` if none is given).

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use raydsl::bsdf::Lambert;
use raydsl::integrators::direct_light;
use raydsl::kernel;
use raydsl::light::{AnyLight, DirectionalLight, Lights, PointLight};
use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl::shading::Surface;

// ANCHOR: surface
/// A ball of one colour. Four bytes leave no gap.
#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
    color: [Unorm8; 4],
}

#[kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}
// ANCHOR_END: surface

/// A ring of balls around a large one, on a ball that is so large that it is a floor.
fn balls() -> Vec<Ball> {
    let ball = |x: f32, y: f32, z: f32, radius: f32, color: [f32; 4]| Ball {
        center: vec3(x, y, z),
        radius,
        color: color.map(Unorm8::new),
    };
    let white = [0.9; 4];
    let mut all = vec![ball(0.0, -2000.0, 0.0, 2000.0, white), ball(0.0, 1.1, 0.0, 1.1, white)];
    for i in 0..14 {
        let share = i as f32 / 14.0;
        let (sin, cos) = (share * std::f32::consts::TAU).sin_cos();
        let hue = |shift: f32| 0.55 + 0.35 * ((share + shift) * std::f32::consts::TAU).cos();
        let radius = 0.25 + 0.1 * (5.0 * share * std::f32::consts::TAU).sin();
        let color = [hue(0.0), hue(1.0 / 3.0), hue(2.0 / 3.0), 0.0];
        all.push(ball(2.3 * cos, radius, 2.3 * sin, radius, color));
    }
    all
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    let variant = match env::args().nth(2) {
        Some(name) => Variant::from_name(&name).ok_or("the variants are scalar, packet4, 8, 16")?,
        None => Variant::widest(),
    };
    let balls = balls();
    let scene = Bvh::build(&balls)?;

    // ANCHOR: light
    let lamp = |x, z, intensity| PointLight { position: vec3(x, 4.5, z), intensity };
    let direction = vec3(-0.5, 1.0, -0.4).normalize();
    let sun = DirectionalLight { direction, irradiance: Vec3::splat(0.35), sine: 0.0 };
    let list = [
        AnyLight::Point(lamp(-3.0, 3.0, vec3(85.0, 8.0, 6.0))),
        AnyLight::Point(lamp(0.0, 4.5, vec3(6.0, 75.0, 10.0))),
        AnyLight::Point(lamp(3.0, 3.0, vec3(6.0, 14.0, 100.0))),
        AnyLight::Directional(sun),
    ];
    let lights = Lights::new(&list, scene.bounds())?;
    let shadows = true;
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        direct_light::<_, _, Lambert>(&scene, surface, &lights, host(shadows), ray, sampler)
    });
    let camera = Pinhole::new(vec3(0.0, 4.4, 8.2), vec3(0.0, 0.55, 0.2), Vec3::Y, 0.62);
    let mut film = Film::new(640, 400);
    let scheduler = TiledScheduler::new().variant(variant);
    scheduler.accumulate(&camera, &kernel, &Sampling::new(16), &mut film, 16);
    Display::new().show(&film.image()).write_png(folder.join("direct_light.png"))?;
    // ANCHOR_END: light
    Ok(())
}
