// A struct that is no type of kernels: one error, at the first place in each signature that names it, or
// at the `impl` of its methods. Within an array it has fields that rustc looks for.
use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[derive(Clone, Copy)]
struct Slab {
    height: f32,
}

#[kernel]
fn apart(a: Ball, b: Ball) -> f32 { //~ lifted 5
    (a.center - b.center).length() - a.radius - b.radius
}

#[kernel]
fn set(slab: &mut Slab, height: f32) {
    slab.height = height;
}

#[kernel]
fn height_of(slab: &mut Slab) -> f32 {
    slab.height
}

#[kernel]
impl Slab {
    fn lift(&mut self) -> f32 {
        self.height += 1.0;
        self.height
    }

    fn of_first(all: [Slab; 2]) -> f32 {
        all[0].height
    }
}

fn main() {}
