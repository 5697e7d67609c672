use raydsl::kernel;
use raydsl::prelude::*;

fn twice(f: impl Fn(f32) -> f32, x: f32) -> f32 {
    f(f(x))
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    twice(|y: f32| y + 1.0, x) //~ macro
}

fn main() {}
