use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn root(x: f32) -> Option<f32> {
    if x < 0.0 { None } else { Some(x.sqrt()) }
}

#[kernel]
fn shade(x: f32) -> f32 {
    if let Some(a) = root(x) && let Some(b) = root(a) { b } else { 0.0 } //~ macro
}

fn main() {}
