use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn half(x: f32) -> Result<f32, u32> { //~ macro
    if x < 0.0 { Err(1) } else { Ok(x * 0.5) }
}

fn main() {}
