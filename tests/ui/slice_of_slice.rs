use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(weights: &[f32]) -> f32 {
    let part = &weights[1..3]; //~ macro
    part[0]
}

fn main() {}
