use raydsl::prelude::*;

struct Scene {
    light: f32,
}

impl Scene {
    fn run(&self) {
        let k = kernel!(|x: f32| x * self.light); //~ macro
        k.wgsl();
    }
}

fn main() {}
