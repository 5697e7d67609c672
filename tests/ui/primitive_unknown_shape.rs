use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(ball(center, radius))] //~ macro
struct Disk {
    center: Vec3,
    radius: f32,
}

fn main() {}
