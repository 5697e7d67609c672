//! One closure, a kernel of the library: triangles in the light of a sun and of lamps, of any kind.

use std::error::Error;
use std::fs;

use raydsl::bsdf::Lambert;
use raydsl::integrators::direct_light;
use raydsl::light::{AnyLight, DirectionalLight, Lights, PointLight};
use raydsl::prelude::*;
use raydsl::render::Display;

/// A floor, and a roof over a part of it.
fn quads() -> Vec<Triangle> {
    let quad = |half: f32, y: f32| {
        let [a, b] = [vec3(-half, y, -half), vec3(half, y, -half)];
        let [c, d] = [vec3(-half, y, half), vec3(half, y, half)];
        [Triangle { v0: a, v1: c, v2: b }, Triangle { v0: b, v1: c, v2: d }]
    };
    [quad(4.0, 0.0), quad(0.8, 1.0)].concat()
}

fn main() -> Result<(), Box<dyn Error>> {
    let triangles = quads();
    let scene = Bvh::build(&triangles)?;
    let lamp = |x, intensity| PointLight { position: vec3(x, 2.5, 0.5), intensity };
    let direction = vec3(-0.5, 1.0, -0.4).normalize();
    let list = [
        AnyLight::Point(lamp(-1.0, vec3(9.0, 5.0, 2.0))),
        AnyLight::Point(lamp(1.0, vec3(2.0, 5.0, 9.0))),
        AnyLight::Directional(DirectionalLight {
            direction,
            irradiance: Vec3::splat(0.4),
            sine: 0.0,
        }),
    ];
    let lights = Lights::new(&list, scene.bounds())?;
    let shadows = true;
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |_hit: Hit, point: ShadingPoint| Lambert { color: point.albedo };
        direct_light::<_, _, Lambert>(&scene, surface, &lights, host(shadows), ray, sampler)
    });
    let camera = Pinhole::new(vec3(0.0, 2.0, 3.6), Vec3::ZERO, Vec3::Y, 0.85);
    let mut film = Film::new(640, 400);
    TiledScheduler::new().accumulate(&camera, &kernel, &Sampling::new(4), &mut film, 4);
    let picture = Display::new().show(&film.image());
    let mut bytes = b"P6 640 400 255\n".to_vec();
    for pixel in picture.rows().rev().flatten() {
        bytes.extend(pixel[..3].iter().map(|channel| channel.to_bits()));
    }
    fs::write("lights.ppm", bytes)?;
    Ok(())
}
