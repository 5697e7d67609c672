use raydsl::kernel;
use raydsl::prelude::*;

fn first(bvh: &Bvh<'_, Triangle>) {
    let k = kernel!(|ray: Ray| {
        let hits = bvh.hits(ray); //~ lifted
        0u32
    });
    k.wgsl();
}

fn main() {}
