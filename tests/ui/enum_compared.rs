use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, PartialEq, Type)]
enum Material {
    Glow(Vec3),
    Matte { color: Vec3, roughness: f32 },
    Black,
}

#[kernel]
fn is_same(a: Material, b: Material) -> bool {
    a == b //~ lifted
}

fn main() {}
