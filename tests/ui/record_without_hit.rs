use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type, HitRecord)]
struct Colored { //~ macro
    color: Vec3,
}

fn main() {}
