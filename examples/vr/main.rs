//! Virtual reality as a CPU makes it: the pair of a tracked head's eyes before a screen. Learn here
//! how rays and a rasteriser share a picture by depth, both ways, and what a mirror, masks and shadows
//! cost.
//!
//! `cargo run --release --example vr -- [FOLDER] [--head FILE]` writes `vr.png` to FOLDER (`out` if
//! none is given), compares all variants for each eye, and prints frame times. `--help` has the rest.

mod args;
mod drawn;
mod frames;
mod head;
mod light;
#[path = "../leaves/plant.rs"]
mod plant;
#[cfg(test)]
mod tests;
mod times;

use std::error::Error;
use std::fs;
use std::process::ExitCode;

use args::Args;
use clap::Parser;
use frames::{Hybrid, World};
use head::Screen;
use raydsl::kernel::Variants;
use raydsl::prelude::*;
use raydsl::render::Fragment;
use raydsl_examples::picture::{beside, reduced};
use raydsl_examples::rasterizer::Rasterizer;

/// The screen: what is on its plane has no parallax.
const SCREEN: Screen =
    Screen { corner: vec3(-1.7, -0.05, 0.9), right: vec3(3.4, 0.0, 0.0), up: vec3(0.0, 3.06, 0.0) };
/// Distance between the eyes: the plant is a metre high.
const BETWEEN_EYES: f32 = 0.16;
/// Frames of the path that is made in code.
const FRAMES: u32 = 12;

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("vr: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(&args.folder)?;
    let heads = match &args.head {
        Some(file) => head::read(file)?,
        None => head::path(FRAMES),
    };
    let rasterizer = Rasterizer::named(args.rasterizer.as_deref())?;
    let world = World::new();
    let (triangles, colors) = world.for_rays();
    let (plant, drawn) = (Bvh::build(&world.parts)?, Bvh::build(&triangles)?);
    let hybrid = Hybrid {
        world: &world,
        plant: &plant,
        drawn: &drawn,
        colors: &colors,
        rasterizer: &rasterizer,
    };
    println!(
        "{} triangles by {}, {} by rays alone, {} frames of the head",
        triangles.len(),
        rasterizer.place(),
        world.parts.len(),
        heads.len()
    );

    // ANCHOR: pair
    let eyes = head::eyes(heads[0], BETWEEN_EYES, &SCREEN)?;
    let (width, height) = args.size;
    let [left, right] =
        eyes.map(|eye| hybrid.frame(&eye, (2 * width, 2 * height), Variant::widest()));
    // ANCHOR_END: pair
    let shown = |image: &Image<Fragment>| {
        let plain = image.map(|f| Shaded { color: f.color.truncate(), ..Shaded::default() });
        reduced(&plain, 2)
    };
    let picture = args.folder.join("vr.png");
    beside(&shown(&left?.0), &shown(&right?.0)).write_png(&picture)?;
    println!("{}", picture.display());

    for (name, eye) in ["left", "right"].into_iter().zip(&eyes) {
        let variants = Variants::of(&args.variants);
        let found = hybrid.compare(eye, args.size, &variants, args.runs)?;
        println!("\nthe {name} eye, {width} x {height}:\n{}", found.table());
    }
    if !args.no_times {
        times::print(&hybrid, &heads)?;
    }
    Ok(())
}
