use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
trait Noise {
    fn at(x: f32) -> f32;
}

#[derive(Clone, Copy, Type)]
struct White {
    seed: f32,
}

#[kernel]
impl Noise for White {
    fn at(x: f32) -> f32 {
        x * 0.5
    }
}

#[kernel]
fn noise<N: Noise>(x: f32) -> f32 {
    N::at(x)
}

#[kernel]
fn shade(x: f32) -> f32 {
    noise(x) //~ rustc 2
}

fn main() {}
