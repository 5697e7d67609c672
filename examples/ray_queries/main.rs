//! Rays without a camera: how much of three lamps is seen from each point of a floor. Learn here
//! how a batch of queries is run, on the CPU or on a device, and that its results are data as well
//! as a picture.
//!
//! `cargo run --release --example ray_queries -- FOLDER` writes `ray_queries.png`, a plan of the
//! floor, to FOLDER (`out` if none is given), and prints a table.

mod rooms;

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use std::{env, fs};

use raydsl::kernel;
use raydsl::prelude::*;
use rooms::{Block, plan};

/// Points of the floor, and how many lie in a unit of its length.
const SIZE: (u32, u32) = (880, 560);
const PER_UNIT: f32 = 40.0;
/// Rays from each point to each lamp.
const RAYS: u32 = 32;

// ANCHOR: query
/// Which share of a ball of light is seen from a point. `index` gives each point numbers of its
/// own.
#[kernel]
fn share_of_lamp(blocks: &Bvh<'_, Block>, lamp: Vec4, point: Vec3, index: u32) -> f32 {
    let mut seen = 0.0;
    for i in 0..RAYS {
        let mut sampler = Sampler::new(uvec2(index, 0), 1, i, RAYS, SampleMethod::Sobol);
        let target = lamp.truncate() + sample_uniform_sphere(sampler.next_2d()) * lamp.w;
        // From 0, the point, to 1, the lamp.
        let way = Ray::new(point, target - point).with_range(0.0, 1.0);
        if !blocks.any_hit(way) {
            seen += 1.0;
        }
    }
    seen / RAYS as f32
}
// ANCHOR_END: query

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    let blocks = plan();
    let bvh = Bvh::build(&blocks)?;

    // ANCHOR: batch
    let place = |i: u32| {
        let (x, y) = (i % SIZE.0, i / SIZE.0);
        vec3(x as f32 + 0.5, y as f32 + 0.5, 0.01 * PER_UNIT) / PER_UNIT
    };
    let points: Vec<(Vec3, u32)> = (0..SIZE.0 * SIZE.1).map(|i| (place(i), i)).collect();
    let lamps = [
        (vec4(14.5, 4.7, 2.2, 0.25), vec3(1.0, 0.72, 0.38)),
        (vec4(3.2, 3.4, 2.2, 0.15), vec3(0.35, 0.75, 0.95)),
        (vec4(18.7, 11.5, 2.2, 0.4), vec3(0.95, 0.4, 0.5)),
    ];
    let mut plan = Image::filled(SIZE.0, SIZE.1, vec4(0.02, 0.02, 0.03, 1.0));
    println!("lamp   lit %   half lit %   dark %   million rays a second");
    for (number, (lamp, color)) in lamps.into_iter().enumerate() {
        let kernel = kernel!(|point: Vec3, index: u32| share_of_lamp(&bvh, lamp, point, index));
        let mut shares = vec![0.0; points.len()];
        let start = Instant::now();
        TiledScheduler::new().batch(&kernel, &points, &mut shares);
        // ANCHOR_END: batch
        let rate = (points.len() as u32 * RAYS) as f64 / start.elapsed().as_secs_f64() / 1e6;
        let percent = |is: &dyn Fn(f32) -> bool| {
            100.0 * shares.iter().filter(|s| is(**s)).count() as f64 / shares.len() as f64
        };
        let (lit, dark) = (percent(&|s| s == 1.0), percent(&|s| s == 0.0));
        println!("{number:4} {lit:7.1} {:12.1} {dark:8.1} {rate:12.1}", 100.0 - lit - dark);
        for ((pixel, (point, _)), share) in plan.pixels_mut().iter_mut().zip(&points).zip(&shares) {
            let way = lamp.truncate() - *point;
            let light = share * way.z / way.length().powi(3) * 2.4;
            *pixel += (color * light).extend(0.0);
        }
    }
    // A point within a block has no light: it is shown as a block.
    let is_solid = |p: Vec3| blocks.iter().any(|b| p.cmpge(b.low).all() && p.cmple(b.high).all());
    for (pixel, _) in plan.pixels_mut().iter_mut().zip(&points).filter(|(_, p)| is_solid(p.0)) {
        *pixel = vec4(0.16, 0.16, 0.18, 1.0);
    }
    raydsl::render::Display::new().show(&plan).write_png(folder.join("ray_queries.png"))?;
    Ok(())
}
