use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f64) -> f32 { //~ macro
    1.0
}

fn main() {}
