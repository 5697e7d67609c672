use raydsl::kernel;
use raydsl::prelude::*;

#[primitive(parallelogram(corner, u_edge, v_edge))] //~ macro
struct Lamp {
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
}

#[primitive(circle(center, normal, radius))] //~ macro
struct Coin {
    center: Vec3,
    normal: Vec3,
    radius: f32,
}

#[primitive(cube(low, high))] //~ macro
struct Box {
    low: Vec3,
    high: Vec3,
}

fn main() {}
