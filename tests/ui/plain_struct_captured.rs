use raydsl::prelude::*;

#[derive(Clone, Copy)]
struct Cone {
    slope: f32,
}

fn main() {
    let cone = Cone { slope: 2.0 };
    let k = kernel!(|x: f32| x * cone.slope); //~ lifted
    k.wgsl();
}
