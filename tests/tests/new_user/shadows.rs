//! Lamps of three kinds, each with a weight. (enum with fields, zip, generic scene, early return)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use super::{balls, rays};

#[derive(Clone, Copy, Type)]
enum Lamp {
    Point { position: Vec3, power: Vec3 },
    Sun(Vec3, Vec3),
    Spot { position: Vec3, axis: Vec3, cosine: f32, power: Vec3 },
}

/// Light that arrives at a point, and the ray towards where it comes from.
#[derive(Clone, Copy, Type)]
struct Arriving {
    light: Vec3,
    ray: Ray,
}

#[kernel]
fn arriving(lamp: Lamp, p: SurfacePoint) -> Option<Arriving> {
    match lamp {
        Lamp::Point { position, power } => {
            let way = position - p.position;
            let cosine = way.normalize().dot(p.normal);
            if cosine <= 0.0 {
                return None;
            }
            Some(Arriving {
                light: power * (cosine / way.length_squared()),
                ray: p.ray_to(position),
            })
        }
        Lamp::Sun(towards, light) => {
            let cosine = towards.dot(p.normal);
            if cosine > 0.0 {
                Some(Arriving { light: light * cosine, ray: p.ray(towards) })
            } else {
                None
            }
        }
        Lamp::Spot { position, axis, cosine, power } => {
            let way = position - p.position;
            let inside = -way.normalize().dot(axis) > cosine;
            let facing = way.normalize().dot(p.normal);
            if !inside || facing <= 0.0 {
                return None;
            }
            Some(Arriving {
                light: power * (facing / way.length_squared()),
                ray: p.ray_to(position),
            })
        }
    }
}

#[kernel]
fn lit<S: RayQuery + ?Sized>(scene: &S, lamps: &[Lamp], weights: &[f32], p: SurfacePoint) -> Vec3 {
    let mut sum = Vec3::ZERO;
    for (lamp, weight) in lamps.iter().zip(weights) {
        if *weight == 0.0 {
            continue;
        }
        if let Some(a) = arriving(*lamp, p)
            && !scene.any_hit(a.ray)
        {
            sum += a.light * *weight;
        }
    }
    sum
}

#[test]
fn lamps_light_balls() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let lamps = vec![
        Lamp::Point { position: vec3(0.0, 3.0, 0.0), power: Vec3::splat(5.0) },
        Lamp::Sun(vec3(0.0, 0.6, -0.8), vec3(1.0, 0.9, 0.7)),
        Lamp::Spot {
            position: vec3(2.0, 2.0, 0.0),
            axis: vec3(0.0, 0.0, 1.0),
            cosine: 0.8,
            power: Vec3::Y,
        },
    ];
    let weights = vec![1.0, 0.5, 2.0];
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        if !hit.is_hit {
            return Vec3::ZERO;
        }
        let point = bvh.primitive(hit).surface_point(ray, hit);
        lit(&bvh, &lamps, &weights, point)
    });
    assert_variants_agree!(&kernel, &rays(24));
    let lit = rays(24).iter().filter(|r| kernel.call((**r,)).length() > 0.1).count();
    assert!(lit > 50, "{lit}");
}
