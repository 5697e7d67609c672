use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x: f32| {
        x * size //~ rustc
    });
    k.wgsl();
}
