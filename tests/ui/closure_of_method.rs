use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Wave {
    height: f32,
}

#[kernel]
impl Wave {
    fn bent(&self, bend: impl Fn(f32) -> f32, x: f32) -> f32 {
        bend(self.height * x)
    }
}

#[kernel]
fn shade(wave: Wave, x: f32) -> f32 {
    wave.bent(|y| y * y, x) //~ macro
}

fn main() {}
