// The compile time of ordinary Rust: `first_kernel` without a closure of raydsl. Its body is a
// plain closure, which queries the same tree for one ray after another.

fn main() -> Result<(), Box<dyn Error>> {
    let points = sunflower(2000);
    let bvh = Bvh::build(&points)?;
    let sun = vec3(0.5, 0.7, 0.5).normalize();
    let background = vec3(0.35, 0.55, 0.9);
    let primary = |ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let color = if hit.is_hit {
            let sphere = bvh.primitive(hit);
            let normal = (ray.at(hit.t) - sphere.center).normalize();
            let shadow = Ray {
                origin: ray.at(hit.t) + normal * 0.001,
                direction: sun,
                t_min: 0.0,
                t_max: f32::MAX,
            };
            let mut light = 0.25;
            if normal.dot(sun) > 0.0 && !bvh.any_hit(shadow) {
                light += 0.75 * normal.dot(sun);
            }
            sphere.rgb() * light
        } else {
            background * (1.0 - 0.5 * sky(ray.direction.y + 0.7, 8))
        };
        Shaded { color, depth: hit.t, id: hit.prim_id }
    };
    let camera = Pinhole::new(vec3(0.0, 1.5, 3.6), vec3(0.0, 0.15, 0.0), Vec3::Y, 0.85);
    let rays = camera.begin_frame(640, 400);
    let image =
        Image::from_fn(640, 400, |x, y| primary(rays.primary_ray(x as f32 + 0.5, y as f32 + 0.5)));
    fs::write("plain.ppm", [&b"P6 640 400 255\n"[..], &image.to_rgb8()].concat())?;
    Ok(())
}
