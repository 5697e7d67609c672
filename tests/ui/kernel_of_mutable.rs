use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn grow(x: &mut f32) {
    *x += 1.0;
}

fn shade() {
    let k = Kernel::of::<grow>(); //~ lifted
}

fn main() {}
