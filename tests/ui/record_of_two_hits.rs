use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type, HitRecord)]
struct Colored {
    first: Hit,
    second: Hit, //~ macro
}

fn main() {}
