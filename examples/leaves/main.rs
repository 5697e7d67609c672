//! Leaves cut out of a few triangles by a mask. Learn here how a query is told which hits count, by
//! a closure, and that a captured `bool` costs nothing where it is false.
//!
//! `cargo run --release --example leaves -- FOLDER` writes `leaves.png` to FOLDER (`out` if none is
//! given): the triangles at the left, what the mask leaves of them at the right.

mod light;
mod plant;

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use std::{env, fs};

use light::shade;
use plant::plant;
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::picture::{beside, smooth_frame};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;

    let parts = plant(11);
    let bvh = Bvh::build(&parts)?;
    let lamp = vec3(2.0, 3.4, 4.2);
    let camera = Pinhole::new(vec3(0.0, 1.9, 6.2), vec3(-0.15, 1.2, 0.0), Vec3::Y, 0.44);
    println!("{} triangles", parts.len());

    // ANCHOR: pictures
    let picture = |masked: bool| {
        let start = Instant::now();
        let primary = kernel!(|ray: Ray| shade(&bvh, masked, lamp, ray));
        let image = smooth_frame(Variant::widest(), &camera, &primary, (400, 480));
        println!("masked: {masked}, {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
        image
    };
    beside(&picture(false)?, &picture(true)?).write_png(folder.join("leaves.png"))?;
    // ANCHOR_END: pictures
    Ok(())
}
