use raydsl::kernel;
use raydsl::prelude::*;

trait Light {
    fn shine(&self) -> f32;
}

#[kernel]
fn shade(light: &dyn Light, x: f32) -> f32 { //~ macro
    x
}

fn main() {}
