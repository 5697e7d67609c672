use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn drawn<F>(f: F, rng: Rng) -> f32
where
    F: Fn(&mut Rng) -> f32, //~ macro
{
    let mut rng = rng;
    f(&mut rng)
}

fn main() {}
