//! Balls in a row, by a pinhole and by a lens.

use raydsl::prelude::*;
use raydsl_examples::picture::beside;

/// Samples of each pixel.
const SAMPLES: u32 = 256;

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
    color: Vec3,
}

/// A row of balls that leads away, on ground that is a large ball.
fn row() -> Vec<Ball> {
    let ground =
        Ball { center: vec3(0.0, -1000.0, 0.0), radius: 1000.0, color: vec3(0.75, 0.72, 0.66) };
    let ball = |i: u32| {
        let t = i as f32 / 8.0;
        let center = vec3(1.6 * i as f32 - 5.0, 0.5, -2.2 * i as f32 + 5.0);
        Ball { center, radius: 0.5, color: vec3(0.9 - 0.7 * t, 0.3 + 0.3 * t, 0.2 + 0.6 * t) }
    };
    (0..9).map(ball).chain([ground]).collect()
}

// ANCHOR: film
/// The mean of many samples of each pixel, each with its own point of the pixel and of the lens.
fn mean<C: Camera>(camera: C, kernel: &Kernel<'_, (Ray,), Shaded>) -> Image {
    let mut film = Film::new(400, 300);
    let sampling = Sampling::new(SAMPLES);
    TiledScheduler::new().accumulate(&camera, kernel, &sampling, &mut film, SAMPLES);
    film.image().map(|p| Shaded { color: p.truncate(), ..Shaded::default() })
}
// ANCHOR_END: film

pub(crate) fn picture() -> Result<Image, Box<dyn std::error::Error>> {
    let balls = row();
    let bvh = Bvh::build(&balls)?;
    let sun = vec3(0.5, 0.8, 0.6).normalize();
    let primary = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let mut color = vec3(0.75, 0.85, 1.0);
        if hit.is_hit {
            let ball = bvh.primitive(hit);
            let point = ball.surface_point(ray, hit);
            let is_lit = !bvh.any_hit(point.ray(sun));
            let light = if is_lit { max(point.normal.dot(sun), 0.0) } else { 0.0 };
            color = ball.color * (0.35 + 0.65 * light);
        }
        Shaded { color, depth: hit.t, id: hit.prim_id }
    });
    // ANCHOR: cameras
    let eye = vec3(-3.5, 1.8, 12.0);
    let pinhole = Pinhole::new(eye, vec3(-2.0, 0.4, -2.0), Vec3::Y, 0.62);
    // The third ball is sharp.
    let forward = (pinhole.center - eye).normalize();
    let lens = ThinLens::new(pinhole, 0.3, (balls[2].center - eye).dot(forward));
    // ANCHOR_END: cameras
    Ok(beside(&mean(pinhole, &primary), &mean(lens, &primary)))
}
