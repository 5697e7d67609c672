use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade<S>(scene: &S, ray: Ray) -> f32 { //~ macro 2
    scene.closest_hit(ray).t
}

fn main() {}
