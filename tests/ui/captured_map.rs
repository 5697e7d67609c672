use raydsl::prelude::*;

fn main() {
    let table = std::collections::HashMap::from([(3u32, 1.0f32)]);
    let k = kernel!(|x: f32| {
        x * table[&3] //~ lifted
    });
    k.wgsl();
}
