use raydsl::prelude::*;

fn main() {
    let mut total = 0.0;
    let k = kernel!(|x: f32| {
        total += x; //~ macro
        x
    });
    k.wgsl();
}
