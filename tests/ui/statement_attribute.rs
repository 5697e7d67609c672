use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    #[cfg(feature = "fog")] //~ macro
    let x = x * 0.5;
    x
}

fn main() {}
