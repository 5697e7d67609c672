use raydsl::kernel;
use raydsl::prelude::*;

trait Light {
    fn shine(&self, x: f32) -> f32;
}

#[derive(Clone, Copy, Type)]
struct Sun {
    power: f32,
}

impl Light for Sun {
    fn shine(&self, x: f32) -> f32 {
        self.power * x
    }
}

#[kernel]
fn shade(sun: Sun, x: f32) -> f32 {
    sun.shine(x) //~ lifted
}

fn main() {}
