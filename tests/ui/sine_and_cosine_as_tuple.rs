use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let (s, c) = sincos_2pi(x); //~ rustc
    s + c
}

fn main() {}
