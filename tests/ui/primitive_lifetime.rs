use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk<'a> { //~ macro
    center: Vec3,
    radius: &'a f32,
}

fn main() {}
