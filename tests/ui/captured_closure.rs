use raydsl::kernel;
use raydsl::prelude::*;

fn shade() {
    let half = |x: f32| x * 0.5;
    let k = kernel!(|x: f32| half(x)); //~ lifted
    k.wgsl();
}

fn main() {}
