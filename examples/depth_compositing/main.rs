//! Rays and a rasteriser in one picture. Learn here how a `Matrix` camera sees what a rasteriser
//! sees, and how pixels of both are put together by their depth in the window.
//!
//! `cargo run --release --example depth_compositing -- FOLDER` writes `depth_compositing.png` to
//! FOLDER (`out` if none is given): what the rasteriser drew, what rays saw, and both in one.

mod raster;

use std::error::Error;
use std::f32::consts::TAU;
use std::path::PathBuf;
use std::{env, fs};

use glam::camera::rh::{proj::directx, view::look_at_mat4};
use raster::{Corner, draw};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::{Fragment, composite};
use raydsl_examples::picture::{beside, reduced};

#[primitive(sphere(center, radius))]
struct Bubble {
    center: Vec3,
    radius: f32,
    color: Vec3,
}

/// Bubbles along a knot's hollows.
fn bubbles() -> Vec<Bubble> {
    let bubble = |i: u32| {
        let t = i as f32 / 28.0 * TAU;
        let center = knot(t * 2.0 + 0.35) * (0.62 + 0.3 * (5.0 * t).sin());
        let color = 0.5 + 0.45 * vec3(t.sin(), (t + 2.1).sin(), (t + 4.2).sin());
        Bubble { center, radius: 0.34 + 0.16 * (3.0 * t).cos(), color }
    };
    (0..28).map(bubble).collect()
}

/// A knot around a torus: twice around the axis, three times around the ring.
fn knot(t: f32) -> Vec3 {
    let ring = 2.0 + 0.8 * (1.5 * t).cos();
    vec3(ring * t.cos(), 0.8 * (1.5 * t).sin(), ring * t.sin())
}

/// A ribbon along the knot, of two triangles for each step, lit from above.
fn ribbon() -> Vec<[Corner; 3]> {
    let corner = |i: u32, side: f32| {
        let t = i as f32 / 600.0 * 2.0 * TAU;
        let along = (knot(t + 0.01) - knot(t - 0.01)).normalize();
        let across = along.cross(vec3(t.cos() * (1.5 * t).cos(), (1.5 * t).sin(), t.sin()));
        let across = across.normalize();
        let light = 0.35 + 0.6 * across.cross(along).y.abs();
        let stripe =
            if (i / 10).is_multiple_of(2) { vec3(0.95, 0.85, 0.6) } else { vec3(0.55, 0.3, 0.2) };
        Corner { place: knot(t) + across * (0.3 * side), color: stripe * light }
    };
    let step = |i: u32| {
        let [a, b] = [-1.0, 1.0].map(|side| corner(i, side));
        let [c, d] = [-1.0, 1.0].map(|side| corner(i + 1, side));
        [[a, b, c], [c, b, d]]
    };
    (0..600).flat_map(step).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    let bubbles = bubbles();
    let bvh = Bvh::build(&bubbles)?;
    let nothing = Fragment { color: Vec4::ZERO, depth: 1.0 };
    let (width, height) = (960, 960);

    // ANCHOR: compositing
    let eye = vec3(0.0, 5.6, 5.6);
    let view = look_at_mat4(eye, vec3(0.0, -0.25, 0.0), Vec3::Y);
    let proj = directx::perspective(0.72, width as f32 / height as f32, 0.5, 50.0);
    let camera = Matrix::new(view, proj, DepthRange::ZERO_TO_ONE)?;

    let mut drawn = Image::filled(width, height, nothing);
    draw(&ribbon(), proj * view, &mut drawn);

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
    let mut traced = Image::filled(width, height, nothing);
    TiledScheduler::new().frame(&camera, &primary, &mut traced);

    let both = Image::from_fn(width, height, |x, y| {
        let at = |image: &Image<Fragment>| image.get(x, y).copied().unwrap_or(nothing);
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
    picture.write_png(folder.join("depth_compositing.png"))?;
    Ok(())
}
