use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade<S: RayQuery<Hit = Hit> + ?Sized>(scene: &S, ray: Ray) -> f32 {
    let hit = scene.closest_hit(ray);
    scene.surface(ray, hit).error //~ rustc 2
}

fn main() {}
