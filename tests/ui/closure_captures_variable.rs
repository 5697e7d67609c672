use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn twice(f: impl Fn(f32) -> f32, x: f32) -> f32 {
    f(f(x))
}

#[kernel]
fn shade(x: f32) -> f32 {
    let mut count = 0.0;
    let y = twice(
        |t| {
            count += 1.0; //~ rustc
            t
        },
        x,
    );
    y + count
}

fn main() {}
