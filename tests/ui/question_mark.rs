use raydsl::kernel;
use raydsl::prelude::*;

fn maybe(x: f32) -> Option<f32> {
    Some(x)
}

#[kernel]
fn shade(x: f32) -> Option<f32> {
    let y = maybe(x)?; //~ macro
    maybe(y)
}

fn main() {}
