use raydsl::prelude::*;

fn main() {
    let triangles = [IndexedTriangle { vertices: [0, 1, 2] }];
    let bvh = Bvh::build(&triangles); //~ rustc
}
