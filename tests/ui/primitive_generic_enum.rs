use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(sphere(center, radius))]
struct Disk {
    center: Vec3,
    radius: f32,
}

#[primitive]
enum Shape<T> { //~ macro
    Disk(Disk),
    Other(T),
}

fn main() {}
