//! What boxes, trees, shapes and grids say of themselves, against plain arithmetic.

mod shapes;
mod trees;
mod volumes;

use raydsl::prelude::*;

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive(cuboid(min, max))]
struct Chest {
    min: Vec3,
    max: Vec3,
}
