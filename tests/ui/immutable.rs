use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let y = x;
    y += 1.0; //~ rustc
    y
}

fn main() {}
