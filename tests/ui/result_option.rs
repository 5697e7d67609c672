use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> Option<f32> { //~ macro
    find(x)
}

fn find(x: f32) -> Option<f32> {
    Some(x)
}

fn main() {}
