use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(v: Vec4) -> f32 {
    v.dot(v) //~ lifted
}

fn main() {}
