use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(normal, tangent)] //~ macro
enum Shape {
    Ball(Ball),
    Facet(Triangle),
}

fn main() {}
