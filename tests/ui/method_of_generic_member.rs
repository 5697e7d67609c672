use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
trait Light {
    fn shine(&self, at: f32) -> f32;
}

#[derive(Clone, Copy, Type)]
struct Filtered<L: Light> {
    light: L,
    share: f32,
}

#[kernel]
impl<L: Light> Filtered<L> {
    fn shine(&self, at: f32) -> f32 {
        self.light.shine(at) * self.share //~ lifted
    }
}

fn main() {}
