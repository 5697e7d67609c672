use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x: f32| {
        (x as u64) as f32 //~ macro
    });
    k.wgsl();
}
