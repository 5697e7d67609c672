use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x: f32, n: u32| {
        x * n //~ rustc 2
    });
    k.wgsl();
}
