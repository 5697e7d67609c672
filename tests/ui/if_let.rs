use raydsl::kernel;
use raydsl::prelude::*;

fn find(x: f32) -> Option<f32> {
    Some(x)
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    if let Some(y) = find(x) { y } else { 0.0 } //~ macro
}

fn main() {}
