use raydsl::prelude::*;

fn main() {
    let k = kernel!(|ray: Ray| {
        ray.start.x //~ rustc 6
    });
    k.wgsl();
}
