use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> f32 {
    x % 2.0 //~ lifted
}

fn main() {}
