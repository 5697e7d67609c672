use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn half(x: f32) -> f32 {
    x * 0.5
}

fn main() {
    let k = kernel!(|n: u32| {
        half(n) //~ rustc 2
    });
    k.wgsl();
}
