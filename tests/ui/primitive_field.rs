use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk {
    center: Vec3,
    name: String, //~ macro
}

fn main() {}
