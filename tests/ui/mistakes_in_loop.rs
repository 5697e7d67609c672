use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut sum = x;
    for i in 0..8 { //~ macro
        sum += x.sin(); //~ macro
        println!("{sum}"); //~ macro
    }
    sum
}

fn main() {}
