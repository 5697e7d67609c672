use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy)]
enum Material {
    Matte(Vec3),
    Glow { light: Vec3 },
}

#[kernel]
fn shade(material: Material) -> Vec3 {
    match material {
        Material::Matte(color) => color,
        Material::Glow { light } => light,
    }
}

#[kernel]
fn both(materials: &[Material], at: u32) -> Vec3 {
    shade(materials[at as usize]) + shade(Material::Matte(Vec3::ONE))
}

fn main() {}
