use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
trait Light {
    fn shine(&self, x: f32) -> f32;
}

#[derive(Clone, Copy, Type)]
struct Sun {
    power: f32,
}

impl Light for Sun { //~ rustc
    fn shine(&self, x: f32) -> f32 {
        self.power * x
    }
}

fn main() {}
