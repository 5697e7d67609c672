//! Five small programs, from a pick without a picture to a point cloud: what a user of Visionaray
//! (Zellmann, Wickeroth and Lang, "Visionaray: A Cross-Platform Ray Tracing Template Library",
//! 2017) knows from its listings.
//!
//! `cargo run --release --example listings -- FOLDER` writes `texture.png`, `kinds.png` and
//! `cloud.png` to FOLDER (`out` if none is given).

mod cloud;
mod kinds;
mod menu;
mod texture;
mod width;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

use raydsl::kernel;
use raydsl::prelude::*;

/// A pixel of this colour.
#[kernel]
fn shown(color: Vec3) -> Shaded {
    Shaded { color, depth: 0.0, id: 0 }
}

/// Renders `color` of each ray.
fn picture(
    folder: &Path,
    name: &str,
    camera: &Pinhole,
    color: &Kernel<'_, (Ray,), Shaded>,
) -> Result<(), Box<dyn Error>> {
    let mut image = Image::new(320, 200);
    TiledScheduler::new().frame(camera, color, &mut image);
    let path = folder.join(name);
    image.write_png(&path)?;
    println!("{}", path.display());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;

    let menu = menu::menu(5);
    let wand = Ray::new(Vec3::ZERO, vec3(0.1, 0.25, 2.0));
    println!("the wand points at {:?}", menu::picked(&menu, wand));

    let (texels, grid) = texture::tiles();
    let texels = &texels[..];
    let eye = Pinhole::new(vec3(0.0, 1.5, -4.0), Vec3::ZERO, Vec3::Y, 1.0);
    let tiled = kernel!(|ray: Ray| shown(texture::floor(texels, grid, ray)));
    picture(&folder, "texture.png", &eye, &tiled)?;

    let rays: Vec<(Ray,)> = (0..1000)
        .map(|i| (Ray::new(vec3(0.0015 * i as f32 - 0.75, 0.0, -3.0), Vec3::Z),))
        .collect();
    println!("means of packets and of the function: {:?}", width::means(Variant::Packet8, &rays));

    let shapes = [
        kinds::Shape::Ball(kinds::Ball { center: vec3(-1.0, 0.5, 4.0), radius: 1.0 }),
        kinds::Shape::Facet(Triangle {
            v0: vec3(0.2, -0.5, 3.5),
            v1: vec3(2.2, -0.5, 4.5),
            v2: vec3(1.2, 1.5, 4.0),
        }),
    ];
    let scene = Bvh::build(&shapes)?;
    let plastic = kinds::Plastic { color: vec3(0.8, 0.2, 0.1), exponent: 40.0 };
    let matte = kinds::Matte { color: vec3(0.3, 0.6, 0.8) };
    let front = Pinhole::new(Vec3::ZERO, vec3(0.2, 0.3, 4.0), Vec3::Y, 0.9);
    let light = kinds::Light::Lamp;
    let shaded = kernel!(|ray: Ray| shown(kinds::radiance(&scene, plastic, matte, light, ray)));
    picture(&folder, "kinds.png", &front, &shaded)?;

    let points = cloud::spiral(4000);
    let cloud = Bvh::build(&points)?;
    let seen = kernel!(|ray: Ray| {
        let found = cloud.closest_hit(ray);
        shown(if found.hit.is_hit { found.color } else { Vec3::ONE })
    });
    let above = Pinhole::new(vec3(0.0, 1.5, -3.2), Vec3::ZERO, Vec3::Y, 0.9);
    picture(&folder, "cloud.png", &above, &seen)
}
