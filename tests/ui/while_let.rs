use raydsl::kernel;
use raydsl::prelude::*;

fn find(x: f32) -> Option<f32> {
    if x > 1.0 { Some(x * 0.5) } else { None }
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut y = x;
    while let Some(z) = find(y) { //~ macro
        y = z;
    }
    y
}

fn main() {}
