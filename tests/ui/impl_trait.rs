use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
trait Light {
    fn shine(&self, x: f32) -> f32;
}

#[kernel]
fn shade(light: impl Light, x: f32) -> f32 { //~ macro
    light.shine(x)
}

fn main() {}
