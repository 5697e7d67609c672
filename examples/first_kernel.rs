//! The program of the book's first chapter: spheres of three colours in the sun.
//!
//! `cargo run --release --example first_kernel -- FOLDER` writes `first_kernel.png`, the chapter's
//! picture, and `sky.wgsl` and `first_kernel.wgsl`, the listings of the second chapter, to FOLDER
//! (`out` if none is given).

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

// ANCHOR: imports
use raydsl::kernel;
use raydsl::prelude::*;
// ANCHOR_END: imports

// ANCHOR: struct
#[primitive]
struct ColorSphere {
    center: Vec3,
    radius: Unorm8,
    color: [Unorm8; 3],
}
// ANCHOR_END: struct

// ANCHOR: impl
#[primitive]
impl ColorSphere {
    const SLACK: f32 = sphere::SLACK;

    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius.to_f32())
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius.to_f32())
    }

    fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}
// ANCHOR_END: impl

// ANCHOR: sky
#[kernel]
fn sky(up: f32, bands: u32) -> f32 {
    let mut edge = 1.0;
    for _ in 0..bands {
        edge *= 0.6;
        if up > edge {
            return edge;
        }
    }
    0.0
}
// ANCHOR_END: sky

/// Spheres on a round plate, in the pattern of a sunflower, lifted by a wave.
// ANCHOR: scene
fn sunflower(count: u32) -> Vec<ColorSphere> {
    let golden_angle = std::f32::consts::PI * (3.0 - 5.0f32.sqrt());
    let point = |i: u32| {
        let r = ((i as f32 + 0.5) / count as f32).sqrt();
        let (sin, cos) = (i as f32 * golden_angle).sin_cos();
        let height = 0.25 * (1.0 - r) * (12.0 * r).cos();
        ColorSphere {
            center: vec3(2.0 * r * cos, height, 2.0 * r * sin),
            radius: Unorm8::new(0.05),
            color: [0.9 - 0.6 * r, 0.5 + height, 0.2 + 0.7 * r].map(Unorm8::new),
        }
    };
    (0..count).map(point).collect()
}
// ANCHOR_END: scene

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;

    // ANCHOR: build
    let points = sunflower(2000);
    let bvh = Bvh::build(&points)?;
    // ANCHOR_END: build

    // ANCHOR: kernel
    let sun = vec3(0.5, 0.7, 0.5).normalize();
    let background = vec3(0.35, 0.55, 0.9);
    let primary = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let color = if hit.is_hit {
            let sphere = bvh.primitive(hit);
            let normal = (ray.at(hit.t) - sphere.center).normalize();
            let shadow = Ray {
                origin: ray.at(hit.t) + normal * 0.001,
                direction: sun,
                t_min: 0.0,
                t_max: f32::MAX,
            };
            let mut light = 0.25;
            if normal.dot(sun) > 0.0 && !bvh.any_hit(shadow) {
                light += 0.75 * normal.dot(sun);
            }
            sphere.rgb() * light
        } else {
            background * (1.0 - 0.5 * sky(ray.direction.y + 0.7, 8))
        };
        Shaded { color, depth: hit.t, id: hit.prim_id }
    });
    // ANCHOR_END: kernel

    // ANCHOR: camera
    let camera = Pinhole::new(
        vec3(0.0, 1.5, 3.6),  // where it is
        vec3(0.0, 0.15, 0.0), // what it looks at
        vec3(0.0, 1.0, 0.0),  // which way is up
        0.85,                 // vertical field of view, in radians
    );
    // ANCHOR_END: camera

    // ANCHOR: render
    let mut image = Image::new(640, 400);
    TiledScheduler::new().frame(&camera, &primary, &mut image);
    image.write_png(folder.join("first_kernel.png"))?;
    // ANCHOR_END: render

    // ANCHOR: agree
    let mut scalar = Image::new(640, 400);
    SimpleScheduler::new().frame(&camera, &primary, &mut scalar);
    assert_eq!(scalar, image, "scalar and packets agree in every bit of every pixel");
    // ANCHOR_END: agree

    // ANCHOR: gpu
    match GpuScheduler::new() {
        Ok(gpu) => {
            let mut shown = Image::new(640, 400);
            gpu.frame(&camera, &primary, &mut shown)?;
            let pairs = image.pixels().iter().zip(shown.pixels());
            let different = pairs.filter(|(a, b)| a != b).count();
            println!("{}: {different} pixels differ", gpu.context().adapter_name());
        }
        Err(error) => println!("no GPU: {error}"),
    }
    // ANCHOR_END: gpu

    // ANCHOR: wgsl
    fs::write(folder.join("sky.wgsl"), Kernel::of::<sky>().wgsl())?;
    fs::write(folder.join("first_kernel.wgsl"), primary.wgsl())?;
    // ANCHOR_END: wgsl
    println!("wrote {}", folder.join("first_kernel.png").display());
    Ok(())
}
