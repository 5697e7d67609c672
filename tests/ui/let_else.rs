use raydsl::kernel;
use raydsl::prelude::*;

fn find(x: f32) -> Option<f32> {
    Some(x)
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let Some(y) = find(x) else { return 0.0 }; //~ macro
    y
}

fn main() {}
