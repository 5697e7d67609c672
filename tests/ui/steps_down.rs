use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn sum(n: u32) -> u32 {
    let mut sum = 0u32;
    for i in (0..n).rev().step_by(2) { //~ macro
        sum += i;
    }
    sum
}

fn main() {}
