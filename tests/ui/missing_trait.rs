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

#[kernel]
fn lit<L: Light>(light: L, x: f32) -> f32 {
    light.shine(x)
}

#[kernel]
fn shade(sun: Sun, x: f32) -> f32 {
    lit(sun, x) //~ rustc 2
}

fn main() {}
