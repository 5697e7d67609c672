//! An enum of three shapes: ground of triangles, and posts with a ball on top.

use raydsl::prelude::*;
use raydsl_benches::scenes::Scene;
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes::patch;

use super::Shape;

/// A sphere.
#[primitive(sphere(center, radius))]
pub(crate) struct Ball {
    center: Vec3,
    radius: f32,
}

/// A cylinder with caps.
#[primitive(cylinder(foot, top, radius))]
pub(crate) struct Post {
    foot: Vec3,
    radius: f32,
    top: Vec3,
}

/// What the scene is made of.
#[primitive(normal)]
pub(crate) enum Kind {
    /// A part of the ground.
    Facet(Triangle),
    /// A post.
    Post(Post),
    /// What is on it.
    Ball(Ball),
}

impl Shape for Kind {
    fn normal_at(&self, ray: Ray, hit: Hit) -> Vec3 {
        self.normal(ray, hit)
    }
}

/// Half the width of the ground.
const HALF: f32 = 20.0;
/// Posts, and balls.
const POSTS: usize = 60_000;

/// 300,000 shapes: 180,000 triangles, 60,000 posts and as many balls.
pub(crate) fn kinds() -> Scene<Kind> {
    let mut ground = Vec::new();
    patch(&mut ground, 300, 300, |u, v| height(HALF * (2.0 * u - 1.0), HALF * (2.0 * v - 1.0)));
    let mut prims: Vec<Kind> = ground.into_iter().map(Kind::Facet).collect();
    let mut rng = Rng::new(29);
    for _ in 0..POSTS {
        let foot = height(rng.range(-HALF, HALF), rng.range(-HALF, HALF));
        let top = foot + vec3(rng.range(-0.1, 0.1), rng.range(0.2, 0.7), rng.range(-0.1, 0.1));
        let radius = rng.range(0.01, 0.02);
        prims.push(Kind::Post(Post { foot, radius, top }));
        prims.push(Kind::Ball(Ball { center: top, radius: 3.0 * radius }));
    }
    let eye = height(0.5, HALF - 2.0) + vec3(0.0, 1.6, 0.0);
    Scene { prims, camera: Pinhole::new(eye, vec3(-1.0, 0.0, 0.0), Vec3::Y, 1.0) }
}

/// Hills of two sizes.
fn height(x: f32, z: f32) -> Vec3 {
    let hills = 0.9 * (0.21 * x).sin() * (0.17 * z + 0.4).cos();
    vec3(x, hills + 0.1 * (1.7 * x + 0.3 * z).sin() * (1.3 * z - 0.5 * x).cos(), z)
}
