//! Rays and a rasteriser in one picture. Learn here how a `Matrix` camera sees what a rasteriser
//! sees, and how pixels of both are put together by their depth in the window.
//!
//! `cargo run --release --example depth_compositing -- [FOLDER] [--rasterizer wgpu|software]`
//! writes `depth_compositing.png` to FOLDER (`out` if none is given): what the rasteriser drew,
//! what rays saw, and both in one.

mod scene;

use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use glam::camera::rh::{proj::directx, view::look_at_mat4};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::{Fragment, composite};
use raydsl_examples::picture::{beside, reduced};
use raydsl_examples::rasterizer::{NOTHING, Rasterizer};
use scene::{bubbles, ribbon};

/// Rays and a rasteriser in one picture.
#[derive(Debug, Parser)]
struct Args {
    /// Folder of the picture.
    #[arg(value_name = "FOLDER", default_value = "out")]
    folder: PathBuf,
    /// What draws the triangles, wgpu or software [default: wgpu where there is a device].
    #[arg(long, value_name = "NAME")]
    rasterizer: Option<String>,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("depth_compositing: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(&args.folder)?;
    let rasterizer = Rasterizer::named(args.rasterizer.as_deref())?;
    println!("rasterizer: {}", rasterizer.place());
    let bubbles = bubbles();
    let bvh = Bvh::build(&bubbles)?;
    let (width, height) = (960, 960);

    // ANCHOR: compositing
    let eye = vec3(0.0, 5.6, 5.6);
    let view = look_at_mat4(eye, vec3(0.0, -0.25, 0.0), Vec3::Y);
    let proj = directx::perspective(0.72, width as f32 / height as f32, 0.5, 50.0);
    let camera = Matrix::new(view, proj, DepthRange::ZERO_TO_ONE)?;

    let drawn = rasterizer.draw(&ribbon(), proj * view, (width, height))?;

    let window = camera.begin_frame(width, height);
    let primary = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if !hit.is_hit {
            return Fragment { color: vec4(0.0, 0.0, 0.0, 0.0), depth: 1.0 };
        }
        let bubble = bvh.primitive(hit);
        let normal = bubble.normal(ray, hit);
        let rim = 1.0 - normal.dot(ray.direction).abs();
        // Thin in the middle: what is behind a bubble is seen through it.
        let alpha = 0.3 + 0.65 * rim * rim;
        let shine = pow(max(normal.dot(vec3(-0.3, 0.87, 0.4)), 0.0), 40.0);
        let color = bubble.color * (0.45 + 0.35 * normal.y) * alpha + shine * 0.8;
        let depth = window.window_depth(ray.at(hit.t));
        Fragment { color: vec4(color.x, color.y, color.z, max(alpha, shine * 0.8)), depth }
    });
    let mut traced = Image::filled(width, height, NOTHING);
    TiledScheduler::new().frame(&camera, &primary, &mut traced);

    let both = Image::from_fn(width, height, |x, y| {
        let at = |image: &Image<Fragment>| image.get(x, y).copied().unwrap_or(NOTHING);
        composite(at(&traced), at(&drawn))
    });
    // ANCHOR_END: compositing
    let paper = vec3(0.93, 0.93, 0.9);
    let [drawn, traced, both] = [drawn, traced, both].map(|image| {
        let over = image.map(|f| Shaded {
            color: f.color.truncate() + paper * (1.0 - f.color.w),
            ..Shaded::default()
        });
        reduced(&over, 3)
    });
    let picture = beside(&beside(&drawn, &traced), &both);
    picture.write_png(args.folder.join("depth_compositing.png"))?;
    Ok(())
}
