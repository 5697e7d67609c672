//! Pebbles on sand: a picture by a kernel over a primitive of this program's own.
//!
//! `cargo run --release` writes `picture.png`, by packets on all cores; with `--features gpu` the GPU
//! renders it.

mod pebble;
mod scene;

use std::error::Error;

use raydsl::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let pebbles = scene::pebbles(600);
    let bvh = Bvh::build(&pebbles)?;
    let sun = vec3(0.6, 0.5, 0.3).normalize();
    let primary = kernel!(|ray: Ray| scene::shade(&bvh, sun, ray));

    let mut image = Image::new(640, 400);
    #[cfg(feature = "gpu")]
    GpuScheduler::new()?.frame(&scene::camera(), &primary, &mut image)?;
    #[cfg(not(feature = "gpu"))]
    TiledScheduler::new().frame(&scene::camera(), &primary, &mut image);

    image.write_png("picture.png")?;
    println!("wrote picture.png");
    Ok(())
}
