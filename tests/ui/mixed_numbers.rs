use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    x * n //~ rustc 2
}

fn main() {}
