//! A double helix for two eyes. Learn here how a `Stereo` camera makes a pair of pictures, and how
//! these become one for red-cyan glasses.
//!
//! `cargo run --release --example stereo -- FOLDER` writes `stereo.png` (the pair beside each
//! other, the left eye's at the left) and `anaglyph.png` to FOLDER (`out` if none is given).

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::picture::{beside, reduced};

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
    color: Vec3,
}

/// Two strands of balls around the x axis, which comes out of the screen, and rungs between them.
fn helix() -> Vec<Ball> {
    let mut balls = Vec::new();
    for i in 0..64u32 {
        let t = i as f32 / 63.0;
        let angle = 0.42 * i as f32;
        let middle = vec3(-1.7 + 2.1 * t, 0.35 - 0.4 * t, -8.0 + 9.5 * t);
        let out = vec3(angle.cos(), angle.sin(), 0.0);
        for (side, color) in [(1.0, vec3(0.9, 0.75, 0.45)), (-1.0, vec3(0.5, 0.75, 0.85))] {
            balls.push(Ball { center: middle + out * side, radius: 0.24, color });
            if i % 2 == 0 {
                balls.extend((1..5).map(|k| Ball {
                    center: middle + out * (side * 0.2 * k as f32),
                    radius: 0.09,
                    color: vec3(0.8, 0.8, 0.78),
                }));
            }
        }
    }
    balls
}

/// The light of a point of a surface.
#[kernel]
fn lit(balls: &Bvh<'_, Ball>, sun: Vec3, paint: Vec3, point: SurfacePoint) -> Vec3 {
    let facing = max(point.normal.dot(sun), 0.0);
    let is_dark = facing > 0.0 && balls.any_hit(point.ray(sun));
    let direct = if is_dark { 0.0 } else { facing };
    paint * (0.22 + 0.12 * point.normal.y + 0.8 * direct)
}

/// What an eye sees: balls, and a wall of squares behind them.
#[kernel]
fn seen(balls: &Bvh<'_, Ball>, sun: Vec3, ray: Ray) -> Shaded {
    let hit = balls.closest_hit(ray);
    if hit.is_hit {
        let ball = balls.primitive(hit);
        let color = lit(balls, sun, ball.color, ball.surface_point(ray, hit));
        return Shaded { color, depth: hit.t, id: hit.prim_id };
    }
    let t = (-10.0 - ray.origin.z) / ray.direction.z;
    let at = ray.at(t);
    let square = at.x.floor() as i32 + at.y.floor() as i32;
    let paint = if square & 1 == 0 { vec3(0.62, 0.6, 0.58) } else { vec3(0.45, 0.44, 0.44) };
    let is_dark = balls.any_hit(Ray::new(at, sun));
    Shaded { color: if is_dark { paint * 0.45 } else { paint }, depth: t, id: 0xffff_ffffu32 }
}

// ANCHOR: anaglyph
/// Red from the left eye and cyan from the right one. Red has the left eye's luminance (Rec. 709),
/// or what is blue would be dark for that eye alone.
fn anaglyph(left: &Image, right: &Image) -> Image {
    Image::from_fn(left.width(), left.height(), |x, y| {
        let at = |image: &Image| image.get(x, y).copied().unwrap_or_default();
        let red = at(left).color.dot(vec3(0.2126, 0.7152, 0.0722));
        let Vec3 { y: green, z: blue, .. } = at(right).color;
        Shaded { color: vec3(red, green, blue), ..at(left) }
    })
}
// ANCHOR_END: anaglyph

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    let balls = helix();
    let bvh = Bvh::build(&balls)?;
    let sun = vec3(-0.35, 0.55, 0.75).normalize();
    let kernel = kernel!(|ray: Ray| seen(&bvh, sun, ray));

    // ANCHOR: eyes
    let between = Pinhole::new(vec3(0.0, 0.0, 7.5), vec3(0.0, 0.0, 0.0), Vec3::Y, 0.55);
    // What is 8.5 away is on the screen; a thirtieth of that between the eyes is easy on them.
    let eyes = Stereo::new(between, 8.5 / 30.0, 8.5);
    let [left, right] = [eyes.left(), eyes.right()].map(|eye| {
        let mut image = Image::new(3 * 480, 3 * 400);
        TiledScheduler::new().frame(&eye, &kernel, &mut image);
        reduced(&image, 3)
    });
    // ANCHOR_END: eyes
    beside(&left, &right).write_png(folder.join("stereo.png"))?;
    anaglyph(&left, &right).write_png(folder.join("anaglyph.png"))?;
    Ok(())
}
