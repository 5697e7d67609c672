use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> f32 {
    if 0.0 < x < 1.0 { x } else { 0.0 } //~ rustc 2
}

fn main() {}
