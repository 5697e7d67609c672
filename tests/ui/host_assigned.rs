use raydsl::prelude::*;

fn main() {
    let n = 3u32;
    let k = kernel!(|x: f32| {
        #[host]
        let mut count = host(n);
        if x > 0.0 {
            count = 4; //~ macro
        }
        x * count as f32
    });
    k.wgsl();
}
