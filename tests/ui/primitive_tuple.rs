use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk(Vec3, f32); //~ macro

fn main() {}
