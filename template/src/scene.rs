//! The scene, and the kernel that computes a pixel.

use raydsl::kernel;
use raydsl::prelude::*;

use crate::pebble::Pebble;

/// Pebbles on the plane `y = 0`, in a sequence that leaves neither clusters nor gaps.
pub fn pebbles(count: u32) -> Vec<Pebble> {
    let pebble = |i: u32| {
        // Additive recurrences: the first two numbers are Roberts's (2018).
        let share = |step: f64| (0.5 + step * f64::from(i)).fract() as f32;
        let (x, z) = (
            share(0.754_877_666_246_692_8),
            share(0.569_840_290_998_053_3),
        );
        let size = 0.08 + 0.22 * share(0.618_033_988_749_894_8).powi(3);
        let flatness = 0.4 + 0.5 * share(0.414_213_562_373_095);
        let radii = vec3(size, size * flatness, size * (0.6 + 0.4 * flatness));
        Pebble {
            center: vec3(10.0 * x - 5.0, 0.6 * radii.y, 12.0 * z - 8.0),
            warmth: share(0.302_775_637_731_995),
            radii,
            albedo: 0.25 + 0.6 * share(0.236_067_977_499_79),
        }
    };
    (0..count).map(pebble).collect()
}

/// A view along the beach.
pub fn camera() -> Pinhole {
    Pinhole::new(vec3(0.0, 1.6, 5.0), vec3(0.0, 0.1, 0.5), Vec3::Y, 0.8)
}

/// The light that comes along `up`, the height of a unit vector, out of the sky.
#[kernel]
fn sky(up: f32) -> Vec3 {
    let low = vec3(0.85, 0.88, 0.92);
    let high = vec3(0.25, 0.45, 0.8);
    low + (high - low) * clamp(up * 2.0, 0.0, 1.0)
}

/// The colour, the depth and the number of the pebble that a ray sees. `sun` is the unit vector
/// towards the sun.
#[kernel]
pub fn shade(pebbles: &Bvh<Pebble>, sun: Vec3, ray: Ray) -> Shaded {
    let hit = pebbles.closest_hit(ray);
    let sand = plane::intersect(ray, Vec3::Y, 0.0);
    let mut t = sand.t;
    let mut albedo = vec3(0.62, 0.52, 0.38);
    let mut normal = Vec3::Y;
    if hit.is_hit && !(sand.is_hit && sand.t < hit.t) {
        let pebble = pebbles.primitive(hit);
        t = hit.t;
        albedo = pebble.color();
        normal = pebble.normal(ray.at(t));
    } else if !sand.is_hit {
        return Shaded {
            color: sky(ray.direction.y),
            depth: hit.t,
            id: hit.prim_id,
        };
    }

    // The sky from above, and the sun where nothing hides it.
    let mut light = vec3(0.35, 0.4, 0.5) * (0.6 + 0.4 * normal.y);
    let towards = normal.dot(sun);
    if towards > 0.0 && !pebbles.any_hit(Ray::new(ray.at(t) + normal * 1e-3, sun)) {
        light += vec3(1.0, 0.92, 0.8) * towards;
    }
    // Haze: far sand fades into the sky.
    let haze = exp(-0.04 * t);
    let color = sky(0.0) + (albedo * light - sky(0.0)) * haze;
    Shaded {
        color,
        depth: t,
        id: hit.prim_id,
    }
}

#[cfg(test)]
mod tests {
    use raydsl::assert_variants_agree;
    use raydsl::prelude::*;

    use super::{pebbles, shade};

    /// Scalar code, packets of 4, 8 and 16 lanes and the WGSL: on the GPU with `--features gpu`,
    /// otherwise it is validated.
    #[test]
    fn all_variants_of_the_picture_agree() {
        let pebbles = pebbles(100);
        let bvh = Bvh::build(&pebbles).expect("pebbles have finite bounds");
        let sun = vec3(0.6, 0.5, 0.3).normalize();
        let kernel = kernel!(|ray: Ray| shade(&bvh, sun, ray));

        let from = vec3(0.0, 1.6, 5.0);
        let rays: Vec<(Ray,)> = (0..4000)
            .map(|i| {
                let to = vec3(0.1 * (i % 80) as f32 - 4.0, 0.05 * (i / 80) as f32, 0.0);
                (Ray::new(from, (to - from).normalize()),)
            })
            .collect();
        let hits = rays.iter().filter(|(ray,)| bvh.any_hit(*ray)).count();
        assert!(hits > 200, "{hits} rays hit a pebble");
        assert_variants_agree!(&kernel, &rays);
    }
}
