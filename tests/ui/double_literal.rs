use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    x * 2.0f64 as f32 //~ macro
}

fn main() {}
