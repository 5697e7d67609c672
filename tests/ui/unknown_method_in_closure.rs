use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x: f32| {
        x.brighten() //~ rustc 2
    });
    k.wgsl();
}
