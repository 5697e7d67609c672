use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk { //~ macro
    center: Vec3,
    kind: bool,
    radius: f32,
}

fn main() {}
