use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
struct Cone {
    slope: f32,
}

#[kernel]
fn shade(cone: Cone) -> f32 { //~ lifted 2
    cone.slope
}

fn main() {}
