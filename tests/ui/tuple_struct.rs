use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Meters(f32); //~ macro

fn main() {}
