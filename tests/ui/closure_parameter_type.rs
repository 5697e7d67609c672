use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x| x * 2.0); //~ macro
    k.wgsl();
}
