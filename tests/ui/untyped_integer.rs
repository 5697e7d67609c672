use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut i = 0; //~ macro
    i += n;
    x * i as f32
}

fn main() {}
