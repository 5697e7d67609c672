use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn twice(f: impl Fn(f32) -> f32, x: f32) -> f32 {
    f(f(x))
}

fn main() {
    let k = Kernel::of::<twice>(); //~ lifted
    k.wgsl();
}
