use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    #[host]
    let count = n * 2; //~ macro
    x * count as f32
}

fn main() {}
