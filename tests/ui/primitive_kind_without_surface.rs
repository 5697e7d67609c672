use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(Surface)] //~ lifted
enum Shape {
    Facet(Triangle),
    Ball(Ball),
}

fn main() {}
