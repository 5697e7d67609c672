//! One picture of 16 by 16 texels, read by four filters. Learn here how textures are made and read
//! in a kernel, how a mask tells which hits count, and what levels of detail do to a floor.
//!
//! `cargo run --release --example textures -- FOLDER` writes `textures.png` to FOLDER (`out` if
//! none is given): nearest, linear, B-spline and Catmull-Rom from left to right.

mod scene;

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::texture::{Address, AsTextureRef, ColorSpace, Filter, LevelFilter};
use raydsl_examples::picture::smooth_frame;
use scene::{flower, panes, shade, tiles};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;

    // ANCHOR: textures
    let config = TextureConfig::new().color_space(ColorSpace::Srgb);
    let petals = Texture2::new(flower(), [16, 16], config)?;
    // The same texels, read in four ways; outside of them is nothing.
    let read_by =
        |filter| petals.as_texture_ref().with_config(config.border(Vec4::ZERO).filter(filter));
    let (nearest, linear) = (read_by(Filter::Nearest), read_by(Filter::Linear));
    let (spline, catmull_rom) = (read_by(Filter::BSpline), read_by(Filter::CatmullRom));

    let trilinear = config.address(Address::Wrap).level_filter(LevelFilter::Linear);
    let floor = Texture2::new(tiles(), [32, 32], trilinear)?.with_levels()?;
    // ANCHOR_END: textures

    let panes = panes();
    let bvh = Bvh::build(&panes)?;
    let sun = vec3(-0.35, 0.8, -0.75).normalize();
    let camera = Pinhole::new(vec3(0.0, 1.45, 6.0), vec3(0.0, 0.72, 0.0), Vec3::Y, 0.4);
    let primary = kernel!(|ray: Ray| {
        shade(&bvh, &nearest, &linear, &spline, &catmull_rom, &floor, sun, ray)
    });
    let image = smooth_frame(Variant::widest(), &camera, &primary, (960, 400))?;
    let path = folder.join("textures.png");
    image.write_png(&path)?;
    println!("{}", path.display());
    Ok(())
}
