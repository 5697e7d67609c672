//! Ambient occlusion of a mesh. Learn here how a kernel of the library is used, and how a film
//! collects samples until the picture is good.
//!
//! `cargo run --release --example ambient_occlusion -- [FOLDER] [FILE]` writes
//! `ambient_occlusion.png` to FOLDER (`out` if none is given). FILE is an `.obj`, `.ply` or `.tri`;
//! without one there are blocks. `--explain` in place of FOLDER says how large the kernel's program is.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl_examples::everything::beside_all_surfaces;
use raydsl_examples::{blocks, mesh};

/// Passes over the film, and samples of each pixel in each.
const PASSES: u32 = 4;
const SAMPLES: u32 = 16;
/// Directions that each sample looks in, asked about together.
const DIRECTIONS: usize = 4;

/// Looks at all of `bounds` from above on one side.
fn camera_at(bounds: Aabb) -> Pinhole {
    let size = (bounds.max - bounds.min).length();
    let eye = bounds.center() + vec3(0.45, 0.4, 0.8).normalize() * size * 1.15;
    Pinhole::new(eye, bounds.center(), Vec3::Y, 0.72)
}

fn main() -> Result<(), Box<dyn Error>> {
    let is_explained = env::args().nth(1).as_deref() == Some("--explain");
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    let triangles = match env::args().nth(2) {
        Some(file) => mesh::load(Path::new(&file))?,
        None => blocks::pile(400),
    };
    let mesh = Bvh::build(&triangles)?;
    let bounds = mesh.bounds();
    let radius = 0.25 * (bounds.max - bounds.min).length();
    let camera = camera_at(bounds);
    println!("{} triangles", triangles.len());

    // ANCHOR: kernel
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        ambient_occlusion::<_, DIRECTIONS>(&mesh, radius, ray, sampler)
    });
    // ANCHOR_END: kernel
    if is_explained {
        let features = "triangles, closest and any hit, occlusion, Sobol samples, a camera";
        let sampling = Sampling::new(PASSES * SAMPLES);
        let recording = kernel.record_pass(&camera, &sampling, (640, 400));
        println!("{}", beside_all_surfaces("occlusion", features, recording)?);
        return Ok(());
    }
    fs::create_dir_all(&folder)?;
    // ANCHOR: film
    let mut film = Film::new(640, 400);
    let sampling = Sampling::new(PASSES * SAMPLES);
    for _ in 0..PASSES {
        TiledScheduler::new().accumulate(&camera, &kernel, &sampling, &mut film, SAMPLES);
        let errors = film.standard_error();
        let worst = errors.pixels().iter().map(|p| p.x).fold(0.0, f32::max);
        println!("{:>4} samples: standard error at most {worst:.4}", film.samples());
    }
    let paper = film.image().map(|p| *p + vec4(1.0, 1.0, 1.0, 1.0) * (1.0 - p.w));
    Display::new().show(&paper).write_png(folder.join("ambient_occlusion.png"))?;
    // ANCHOR_END: film
    Ok(())
}
