use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    std::cmp::max(n, 2) as f32 * x //~ macro
}

fn main() {}
