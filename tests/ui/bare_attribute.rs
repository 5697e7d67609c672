use raydsl::kernel;
use raydsl::prelude::*;

fn main() {
    let k = #[kernel] //~ rustc 3
    |x: f32| x * 2.0;
    k.wgsl();
}
