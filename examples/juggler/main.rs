//! A figure of spheres juggles mirrors over a chequered floor, as on an Amiga in 1986. Learn here
//! how a tree follows what moves: it is refitted for each frame, and built anew when rays have
//! become too dear.
//!
//! `cargo run --release --example juggler -- FOLDER` writes `juggler.gif`, and a frame of it in
//! `juggler.png`, to FOLDER (`out` if none is given), and says what each frame took.

mod figure;
mod light;

use std::env;
use std::error::Error;
use std::fs::{self, File};
use std::path::PathBuf;
use std::time::Instant;

use figure::{Ball, figure};
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, DynamicImage, Frame, RgbImage};
use light::shade;
use raydsl::bvh::{BuildError, DetachedBvh};
use raydsl::gpu::GpuError;
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::picture::smooth_frame;

const FRAMES: u32 = 24;

/// A tree that rays find this much dearer than a new one is built anew.
const LIMIT: f64 = 1.1;

// ANCHOR: follow
/// The tree over the figure as it is now, from the tree over it as it was; and how much dearer rays
/// would be in that one.
fn follow(tree: DetachedBvh<Ball>, balls: &[Ball]) -> Result<(Bvh<'_, Ball>, f64), Box<dyn Error>> {
    let bvh = tree.refit(balls)?;
    let growth = bvh.cost_growth();
    Ok((if growth > LIMIT { build(balls)? } else { bvh }, growth))
}
// ANCHOR_END: follow

/// Quick to build rather than quick to ask: there are few rays for each tree.
fn build(balls: &[Ball]) -> Result<Bvh<'_, Ball>, BuildError> {
    Bvh::build_with(balls, &BuildQuality::Fast.into())
}

fn animated(image: &Image) -> Option<Frame> {
    let picture = RgbImage::from_raw(image.width(), image.height(), image.to_rgb8())?;
    let picture = DynamicImage::ImageRgb8(picture).into_rgba8();
    Some(Frame::from_parts(picture, 0, 0, Delay::from_numer_denom_ms(40, 1)))
}

fn render(bvh: &Bvh<'_, Ball>, size: (u32, u32)) -> Result<Image, GpuError> {
    let camera = Pinhole::new(vec3(1.7, 2.0, 5.6), vec3(0.05, 1.62, 0.0), Vec3::Y, 0.68);
    let sun = vec3(0.55, 0.75, 0.5).normalize();
    let primary = kernel!(|ray: Ray| shade(bvh, sun, ray));
    smooth_frame(Variant::widest(), &camera, &primary, size)
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    let mut film = GifEncoder::new_with_speed(File::create(folder.join("juggler.gif"))?, 4);
    film.set_repeat(Repeat::Infinite)?;

    // ANCHOR: frames
    let mut balls = figure(0.0);
    let mut bvh = build(&balls)?;
    println!("{} spheres\nframe  tree     ms  growth  render ms", balls.len());
    for frame in 0..FRAMES {
        let tree = bvh.detach();
        balls = figure(frame as f32 / FRAMES as f32);
        let start = Instant::now();
        let (now, growth) = follow(tree, &balls)?;
        let tree_ms = milliseconds(start);

        let start = Instant::now();
        let image = render(&now, (320, 280))?;
        let what = if growth > LIMIT { "built" } else { "refit" };
        let render_ms = milliseconds(start);
        println!("{frame:5}  {what}  {tree_ms:5.3}  {growth:6.3}  {render_ms:9.1}");
        film.encode_frame(animated(&image).ok_or("a picture has three bytes for each pixel")?)?;
        bvh = now;
    }
    // ANCHOR_END: frames

    render(&bvh, (480, 420))?.write_png(folder.join("juggler.png"))?;
    Ok(())
}
