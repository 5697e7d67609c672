use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(sphere(center, radius))] //~ macro
enum Shape {
    Facet(Triangle),
}

fn main() {}
