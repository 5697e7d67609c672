use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    assert!(x > 0.0); //~ macro
    x
}

fn main() {}
