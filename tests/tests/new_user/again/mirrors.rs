//! What becomes of a ray between mirrors. (enum with fields, generic scene, bare integers, early
//! return)

use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::{assert_variants_agree, kernel};

#[primitive(sphere(center, radius))]
struct Mirror {
    center: Vec3,
    radius: f32,
}

#[kernel]
impl Surface for Mirror {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::splat(0.9)
    }
}

#[derive(Clone, Copy, Type)]
enum End {
    Sky { bounces: i32, direction: Vec3 },
    Dark(i32),
    Lost,
}

#[kernel]
fn end<S: Scene + ?Sized>(scene: &S, least: f32, ray: Ray) -> End {
    let mut ray = ray;
    let mut energy = 1.0;
    for bounces in 0..8 {
        let hit = scene.closest_hit(ray);
        if !hit.is_hit {
            return End::Sky { bounces, direction: ray.direction };
        }
        let seen = scene.shading_point(ray, hit);
        energy *= seen.albedo.x;
        if energy < least {
            return End::Dark(bounces);
        }
        let normal = seen.point.normal;
        ray = seen.point.ray(ray.direction - normal * (2.0 * normal.dot(ray.direction)));
    }
    End::Lost
}

#[test]
fn rays_end() {
    let mirrors = vec![
        Mirror { center: vec3(-1.2, 0.0, 5.0), radius: 1.0 },
        Mirror { center: vec3(1.2, 0.0, 5.0), radius: 1.0 },
    ];
    let bvh = Bvh::build(&mirrors).unwrap();
    let kernel = kernel!(|ray: Ray| match end(&bvh, 0.7, ray) {
        End::Sky { bounces, direction } => vec2(bounces as f32, direction.y),
        End::Dark(n) => vec2(-1.0, n as f32),
        End::Lost => vec2(-2.0, 0.0),
    });
    let rays: Vec<Ray> = (0..300)
        .map(|i| {
            Ray::new(vec3((i % 20) as f32 * 0.11 - 1.1, (i / 20) as f32 * 0.1 - 0.7, 0.0), Vec3::Z)
        })
        .collect();
    assert_variants_agree!(&kernel, &rays);
    assert!(rays.iter().any(|r| kernel.call((*r,)).x == 0.0));
    assert!(rays.iter().any(|r| kernel.call((*r,)).x >= 1.0));
}
