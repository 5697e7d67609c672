//! Mirrors, glass and sharp shadows. Learn here how a material is one of several kinds.
//!
//! `cargo run --release --example whitted -- [FOLDER] [VARIANT]` writes `whitted.png` to FOLDER (`out`
//! if none is given).

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use raydsl::bsdf::{Bsdf, BsdfSample, Dielectric, Lambert, Material, Mirror};
use raydsl::integrators::whitted;
use raydsl::kernel;
use raydsl::light::{AnyLight, DirectionalLight, Environment, Lights, PointLight};
use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl::shading::Surface;

/// A ball with the number of its material.
#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
    look: u32,
}

#[kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }

    fn material(&self, _ray: Ray, _hit: Hit) -> u32 {
        self.look
    }
}

// ANCHOR: material
/// A material of one of three kinds.
#[derive(Clone, Copy, Type)]
enum Look {
    Paint(Lambert),
    Mirror(Mirror),
    Glass(Dielectric),
}

#[kernel]
impl Bsdf for Look {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        match *self {
            Look::Paint(b) => Lambert::eval(&b, wo, wi),
            Look::Mirror(b) => Mirror::eval(&b, wo, wi),
            Look::Glass(b) => Dielectric::eval(&b, wo, wi),
        }
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        match *self {
            Look::Paint(b) => Lambert::sample(&b, wo, u),
            Look::Mirror(b) => Mirror::sample(&b, wo, u),
            Look::Glass(b) => Dielectric::sample(&b, wo, u),
        }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match *self {
            Look::Paint(b) => Lambert::pdf(&b, wo, wi),
            Look::Mirror(b) => Mirror::pdf(&b, wo, wi),
            Look::Glass(b) => Dielectric::pdf(&b, wo, wi),
        }
    }
}

#[kernel]
impl Material for Look {}
// ANCHOR_END: material

/// Squares on the floor, which is a ball too.
#[kernel]
fn chequered(look: Look, number: u32, at: Vec3) -> Look {
    let sum = (at.x.floor() + at.z.floor()) * 0.5;
    let is_dark = sum - sum.floor() > 0.25;
    let dark = Look::Paint(Lambert { color: vec3(0.15, 0.18, 0.25) });
    if number == 0 && is_dark { dark } else { look }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    let variant = match env::args().nth(2) {
        Some(name) => Variant::from_name(&name).ok_or("the variants are scalar, packet4, 8, 16")?,
        None => Variant::widest(),
    };
    let looks = [
        Look::Paint(Lambert { color: Vec3::splat(0.75) }),
        Look::Mirror(Mirror { color: vec3(0.95, 0.93, 0.88) }),
        Look::Glass(Dielectric { ior: 1.5, alpha: 0.0, tint: Vec3::ONE }),
        Look::Paint(Lambert { color: vec3(0.8, 0.15, 0.08) }),
        Look::Paint(Lambert { color: vec3(0.1, 0.35, 0.75) }),
    ];
    let ball = |x, y, z, radius, look| Ball { center: vec3(x, y, z), radius, look };
    let balls = [
        ball(0.0, -2000.0, 0.0, 2000.0, 0),
        ball(-1.3, 1.2, -0.6, 1.2, 1),
        ball(1.2, 0.9, 0.9, 0.9, 2),
        ball(-0.6, 0.45, 1.7, 0.45, 3),
        ball(2.6, 0.6, -1.4, 0.6, 4),
        ball(0.7, 0.5, -2.2, 0.5, 3),
    ];
    let scene = Bvh::build(&balls)?;
    let lamp = PointLight { position: vec3(-3.0, 5.0, 4.0), intensity: vec3(60.0, 55.0, 45.0) };
    let direction = vec3(0.6, 0.7, 0.35).normalize();
    let sun = DirectionalLight { direction, irradiance: vec3(1.3, 1.2, 1.0), sine: 0.0 };
    let list = [AnyLight::Point(lamp), AnyLight::Directional(sun)];
    let sky = [vec3(0.25, 0.4, 0.75), vec3(0.75, 0.85, 1.0), vec3(0.2, 0.2, 0.2)];
    let sky = Environment::new(&sky, uvec2(1, 3))?;
    let lights = Lights::new(&list, scene.bounds())?.with_environment(&sky);
    let (shadows, bounces) = (true, 10);
    let looks = &looks[..];
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |_hit: Hit, point: ShadingPoint| {
            chequered(looks[point.material as usize], point.material, point.point.position)
        };
        whitted::<_, _, Look>(&scene, surface, &lights, host(shadows), host(bounces), ray, sampler)
            .truncate()
    });
    let camera = Pinhole::new(vec3(0.4, 2.2, 6.5), vec3(0.2, 0.7, 0.0), Vec3::Y, 0.7);
    let mut film = Film::new(640, 400);
    let scheduler = TiledScheduler::new().variant(variant);
    scheduler.accumulate(&camera, &kernel, &Sampling::new(64), &mut film, 64);
    Display::new().show(&film.image()).write_png(folder.join("whitted.png"))?;
    Ok(())
}
