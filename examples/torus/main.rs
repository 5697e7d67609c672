//! A primitive of one's own, from the struct to the picture: rings, woven into mail.
//!
//! `cargo run --release --example torus -- FOLDER` writes `torus.png` to FOLDER (`out` if none is
//! given) and says how the variants agree; with `--wgsl` instead it prints the kernel's WGSL.

mod mail;
mod shape;

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use mail::mail;
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::picture::reduced;
use raydsl_report::Compare;

/// What is around: a dark room with a window on the left and a lamp above.
#[kernel]
fn room(d: Vec3) -> Vec3 {
    let window = smooth(0.25, 0.1, (d.x + 0.7).abs()) * smooth(0.35, 0.15, (d.y - 0.5).abs());
    let lamp = smooth(0.75, 0.95, d.y);
    let floor = vec3(0.10, 0.09, 0.10);
    let wall = vec3(0.16, 0.19, 0.25);
    let around = floor + (wall - floor) * smooth(-0.4, 0.6, d.y);
    max(around, max(vec3(1.3, 1.43, 1.69) * window, vec3(1.17, 0.99, 0.81) * lamp))
}

/// 0 at `a` and 1 at `b`, without a kink.
#[kernel]
fn smooth(a: f32, b: f32, x: f32) -> f32 {
    let share = clamp((x - a) / (b - a), 0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

fn main() -> Result<(), Box<dyn Error>> {
    let argument = env::args().nth(1).unwrap_or_else(|| "out".to_owned());

    // ANCHOR: kernel
    let (columns, rows) = (15u32, 12u32);
    let rings = mail(columns as i32, rows as i32);
    let bvh = Bvh::build(&rings)?;
    let sun = vec3(-0.5, 0.75, 0.45).normalize();
    let primary = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if !hit.is_hit {
            let t = -ray.origin.y / ray.direction.y;
            let at = ray.at(t);
            let is_dark = bvh.any_hit(Ray::new(at, sun));
            let far = (at.x * at.x + at.z * at.z) / 900.0;
            let light = (if is_dark { 0.25 } else { 1.0 }) / (1.0 + far);
            return Shaded { color: vec3(0.42, 0.36, 0.31) * light, depth: t, id: 0xffff_ffffu32 };
        }
        let normal = bvh.primitive(hit).normal(ray, hit);
        let at = ray.at(hit.t) + normal * 0.002;
        let (column, row) = (hit.prim_id % columns, hit.prim_id / columns);
        let edge = min(min(column, columns - 1 - column), min(row, rows - 1 - row));
        let metal = if edge < 2 { vec3(0.95, 0.68, 0.3) } else { vec3(0.7, 0.71, 0.74) };
        let mirrored = ray.direction.reflect(normal);
        let mut light = vec3(0.03, 0.03, 0.04);
        if !bvh.any_hit(Ray::new(at, mirrored)) {
            light += room(mirrored);
        }
        if normal.dot(sun) > 0.0 && !bvh.any_hit(Ray::new(at, sun)) {
            light += 0.45 * normal.dot(sun);
            light = max(light, Vec3::splat(2.0 * pow(max(mirrored.dot(sun), 0.0), 60.0)));
        }
        Shaded { color: metal * light, depth: hit.t, id: hit.prim_id }
    });
    // ANCHOR_END: kernel

    // ANCHOR: wgsl
    if argument == "--wgsl" {
        println!("{}", primary.wgsl());
        return Ok(());
    }
    // ANCHOR_END: wgsl

    // ANCHOR: picture
    let folder = PathBuf::from(argument);
    fs::create_dir_all(&folder)?;
    let camera = Pinhole::new(vec3(-8.0, 18.0, 24.0), vec3(0.3, 0.9, 0.2), Vec3::Y, 0.5);
    let mut image = Image::new(1120, 700);
    TiledScheduler::new().frame(&camera, &primary, &mut image);
    reduced(&image, 2).write_png(folder.join("torus.png"))?;
    // ANCHOR_END: picture

    // ANCHOR: compare
    let found = Compare::new().size(320, 200).runs(3).samples(16).run(&primary, &camera);
    println!("{}", found.table());
    // ANCHOR_END: compare
    Ok(())
}
