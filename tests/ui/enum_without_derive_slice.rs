// An enum that is no type of kernels, in a slice.
use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
enum Shape {
    Slab { height: f32, thickness: f32 },
    Nothing,
}

#[kernel]
fn thickness_of(shapes: &[Shape], i: u32) -> f32 { //~ lifted 2
    match shapes[i as usize] {
        Shape::Slab { thickness, .. } => thickness,
        Shape::Nothing => 0.0,
    }
}

#[kernel]
fn first(shapes: &[Shape]) -> f32 {
    match shapes[0] {
        Shape::Slab { thickness, .. } => thickness,
        Shape::Nothing => 0.0,
    }
}

fn main() {}
