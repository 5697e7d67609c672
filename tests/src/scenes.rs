//! Scenes and rays.

use raydsl::prelude::*;

use crate::rng::Rng;

/// A sphere with a colour in 16 bytes.
#[primitive]
#[derive(Debug)]
pub struct ColorSphere {
    /// The centre.
    pub center: Vec3,
    /// The radius.
    pub radius: Unorm8,
    /// Red, green and blue.
    pub color: [Unorm8; 3],
}

#[primitive]
impl ColorSphere {
    const SLACK: f32 = sphere::SLACK;

    /// Where a ray meets the sphere.
    pub fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius.to_f32())
    }

    /// The colour.
    pub fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }

    /// The box around the sphere.
    pub fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius.to_f32())
    }
}

/// Random spheres in the cube `[-5, 5)`.
pub fn spheres(count: usize) -> Vec<ColorSphere> {
    let mut rng = Rng::new(11);
    (0..count)
        .map(|_| ColorSphere {
            center: rng.point(5.0),
            radius: Unorm8::from_bits(rng.below(120) as u8),
            color: [(); 3].map(|()| Unorm8::from_bits(rng.bits() as u8)),
        })
        .collect()
}

/// Random triangles in the cube `[-5, 5)`; some twice, so that equal distances occur.
pub fn triangles(count: usize) -> Vec<Triangle> {
    let mut rng = Rng::new(13);
    let mut all: Vec<Triangle> = Vec::with_capacity(count);
    for i in 0..count {
        if i % 16 == 15 {
            let twin = all[rng.below(i)];
            all.push(twin);
            continue;
        }
        let corner = rng.point(5.0);
        let mut edge = || rng.point(0.6);
        all.push(Triangle { v0: corner, v1: corner + edge(), v2: corner + edge() });
    }
    all
}

/// A random ray for scenes in the cube `[-5, 5)`: from in- or outside, sometimes along an axis,
/// sometimes with a range.
pub fn random_ray(rng: &mut Rng) -> Ray {
    let size = if rng.below(2) == 0 { 5.0 } else { 12.0 };
    let origin = rng.point(size);
    let mut direction = match rng.below(4) {
        0 => rng.direction(),
        _ => rng.point(5.0) - origin,
    };
    if rng.below(16) == 0 {
        direction = rng.pick(&[Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z]);
    }
    let ray = Ray::new(origin, direction);
    match rng.below(8) {
        0 => ray.with_range(rng.range(-0.5, 0.5), rng.range(0.5, 2.0)),
        _ => ray,
    }
}

/// `count` random rays.
pub fn random_rays(seed: u64, count: usize) -> Vec<Ray> {
    let mut rng = Rng::new(seed);
    (0..count).map(|_| random_ray(&mut rng)).collect()
}

/// Rays with a NaN or an infinity somewhere in origin or direction.
pub fn broken_rays() -> Vec<Ray> {
    let mut rays = Vec::new();
    for bad in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for at in 0..6 {
            let mut ray = Ray::new(Vec3::splat(-0.01), vec3(0.9, 1.1, 1.0));
            match at {
                0..3 => ray.origin[at] = bad,
                _ => ray.direction[at - 3] = bad,
            }
            rays.push(ray);
        }
    }
    rays
}
