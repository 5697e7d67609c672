//! Curved rays: what is seen through two balls whose index of refraction falls from the middle to
//! the surface, and how accurately three integrators follow the rays.
//!
//! `cargo run --release --example luneburg -- FOLDER` writes `luneburg.png` to FOLDER (`out` if
//! none is given), and prints the errors of the integrators and how the variants agree; with
//! `--wgsl` instead it prints the kernel's WGSL. At the left is a Luneburg lens, which focuses
//! parallel light on its surface, at the right Maxwell's fish-eye.

mod accuracy;
mod scene;
mod section;

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::lens::{FishEye, Luneburg, Medium, RungeKutta};
use raydsl_examples::picture::{beside, reduced};
use raydsl_report::Compare;
use scene::{Lens, columns, shade};

/// One of two media, so that a list of lenses has both.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(crate) enum Glass {
    Luneburg(Luneburg),
    FishEye(FishEye),
}

#[kernel]
impl Medium for Glass {
    fn index_squared(&self, at: Vec3) -> f32 {
        match *self {
            Glass::Luneburg(luneburg) => luneburg.index_squared(at),
            Glass::FishEye(fish_eye) => fish_eye.index_squared(at),
        }
    }

    fn force(&self, at: Vec3) -> Vec3 {
        match *self {
            Glass::Luneburg(luneburg) => luneburg.force(at),
            Glass::FishEye(fish_eye) => fish_eye.force(at),
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let argument = env::args().nth(1).unwrap_or_else(|| "out".to_owned());
    let luneburg = Glass::Luneburg(Luneburg { radius: 1.0 });
    let fish_eye = Glass::FishEye(FishEye { radius: 1.0 });

    // ANCHOR: kernel
    let columns = columns();
    let bvh = Bvh::build(&columns)?;
    let lens = |x: f32, medium| Lens { center: vec3(x, 1.0, 0.0), stepper: RungeKutta { medium } };
    let lenses: &[_] = &[lens(-1.15, luneburg), lens(1.15, fish_eye)];
    let sun = vec3(-0.6, 0.62, 0.5).normalize();
    let first = 0.12;
    let primary = kernel!(|ray: Ray| shade(&bvh, lenses, sun, first, ray));
    // ANCHOR_END: kernel

    if argument == "--wgsl" {
        println!("{}", primary.wgsl());
        return Ok(());
    }
    let folder = PathBuf::from(argument);
    fs::create_dir_all(&folder)?;
    let camera = Pinhole::new(vec3(0.0, 2.1, 7.4), vec3(0.0, 1.35, 0.0), Vec3::Y, 0.56);
    let mut view = Image::new(3 * 800, 3 * 600);
    TiledScheduler::new().frame(&camera, &primary, &mut view);
    let section = section::picture(&[luneburg, fish_eye], (3 * 300, 3 * 600))?;
    beside(&reduced(&view, 3), &reduced(&section, 3)).write_png(folder.join("luneburg.png"))?;

    println!("{}", accuracy::table());
    let found = Compare::new().size(320, 240).runs(3).samples(16).run(&primary, &camera);
    println!("{}", found.table());
    Ok(())
}
