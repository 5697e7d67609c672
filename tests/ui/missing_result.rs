use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> f32 { //~ rustc
    x * 2.0;
}

fn main() {}
