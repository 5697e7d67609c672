use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn change(x: &mut f32) {
    *x += 1.0;
}

#[kernel]
fn shade(x: f32, n: u32) -> f32 {
    let mut t = [x, x];
    change(&mut t[n as usize]); //~ macro
    t[0]
}

fn main() {}
