// An enum that is no type of kernels, as what methods belong to.
use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
enum Shape {
    Ball(Vec3, f32),
    Slab { height: f32, thickness: f32 },
    Nothing,
}

#[kernel]
impl Shape { //~ lifted
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
