//! Kernels and a small ray tracer, as a new user would write them from the book.
//!
//! They were committed before any of them was compiled, and are as they were then, formatting aside.
//! The first twelve met two walls, which are gone: hits of `S: RayQuery` had no members, for the
//! record was of any type, and `&[Ray]` was no input of a kernel with one parameter. `heights` met
//! the message that a kernel has no `?`; it has now. The ray tracer guessed the constructors of the
//! camera and the images wrongly. The second twelve are in `again`.

#![allow(clippy::all, clippy::pedantic, reason = "the kernels are as they were first written")]

mod again;
mod branches;
mod contours;
mod dimples;
mod heights;
mod histogram;
mod inside;
mod lidar;
mod media;
mod prism;
mod ramp;
mod ray_tracer;
mod shadows;
mod trimmed;

use raydsl::prelude::*;

/// Spheres in rows, over each other.
fn balls() -> Vec<Ball> {
    let at = |i: i32| vec3((i % 5) as f32 - 2.0, (i / 5) as f32 - 2.0, 4.0 + (i % 3) as f32);
    (0..25).map(|i| Ball { center: at(i), radius: 0.4 + 0.05 * (i % 4) as f32 }).collect()
}

/// A sphere.
#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// Rays through the balls, `n` in each direction of the picture.
fn rays(n: i32) -> Vec<Ray> {
    let at = |i: i32| (i as f32 + 0.5) / n as f32 * 6.0 - 3.0;
    let direction = |i: i32| vec3(at(i % n), at(i / n), 5.0).normalize();
    (0..n * n).map(|i| Ray::new(Vec3::ZERO, direction(i))).collect()
}
