use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut y = x;
    let z = &mut y; //~ macro
    *z += 1.0;
    y
}

fn main() {}
