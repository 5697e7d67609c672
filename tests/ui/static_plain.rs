use raydsl::kernel;
use raydsl::prelude::*;

static TABLE: &str = "wall";

#[kernel]
fn shade(x: f32) -> f32 {
    TABLE.len() as f32 * x //~ lifted
}

fn main() {}
