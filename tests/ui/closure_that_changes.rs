use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn each(mut f: impl FnMut(f32) -> f32, x: f32) -> f32 { //~ macro
    f(x) + f(x + 1.0)
}

fn main() {}
