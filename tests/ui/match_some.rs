use raydsl::kernel;
use raydsl::prelude::*;

fn find(x: f32) -> Option<f32> {
    Some(x)
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    match find(x) {
        Some(y) => y, //~ macro
        _ => 0.0,
    }
}

fn main() {}
