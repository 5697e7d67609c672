use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    (-n) as f32 //~ rustc 2
}

fn main() {}
