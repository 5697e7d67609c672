use raydsl::prelude::*;

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive]
enum Shape {
    Ball(Ball),
    #[cfg(feature = "torus")] //~ macro
    Facet(Triangle),
}

fn main() {}
