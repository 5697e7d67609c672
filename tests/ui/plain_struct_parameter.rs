use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
struct Cone {
    slope: f32,
}

#[kernel]
fn shade(cone: Cone) -> f32 { //~ lifted
    cone.slope
}

fn main() {}
