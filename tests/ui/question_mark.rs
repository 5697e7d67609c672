use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn root(x: f32) -> Option<f32> {
    if x < 0.0 { None } else { Some(x.sqrt()) }
}

#[kernel]
fn half(x: f32) -> f32 {
    root(x)? * 0.5 //~ rustc 2
}

fn main() {}
