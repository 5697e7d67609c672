use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    (0..8).map(|i| i as f32 * x).fold(0.0, |a, b| a + b) //~ macro
}

fn main() {}
