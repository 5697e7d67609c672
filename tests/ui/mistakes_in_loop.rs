use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut sum = x;
    for i in 0..8 {
        println!("{sum}"); //~ macro
        sum += x.sin(); //~ macro
    }
    sum
}

fn main() {}
