use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> f32 {
    let v = ivec3(1, 2, 3);
    length(v) * x //~ rustc 2
}

fn main() {}
