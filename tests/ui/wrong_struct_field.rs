use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Cone {
    slope: f32,
    name: &'static str, //~ macro
}

fn main() {}
