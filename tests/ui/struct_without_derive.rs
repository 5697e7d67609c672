// A struct that is no type of kernels.
use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[kernel]
fn distance(ball: Ball, point: Vec3) -> f32 { //~ lifted
    (point - ball.center).length() - ball.radius
}

fn main() {}
