use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade<S: RayQuery<Hit = Hit> + ?Sized>(scene: &S, ray: Ray) -> f32 {
    scene.closest_hit(ray).distance //~ rustc 2
}

fn main() {}
