use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn each<F>(f: F, list: &[f32]) -> f32
where
    F: Fn(&[f32]) -> f32, //~ macro
{
    f(list)
}

fn main() {}
