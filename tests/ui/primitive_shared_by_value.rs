use raydsl::prelude::*;

fn main() {
    let vertices = vec![Vec3::ZERO; 3];
    let triangles = [IndexedTriangle { vertices: [0, 1, 2] }];
    let bvh = Bvh::build_sharing(&triangles, vertices, &BuildConfig::default()); //~ rustc
}
