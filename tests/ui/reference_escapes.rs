use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(x: f32) -> &f32 { //~ rustc
    &x
}

fn main() {}
