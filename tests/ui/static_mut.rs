use raydsl::kernel;
use raydsl::prelude::*;

static mut COUNT: u32 = 0;

#[kernel]
fn shade(x: f32) -> f32 {
    COUNT as f32 * x //~ lifted
}

fn main() {}
