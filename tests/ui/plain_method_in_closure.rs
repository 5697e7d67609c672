use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Cone {
    slope: f32,
}

impl Cone {
    fn height(&self, r: f32) -> f32 {
        r * self.slope
    }
}

fn main() {
    let cone = Cone { slope: 2.0 };
    let k = kernel!(|r: f32| cone.height(r)); //~ lifted
    k.wgsl();
}
