//! Cameras at the ends of what they take.

use raydsl::camera::PinholeRays;
use raydsl::prelude::*;
use raydsl_tests::hard_rays::EPS;
use raydsl_tests::hard_rays::wide::{D3, cross, dot, minus, wide};
use raydsl_tests::rng::Rng;

use crate::row::{Bound, Row, Unit};

const EYE: Vec3 = vec3(3.0, 2.0, 5.0);
const CENTER: Vec3 = vec3(-1.0, 0.5, 0.25);

pub(super) fn rows() -> Vec<Row> {
    vec![
        film("field of view of 179.9 degrees", 179.9, (1920, 1200)),
        film("field of view of 0.001 degrees", 0.001, (1920, 1200)),
        film("film of 1x1", 60.0, (1, 1)),
        film("film of 65535x1", 60.0, (65_535, 1)),
        film("film of 1x65535", 60.0, (1, 65_535)),
    ]
}

/// The view in `f64`.
struct View {
    right: D3,
    up: D3,
    forward: D3,
    /// Pixels at distance 1.
    scale: f64,
    size: (u32, u32),
}

impl View {
    fn new(degrees: f32, size: (u32, u32)) -> Self {
        let unit = |v: D3| v.map(|x| x / dot(v, v).sqrt());
        let forward = unit(minus(wide(CENTER), wide(EYE)));
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        let half = 0.5 * f64::from(degrees.to_radians());
        let scale = f64::from(size.1) / (2.0 * half.tan());
        Self { right, up: cross(right, forward), forward, scale, size }
    }

    /// The vector from the eye to a point of the film, at distance 1.
    fn way(&self, x: f32, y: f32) -> D3 {
        let place = |p: f32, size: u32| (f64::from(p) - 0.5 * f64::from(size)) / self.scale;
        let (x, y) = (place(x, self.size.0), place(y, self.size.1));
        std::array::from_fn(|i| self.forward[i] + self.right[i] * x + self.up[i] * y)
    }
}

/// How far the direction is off: in eps, and in eps of the film's longer side where a pixel is wide.
fn film(name: &'static str, degrees: f32, size: (u32, u32)) -> Row {
    Row::new(name, 4, Unit::Times, Bound::all(8.0), move |run| {
        let camera = Pinhole::new(EYE, CENTER, Vec3::Y, degrees.to_radians());
        let (frame, view) = (camera.begin_frame(size.0, size.1), View::new(degrees, size));
        let kernel = kernel!(|rays: PinholeRays, x: f32, y: f32| rays.primary_ray(x, y));
        let make = |rng: &mut Rng| (frame, size.0 as f32 * rng.unit(), size.1 as f32 * rng.unit());
        run.measure(&[kernel], make, |&(_, x, y), ray| {
            let way = view.way(x, y);
            let length = dot(way, way).sqrt();
            let off = minus(wide(ray.direction), way.map(|c| c / length));
            let pixel = 1.0 / (view.scale * length);
            let longer = f64::from(size.0.max(size.1));
            let is_ray = ray.origin == EYE && ray.t_min == 0.0 && ray.t_max == f32::MAX;
            let times = dot(off, off).sqrt() / (EPS * (1.0 + longer * pixel));
            Some(if is_ray { times } else { f64::INFINITY })
        })
    })
}
