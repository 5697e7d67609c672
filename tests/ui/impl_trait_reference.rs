use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
trait Light {
    fn shine(&self, at: f32) -> f32;
}

#[kernel]
fn lit(
    light: &impl Light, //~ macro
    at: f32,
) -> f32 {
    light.shine(at)
}

fn main() {}
