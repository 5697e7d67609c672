use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x: f32| {
        let f = |y: f32| y * 2.0; //~ macro
        f(x)
    });
    k.wgsl();
}
