use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
async fn shade(x: f32) -> f32 { //~ macro
    x
}

fn main() {}
