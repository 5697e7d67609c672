use raydsl::prelude::*;

fn main() {
    let v = vec3(1.0, 2.0, 3.0);
    let k = kernel!(|x: f32| {
        let twice = host(v); //~ lifted
        twice.x * x
    });
    k.wgsl();
}
