//! Samples: point sets and warps side by side, and a lens that blurs what is out of focus. Learn
//! here how a kernel gets its samples, and how frames add up to a picture.
//!
//! `cargo run --release --example samples -- FOLDER` writes `samples.png` and `lens.png`, pictures
//! of the book's chapters "Sampling" and "Cameras", to FOLDER (`out` if none is given).

mod lens;
mod points;

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    points::picture().write_png(folder.join("samples.png"))?;
    lens::picture()?.write_png(folder.join("lens.png"))?;
    Ok(())
}
