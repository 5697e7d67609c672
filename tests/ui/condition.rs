use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    if n { x } else { 0.0 } //~ rustc 2
}

fn main() {}
