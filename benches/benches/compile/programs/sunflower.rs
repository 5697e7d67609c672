//! Stands before `first_kernel` and before `plain`: the primitive and the scene of the book's first
//! program.

use std::error::Error;
use std::fs;

use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct ColorSphere {
    center: Vec3,
    radius: Unorm8,
    color: [Unorm8; 3],
}

#[primitive]
impl ColorSphere {
    const SLACK: f32 = sphere::SLACK;

    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius.to_f32())
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius.to_f32())
    }

    fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}

#[kernel]
fn sky(up: f32, bands: u32) -> f32 {
    let mut edge = 1.0;
    for _ in 0..bands {
        edge *= 0.6;
        if up > edge {
            return edge;
        }
    }
    0.0
}

/// Spheres on a round plate, in the pattern of a sunflower, lifted by a wave.
fn sunflower(count: u32) -> Vec<ColorSphere> {
    let golden_angle = std::f32::consts::PI * (3.0 - 5.0f32.sqrt());
    let point = |i: u32| {
        let r = ((i as f32 + 0.5) / count as f32).sqrt();
        let (sin, cos) = (i as f32 * golden_angle).sin_cos();
        let height = 0.25 * (1.0 - r) * (12.0 * r).cos();
        ColorSphere {
            center: vec3(2.0 * r * cos, height, 2.0 * r * sin),
            radius: Unorm8::new(0.05),
            color: [0.9 - 0.6 * r, 0.5 + height, 0.2 + 0.7 * r].map(Unorm8::new),
        }
    };
    (0..count).map(point).collect()
}
