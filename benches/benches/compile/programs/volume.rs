//! A closure that marches through a volume. A transfer function, a texture of one axis, says what
//! colour a density has and how much of it hides what is behind.

use std::error::Error;
use std::fs;

use raydsl::prelude::*;
use raydsl::texture::Address;

const SIDE: u32 = 64;

/// Three shells that melt into each other.
fn shells() -> Vec<Unorm8> {
    let texel = |i: u32| {
        let at = |n: u32| 2.0 * (n as f32 + 0.5) / SIDE as f32 - 1.0;
        let p = vec3(at(i % SIDE), at(i / SIDE % SIDE), at(i / (SIDE * SIDE)));
        let centers = [vec3(0.35, 0.1, 0.0), vec3(-0.35, 0.2, 0.2), vec3(0.0, -0.35, -0.1)];
        Unorm8::new(centers.iter().map(|c| (-9.0 * p.distance_squared(*c)).exp()).sum())
    };
    (0..SIDE * SIDE * SIDE).map(texel).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let config = TextureConfig::new().address(Address::Clamp);
    let density = Texture3::new(shells(), [SIDE; 3], config)?;
    // Red, green, blue and opacity.
    let colors = vec![
        vec4(0.0, 0.0, 0.0, 0.0),
        vec4(0.1, 0.3, 0.9, 0.02),
        vec4(0.2, 0.8, 0.6, 0.0),
        vec4(0.9, 0.7, 0.2, 0.1),
        vec4(0.9, 0.2, 0.1, 0.4),
    ];
    let transfer = Texture1::new(colors, [5], config)?;
    let (step, sun) = (0.02, vec3(0.5, 0.7, 0.5).normalize());
    let kernel = kernel!(|ray: Ray| {
        // The cube from -1 to 1: where the ray enters it and where it leaves.
        let inverse = ray.direction.recip();
        let (a, b) = ((-1.0 - ray.origin) * inverse, (1.0 - ray.origin) * inverse);
        let enter = max(a.min(b).max_element(), 0.0);
        let leave = a.max(b).min_element();
        let mut color = vec3(0.0, 0.0, 0.0);
        let mut clear = 1.0;
        let mut t = enter;
        while t < leave && clear > 0.01 {
            let at = ray.at(t) * 0.5 + 0.5;
            let here = tex3(&density, at);
            let sample = tex1(&transfer, here);
            if sample.w > 0.0 {
                let slope = vec3(
                    here - tex3(&density, at + vec3(0.01, 0.0, 0.0)),
                    here - tex3(&density, at + vec3(0.0, 0.01, 0.0)),
                    here - tex3(&density, at + vec3(0.0, 0.0, 0.01)),
                );
                let light = 0.4 + 0.6 * max(slope.normalize_or_zero().dot(sun), 0.0);
                let share = 1.0 - exp(-40.0 * step * sample.w);
                color += sample.truncate() * (light * share * clear);
                clear *= 1.0 - share;
            }
            t += step;
        }
        Shaded { color: color + vec3(0.05, 0.06, 0.08) * clear, depth: enter, id: 0 }
    });
    let camera = Pinhole::new(vec3(0.6, 1.2, 3.2), Vec3::ZERO, Vec3::Y, 0.7);
    let mut image = Image::new(640, 400);
    TiledScheduler::new().frame(&camera, &kernel, &mut image);
    fs::write("volume.ppm", [&b"P6 640 400 255\n"[..], &image.to_rgb8()].concat())?;
    Ok(())
}
