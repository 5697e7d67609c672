use raydsl::prelude::*;

#[derive(RayQuery)]
struct World<'a, const N: usize> { //~ macro
    triangles: Bvh<'a, Triangle>,
    #[table]
    rows: &'a [[f32; N]],
}

fn main() {}
