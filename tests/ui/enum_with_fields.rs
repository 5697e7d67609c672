use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
enum Shape {
    Point,
    Sphere(f32), //~ macro
}

fn main() {}
