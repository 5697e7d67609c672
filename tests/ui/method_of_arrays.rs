use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> f32 {
    let mut xs = [x, 1.0, 2.0];
    xs.fill(x); //~ macro
    xs[0]
}

fn main() {}
