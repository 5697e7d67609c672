use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut i = 1u8; //~ macro
    let y = x.sin(); //~ macro
    let z = 2.0f64; //~ macro
    println!("{y}"); //~ macro
    for j in 0.. { //~ macro
        i += j;
    }
    y
}

fn main() {}
