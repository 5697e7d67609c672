use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    fn half(x: f32) -> f32 { //~ macro
        x * 0.5
    }
    half(x)
}

fn main() {}
