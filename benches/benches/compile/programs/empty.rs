//! A closure of one line: what any first closure costs.

use raydsl::prelude::*;

fn main() {
    let kernel = kernel!(|x: f32| x * 2.0);
    let mut doubled = [0.0; 4];
    kernel.run(Variant::widest(), &[(0.0,), (1.0,), (2.0,), (3.0,)], &mut doubled);
    println!("{doubled:?}");
}
