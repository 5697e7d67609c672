use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    if n > 0 { shade(x * 0.5, n - 1) } else { x } //~ macro
}

fn main() {}
