//! Scenes and rays.

use std::f32::consts::TAU;

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

/// Two rows of fluted columns under a vault, about 80,000 triangles, and a camera in that hall.
pub fn colonnade() -> (Vec<Triangle>, Pinhole) {
    let mut prims = Vec::new();
    for i in 0..12 {
        for side in [-3.0, 3.0] {
            let foot = vec3(side, 0.0, 3.0 * i as f32);
            patch(&mut prims, 64, 20, |u, v| foot + column(u, v));
        }
    }
    let floor = |u: f32, v: f32| vec3(12.0 * u - 6.0, 0.0, 42.0 * v - 4.0);
    patch(&mut prims, 24, 84, floor);
    let vault = |u: f32, v: f32| {
        let (sin, cos) = (0.5 * TAU * u).sin_cos();
        vec3(-6.0 * cos, 4.0 + 3.0 * sin, 42.0 * v - 4.0)
    };
    patch(&mut prims, 64, 84, vault);
    for side in [-6.0, 6.0] {
        patch(&mut prims, 24, 84, |u, v| vec3(side, 4.0 * u, 42.0 * v - 4.0));
    }
    patch(&mut prims, 8, 8, |u, v| vec3(12.0 * u - 6.0, 7.0 * v, 38.0));
    let camera = Pinhole::new(vec3(0.6, 1.7, -3.0), vec3(-0.4, 2.2, 20.0), Vec3::Y, 1.05);
    (prims, camera)
}

/// A point of a column's surface: round `u`, up `v`.
fn column(u: f32, v: f32) -> Vec3 {
    let (sin, cos) = (TAU * u).sin_cos();
    let flute = 0.03 * (16.0 * TAU * u).cos();
    let swell = 0.45 - 0.1 * v + 0.25 * (1.0 - 8.0 * v).max(0.0) + 0.25 * (8.0 * v - 7.0).max(0.0);
    vec3((swell + flute) * cos, 4.2 * v, (swell + flute) * sin)
}

/// Adds a grid of `nu` by `nv` quads over the unit square, carried into space by `at`.
pub fn patch(out: &mut Vec<Triangle>, nu: u32, nv: u32, at: impl Fn(f32, f32) -> Vec3) {
    let corner = |i: u32, j: u32| at(i as f32 / nu as f32, j as f32 / nv as f32);
    for (i, j) in (0..nv).flat_map(|j| (0..nu).map(move |i| (i, j))) {
        let (a, b) = (corner(i, j), corner(i + 1, j));
        let (c, d) = (corner(i, j + 1), corner(i + 1, j + 1));
        out.push(Triangle { v0: a, v1: b, v2: d });
        out.push(Triangle { v0: a, v1: d, v2: c });
    }
}
