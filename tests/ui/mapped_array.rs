use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let doubled = [x, x].map(|y| y * 2.0); //~ macro
    doubled[0]
}

fn main() {}
