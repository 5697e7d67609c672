use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let values = [x, x];
    values.iter().sum() //~ macro
}

fn main() {}
