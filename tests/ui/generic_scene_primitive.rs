use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade<S: Scene + ?Sized>(scene: &S, ray: Ray) -> f32 {
    let hit = scene.closest_hit(ray);
    scene.primitive(hit).radius //~ rustc 2
}

fn main() {}
