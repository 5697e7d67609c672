use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Cone {
    slope: f32,
}

impl Cone {
    fn height(&self, r: f32) -> f32 {
        r * self.slope
    }
}

#[kernel]
fn shade(cone: Cone, r: f32) -> f32 {
    cone.height(r) //~ lifted
}

fn main() {}
