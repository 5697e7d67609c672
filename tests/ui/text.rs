use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let name = "wall"; //~ macro
    x
}

fn main() {}
