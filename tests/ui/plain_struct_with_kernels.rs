use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
struct Cone {
    slope: f32,
}

#[kernel]
impl Cone { //~ lifted 2
    fn twice(&self) -> f32 {
        self.slope * 2.0
    }

    fn new(slope: f32) -> Cone {
        Cone { slope }
    }
}

fn main() {}
