use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Cone {
    slope: f32,
}

impl Cone {
    fn steep(slope: f32) -> Self {
        Cone { slope }
    }
}

#[kernel]
fn shade(x: f32) -> f32 {
    let cone = Cone::steep(x); //~ lifted
    cone.slope
}

fn main() {}
