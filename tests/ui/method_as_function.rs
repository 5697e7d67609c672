use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    f32::min(x, 1.0) + Vec3::dot(Vec3::X, Vec3::Y) //~ macro 2
}

fn main() {}
