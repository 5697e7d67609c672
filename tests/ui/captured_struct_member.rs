use raydsl::prelude::*;

struct Scene {
    spans: Vec<f32>,
}

fn main() {
    let scene = Scene { spans: vec![1.0, 2.0] };
    let k = kernel!(|i: u32| scene.spans[i as usize]); //~ lifted
    k.wgsl();
}
