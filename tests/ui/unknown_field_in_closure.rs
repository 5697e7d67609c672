use raydsl::prelude::*;

fn main() {
    let k = kernel!(|ray: Ray| {
        ray.start.x //~ rustc 8
    });
    k.wgsl();
}
