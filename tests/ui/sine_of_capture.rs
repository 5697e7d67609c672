use raydsl::prelude::*;

fn main() {
    let angle = 0.5f32;
    let k = kernel!(|x: f32| x * angle.sin()); //~ lifted
    k.wgsl();
}
