// An enum that is no type of kernels: one error for a function and one for all methods, not one at each of its
// uses.
use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
enum Shape {
    Ball(Vec3, f32),
    Slab { height: f32, thickness: f32 },
    Nothing,
}

#[kernel]
fn distance(shape: Shape, point: Vec3) -> f32 { //~ lifted 2
    match shape {
        Shape::Ball(center, radius) => (point - center).length() - radius,
        Shape::Slab { height, thickness } => (point.y - height).abs() - thickness,
        Shape::Nothing => f32::INFINITY,
    }
}

#[kernel]
impl Shape {
    fn distance(self, point: Vec3) -> f32 {
        match self {
            Self::Ball(center, radius) => (point - center).length() - radius,
            Self::Slab { height, thickness } => (point.y - height).abs() - thickness,
            Self::Nothing => f32::INFINITY,
        }
    }

    fn size(&self) -> f32 {
        match self {
            Self::Ball(_, radius) => *radius,
            Self::Slab { thickness, .. } => *thickness,
            Self::Nothing => 0.0,
        }
    }
}

fn main() {}
