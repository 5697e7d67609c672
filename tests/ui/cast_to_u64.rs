use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> f32 {
    (x as u64) as f32 //~ macro
}

fn main() {}
