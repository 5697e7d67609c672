use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x: f32| {
        let f = (|y: f32| y * 2.0, 1.0); //~ macro
        f.1 * x
    });
    k.wgsl();
}
