use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn half(x: f32) -> f32 {
    x * 0.5
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    half(n) //~ rustc 2
}

fn main() {}
