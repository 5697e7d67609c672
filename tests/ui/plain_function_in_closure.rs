use raydsl::prelude::*;

fn half(x: f32) -> f32 {
    x * 0.5
}

fn main() {
    let k = kernel!(|x: f32| {
        half(x) //~ lifted
    });
    k.wgsl();
}
