//! One closure, two queries: triangles of the library, with shadows.

use std::error::Error;
use std::fs;

use raydsl::prelude::*;

/// A hilly floor of two triangles a field.
fn hills(side: u32) -> Vec<Triangle> {
    let vertex = |x: u32, z: u32| {
        let (x, z) = (x as f32 / side as f32 - 0.5, z as f32 / side as f32 - 0.5);
        vec3(4.0 * x, 0.3 * (9.0 * x).sin() * (7.0 * z).cos(), 4.0 * z)
    };
    let fields = (0..side).flat_map(|z| (0..side).map(move |x| (x, z)));
    let field = |(x, z): (u32, u32)| {
        let [a, b] = [vertex(x, z), vertex(x + 1, z)];
        let [c, d] = [vertex(x, z + 1), vertex(x + 1, z + 1)];
        [Triangle { v0: a, v1: c, v2: b }, Triangle { v0: b, v1: c, v2: d }]
    };
    fields.flat_map(field).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let triangles = hills(64);
    let bvh = Bvh::build(&triangles)?;
    let lamp = vec3(-1.2, 1.6, -0.8);
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let mut light = 0.0;
        if hit.is_hit {
            let point = bvh.primitive(hit).surface_point(ray, hit);
            let way = lamp - point.position;
            let cosine = point.normal.dot(way.normalize());
            if cosine > 0.0 && !bvh.any_hit(point.ray_to(lamp)) {
                light = 5.0 * cosine / way.length_squared();
            }
        }
        Shaded { color: Vec3::splat(light), depth: hit.t, id: hit.prim_id }
    });
    let camera = Pinhole::new(vec3(0.0, 2.0, 3.6), Vec3::ZERO, Vec3::Y, 0.85);
    let mut image = Image::new(640, 400);
    TiledScheduler::new().frame(&camera, &kernel, &mut image);
    fs::write("triangles.ppm", [&b"P6 640 400 255\n"[..], &image.to_rgb8()].concat())?;
    Ok(())
}
