//! A laser scanner's echoes from a beam that passes several objects. (enum with fields, generic
//! scene, bare integers, early return, option)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

use super::{balls, rays};

/// What a scanner reports.
#[derive(Clone, Copy, Type)]
enum Echo {
    Nothing,
    One(f32),
    Many { first: f32, last: f32, count: u32 },
}

/// The echoes of a beam that loses half of its energy at each surface.
#[kernel]
fn echo<S: RayQuery + ?Sized>(scene: &S, least: f32, ray: Ray) -> Echo {
    let mut energy = 1.0;
    let mut count = 0;
    let mut first = None;
    let mut last = 0.0;
    for hit in scene.hits(ray) {
        if energy < least {
            break;
        }
        if first.is_none() {
            first = Some(hit.t);
        }
        last = hit.t;
        count += 1;
        energy *= 0.5;
    }
    let Some(first) = first else { return Echo::Nothing };
    if count == 1 { Echo::One(first) } else { Echo::Many { first, last, count } }
}

#[test]
fn beams_come_back() {
    let prims = balls();
    let bvh = Bvh::build(&prims).unwrap();
    let kernel = kernel!(|ray: Ray| {
        match echo(&bvh, 0.2, ray) {
            Echo::Nothing => vec3(0.0, 0.0, 0.0),
            Echo::One(t) => vec3(t, t, 1.0),
            Echo::Many { first, last, count } => vec3(first, last, count as f32),
        }
    });
    assert_variants_agree!(&kernel, &rays(24));
    let echoes = kernel.call((Ray::new(Vec3::ZERO, Vec3::Z),));
    assert!(echoes.z >= 2.0 && echoes.z <= 3.0 && echoes.y > echoes.x, "{echoes}");
}
