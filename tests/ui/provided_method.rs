use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
trait Light {
    fn shine(&self, at: f32) -> f32;

    fn twice(&self, at: f32) -> f32 {
        2.0 * self.shine(at)
    }
}

#[derive(Clone, Copy, Type)]
struct Spot {
    power: f32,
}

#[kernel]
impl Light for Spot {
    fn shine(&self, at: f32) -> f32 {
        self.power * at
    }
}

#[kernel]
fn lit(power: f32, at: f32) -> f32 {
    let spot = Spot { power };
    spot.twice(at) //~ lifted
}

fn main() {}
