use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let y = None::<f32>; //~ macro
    x
}

fn main() {}
