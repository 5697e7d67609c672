use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let f = (|y: f32| y * 2.0, 1.0); //~ macro
    f.1 * x
}

fn main() {}
