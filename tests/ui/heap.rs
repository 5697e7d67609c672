use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let v = vec![x, x]; //~ macro
    v[0]
}

fn main() {}
