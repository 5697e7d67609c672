use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn twice(f: impl Fn(f32) -> f32, x: f32) -> f32 {
    let g = f; //~ macro
    g(g(x))
}

fn main() {}
