use raydsl::prelude::*;

fn main() {
    let triangles = [Triangle { v0: Vec3::X, v1: Vec3::Y, v2: Vec3::Z }];
    let k = kernel!(|ray: Ray| {
        let mut count = 0u32;
        let hits = triangles.any_hit_each::<2>(|i: u32| {
            count += 1; //~ macro
            ray
        });
        if hits[0] { count } else { 0 }
    });
    k.wgsl();
}
