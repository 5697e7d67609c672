//! Frame times of an eye, along the path of the head.

use std::time::Duration;

use raydsl::kernel::Variant;
use raydsl::prelude::*;

use crate::frames::{Failure, Hybrid, Times};
use crate::{BETWEEN_EYES, SCREEN, head};

/// Columns of the pictures; rows are as many as the screen's sides ask for.
const COLUMNS: [u32; 8] = [160, 240, 320, 400, 480, 640, 800, 960];
/// Pictures a second that count as interactive.
const INTERACTIVE: f64 = 30.0;

/// Prints a table: medians over the frames of the head and both eyes, by the widest packets.
pub(crate) fn print(hybrid: &Hybrid<'_>, heads: &[Mat4]) -> Result<(), Failure> {
    let variant = Variant::widest();
    println!("\n{}, milliseconds of an eye's picture:\n", variant.name());
    println!("| size | rasteriser | rays | together | pictures a second |");
    println!("|---|---|---|---|---|");
    let aspect = SCREEN.up.length() / SCREEN.right.length();
    let mut largest = None;
    for width in COLUMNS {
        let size = (width, (width as f32 * aspect).round() as u32);
        let mut all = Vec::new();
        for head in heads {
            for eye in head::eyes(*head, BETWEEN_EYES, &SCREEN)? {
                all.push(hybrid.frame(&eye, size, variant)?.1);
            }
        }
        let parts = [0, 1, 2].map(|i| median(all.iter().map(|times| times[i])));
        let whole = median(all.iter().map(|times: &Times| times.iter().sum()));
        let rate = 1.0 / whole.as_secs_f64();
        let [drawn, rays, both] = parts.map(|t| format!("{:.1}", t.as_secs_f64() * 1e3));
        println!("| {} x {} | {drawn} | {rays} | {both} | {rate:.1} |", size.0, size.1);
        if rate >= INTERACTIVE {
            largest = Some(size);
        }
    }
    match largest {
        Some((width, height)) => {
            println!("\n30 a second and more for each eye: {width} x {height}")
        }
        None => println!("\nno size has 30 a second for each eye"),
    }
    Ok(())
}

fn median(times: impl Iterator<Item = Duration>) -> Duration {
    let mut times: Vec<Duration> = times.collect();
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}
