use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    println!("{x}"); //~ macro
    x
}

fn main() {}
