use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(sphere(center))] //~ macro
struct Disk {
    center: Vec3,
    radius: f32,
}

fn main() {}
