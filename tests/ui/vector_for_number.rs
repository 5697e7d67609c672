use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(v: Vec3) -> f32 {
    v //~ rustc 2
}

fn main() {}
