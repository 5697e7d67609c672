use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(weights: &[f32]) -> f32 {
    let mut sum = 0.0;
    for w in weights { //~ macro
        sum += w;
    }
    sum
}

fn main() {}
