use raydsl::prelude::*;

fn main() {
    let k = kernel!(|a: f32, b: f32, c: f32, d: f32, e: f32, f: f32, g: f32, h: f32, i: f32| a + b + c + d + e + f + g + h + i); //~ macro
    k.wgsl();
}
