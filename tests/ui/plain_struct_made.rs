use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
struct Cone {
    slope: f32,
}

#[kernel]
fn shade(x: f32) -> f32 {
    let cone = Cone { slope: x }; //~ lifted 2
    cone.slope
}

fn main() {}
