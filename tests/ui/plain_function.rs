use raydsl::kernel;
use raydsl::prelude::*;

fn half(x: f32) -> f32 {
    x * 0.5
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    half(x) * n as f32 //~ lifted
}

fn main() {}
