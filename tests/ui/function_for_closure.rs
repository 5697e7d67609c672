use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn twice(f: impl Fn(f32) -> f32, x: f32) -> f32 {
    f(f(x))
}

#[kernel]
fn half(x: f32) -> f32 {
    0.5 * x
}

#[kernel]
fn shade(x: f32) -> f32 {
    twice(half, x) //~ lifted
}

fn main() {}
