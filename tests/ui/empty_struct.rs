use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Diffuse {} //~ macro

fn main() {}
