use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Cone {
    slope: f32,
}

#[kernel]
impl Cone {
    fn at<T: Copy>(&self, t: T) -> f32 { //~ macro
        self.slope
    }
}

fn main() {}
