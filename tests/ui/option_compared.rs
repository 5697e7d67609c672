use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn is_same(a: Option<f32>, b: Option<f32>) -> bool {
    a != b //~ lifted
}

fn main() {}
