use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Mix<A, B: Copy> { //~ macro 2
    a: A,
    b: B,
}

#[kernel]
fn shade<A: Type>(mix: Mix<A, f32>) -> f32 {
    mix.b
}

fn main() {}
