use raydsl::prelude::*;

#[derive(Clone, Copy, Type, HitRecord)]
struct Leaf {
    hit: Hit,
    alpha: f32,
}

fn main() {
    let triangles = [Triangle { v0: Vec3::ZERO, v1: Vec3::X, v2: Vec3::Y }];
    let bvh = Bvh::build(&triangles).unwrap();
    let k = kernel!(|ray: Ray| bvh.any_hit_where(ray, |leaf: Leaf| leaf.alpha > 0.5)); //~ rustc 2
}
