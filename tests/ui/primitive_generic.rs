use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk<T> { //~ macro
    center: Vec3,
    radius: T,
}

fn main() {}
