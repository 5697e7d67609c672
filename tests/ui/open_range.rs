use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut y = x;
    for i in 0u32.. { //~ macro
        if i > n {
            break;
        }
        y *= 0.5;
    }
    y
}

fn main() {}
