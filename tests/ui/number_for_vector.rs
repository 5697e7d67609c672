use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> f32 {
    length(x) //~ rustc 2
}

fn main() {}
