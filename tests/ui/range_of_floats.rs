use raydsl::prelude::*;

fn main() {
    let k = kernel!(|x: f32| {
        let mut sum = 0.0;
        for i in 0.0..x { //~ rustc 2
            sum += i;
        }
        sum
    });
    k.wgsl();
}
