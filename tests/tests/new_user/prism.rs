//! Light through glass: refraction or total reflection at each surface. (option, enum with fields,
//! generic scene, bare integers, early return)

use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::{assert_variants_agree, kernel};

#[primitive(sphere(center, radius))]
struct Drop {
    center: Vec3,
    radius: f32,
}

#[kernel]
impl Surface for Drop {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}

/// What becomes of a ray at a surface.
#[derive(Clone, Copy, Type)]
enum Event {
    Refracted { direction: Vec3, enters: bool },
    Reflected(Vec3),
}

/// The refracted direction; none where all light is reflected.
#[kernel]
fn refract(d: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cosine = -d.dot(n);
    let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if k < 0.0 {
        return None;
    }
    Some(d * eta + n * (eta * cosine - k.sqrt()))
}

#[kernel]
fn event(d: Vec3, normal: Vec3, index: f32) -> Event {
    let enters = d.dot(normal) < 0.0;
    let (n, eta) = if enters { (normal, 1.0 / index) } else { (-normal, index) };
    match refract(d, n, eta) {
        Some(direction) => Event::Refracted { direction, enters },
        None => Event::Reflected(d - n * (2.0 * d.dot(n))),
    }
}

/// The direction in which light leaves, and how often it was inside.
#[kernel]
fn through<S: Scene + ?Sized>(scene: &S, index: f32, ray: Ray) -> (Vec3, i32) {
    let mut ray = ray;
    let mut entered = 0;
    for _ in 0..6 {
        let hit = scene.closest_hit(ray);
        if !hit.is_hit {
            return (ray.direction, entered);
        }
        let point = scene.surface(ray, hit);
        let direction = match event(ray.direction, point.normal, index) {
            Event::Refracted { direction, enters } => {
                entered += if enters { 1 } else { 0 };
                direction
            }
            Event::Reflected(direction) => direction,
        };
        ray = point.ray(direction);
    }
    (Vec3::ZERO, entered)
}

#[test]
fn drops_bend_light() {
    let drops = vec![
        Drop { center: vec3(0.0, 0.0, 4.0), radius: 1.0 },
        Drop { center: vec3(0.3, 0.2, 8.0), radius: 1.5 },
    ];
    let bvh = Bvh::build(&drops).unwrap();
    let kernel = kernel!(|ray: Ray| through(&bvh, 1.5, ray));
    let rays: Vec<Ray> = (0..400)
        .map(|i| {
            let at = |k: i32| (k as f32 - 9.5) * 0.04;
            Ray::new(vec3(at(i % 20), at(i / 20), 0.0), Vec3::Z)
        })
        .collect();
    assert_variants_agree!(&kernel, &rays);
    let (direction, entered) = kernel.call((Ray::new(vec3(0.0, 0.0, 0.0), Vec3::Z),));
    assert_eq!(entered, 2);
    assert!(direction.z > 0.5);
}
