use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

fn shade(balls: [Ball; 4]) {
    let k = kernel!(|ray: Ray| balls.closest_hit(ray).t); //~ lifted
    k.wgsl();
}

fn main() {}
