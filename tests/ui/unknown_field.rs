use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(ray: Ray) -> f32 {
    ray.start.x //~ rustc 2
}

fn main() {}
