use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    f32::sin(x) + f32::exp(x) //~ macro 2
}

fn main() {}
