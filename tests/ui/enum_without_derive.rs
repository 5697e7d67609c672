// An enum that is no type of kernels: one error, not one at each of its uses.
use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
enum Shape {
    Ball(Vec3, f32),
    Slab { height: f32, thickness: f32 },
    Nothing,
}

#[kernel]
fn distance(shape: Shape, point: Vec3) -> f32 { //~ lifted
    match shape {
        Shape::Ball(center, radius) => (point - center).length() - radius,
        Shape::Slab { height, thickness } => (point.y - height).abs() - thickness,
        Shape::Nothing => f32::INFINITY,
    }
}

fn main() {}
