//! Boxes, ranges and directions.

use std::slice;

use raydsl::prelude::*;
use raydsl_tests::hard_rays::wide::{dot, wide};
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes;

use super::super::{closest, fault, spheres, triangles};
use crate::row::{Bound, Row, Unit};

/// What [`Aabb::span`] gives for a ray that has no part in the box.
const EMPTY: (f32, f32) = (f32::MAX, -f32::MAX);

pub(super) fn rows() -> Vec<Row> {
    let mut all = vec![
        no_boxes(),
        flat_boxes(),
        Row::new("empty ranges, tree", 1, Unit::Faults, Bound::NONE, |run| {
            let prims = scenes::triangles(300);
            let bvh = Bvh::build(&prims)?;
            let make = |rng: &mut Rng| (empty_range(scenes::random_ray(rng), rng),);
            closest(&bvh, |kernel| {
                run.measure(slice::from_ref(kernel), make, |_, hit| fault(hit.is_hit))
            })
        }),
        Row::new("empty ranges, sphere", 1, Unit::Faults, Bound::NONE, |run| {
            let make = |rng: &mut Rng| {
                let (ray, center, radius) = from_inside(rng, 1.0);
                (empty_range(ray, rng), center, radius)
            };
            run.measure(&[spheres::kernel()], make, |_, met| fault(met.hit.is_hit))
        }),
        Row::new("camera inside a sphere", 2, Unit::Times, Bound::all(1.0), |run| {
            let make = |rng: &mut Rng| {
                let radius = rng.pick(&[1.0, 1e-3, 1e3]);
                from_inside(rng, radius)
            };
            run.measure(&[spheres::kernel()], make, |input, met| {
                let is_behind = !met.hit.is_hit || met.hit.t < 0.0;
                let error = spheres::Exact::of(input).error_of_distance(&met.hit);
                Some(if is_behind { f64::INFINITY } else { error })
            })
        }),
    ];
    for length in [1e-20, 1e-10, 1e10, 1e20] {
        all.extend([sphere_along(length), triangle_along(length)]);
    }
    all
}

/// A range that ends before it begins, or has a NaN.
fn empty_range(ray: Ray, rng: &mut Rng) -> Ray {
    let (a, b) = (rng.range(-5.0, 50.0), rng.range(-5.0, 50.0));
    match rng.below(4) {
        0 => ray.with_range(f32::NAN, f32::MAX),
        1 => ray.with_range(0.0, f32::NAN),
        2 => ray.with_range(f32::MAX, -f32::MAX),
        _ => ray.with_range(a.max(b).next_up(), a.min(b)),
    }
}

fn span() -> Kernel<'static, (Aabb, Ray), (f32, f32)> {
    kernel!(|bounds: Aabb, ray: Ray| bounds.span(ray))
}

/// Boxes that contain nothing, or ranges that do.
fn no_boxes() -> Row {
    Row::new("inverted, NaN, empty ranges", 1, Unit::Faults, Bound::NONE, |run| {
        let make = |rng: &mut Rng| {
            let (a, b) = (rng.point(2.0), rng.point(2.0));
            let mut bounds = Aabb::new(a.min(b), a.max(b));
            let target = a + (b - a) * rng.unit();
            let ray = Ray::new(target - rng.direction() * 3.0, rng.direction());
            match rng.below(3) {
                0 => {
                    let axis = rng.below(3);
                    bounds.min[axis] = bounds.max[axis].next_up();
                }
                1 => {
                    let end = if rng.below(2) == 0 { &mut bounds.min } else { &mut bounds.max };
                    end[rng.below(3)] = f32::NAN;
                }
                _ => return (bounds, empty_range(ray, rng)),
            }
            (bounds, ray)
        };
        run.measure(&[span()], make, |_, found| fault(*found != EMPTY))
    })
}

/// A ray through a flat box, where it meets the plane.
fn flat_boxes() -> Row {
    Row::new("flat boxes", 1, Unit::Faults, Bound::NONE, |run| {
        let make = |rng: &mut Rng| {
            let (a, b) = (rng.point(2.0), rng.point(2.0));
            let mut bounds = Aabb::new(a.min(b), a.max(b));
            let axis = rng.below(3);
            bounds.max[axis] = bounds.min[axis];
            let middle = bounds.center();
            let mut direction = rng.direction();
            direction[axis] = rng.pick(&[1.0, -1.0, 0.3]);
            (bounds, Ray::new(middle - direction * 2.0, direction))
        };
        run.measure(&[span()], make, |(bounds, _), &(enter, leave)| {
            let is_far_in = bounds.size().to_array().iter().filter(|s| **s > 0.01).count() == 2;
            // One distance, to the bound that the documentation names for each.
            let is_right = enter <= leave && (leave - enter).abs() <= 4.0 * f32::EPSILON * 2.0;
            let is_there = (enter - 2.0).abs() < 1e-4;
            if is_far_in { fault(!(is_right && is_there)) } else { None }
        })
    })
}

/// A ray that begins inside of a sphere.
fn from_inside(rng: &mut Rng, radius: f32) -> (Ray, Vec3, f32) {
    let center = rng.point(3.0) * radius;
    let origin = center + rng.direction().normalize() * (0.95 * radius * rng.unit());
    (Ray::new(origin, rng.direction() * rng.pick(&[1.0, 1e-3, 30.0])), center, radius)
}

/// `t` times the length of the direction is the distance.
fn sphere_along(length: f32) -> Row {
    let name = format!("sphere, direction {length:e} long");
    let row = Row::new(name, 3, Unit::Times, Bound::all(1.0), move |run| {
        let make = move |rng: &mut Rng| {
            let center = rng.point(2.0);
            let way = rng.direction().normalize();
            let aside = rng.direction().cross(way).normalize_or_zero() * rng.range(0.0, 0.9);
            let origin = center + aside - way * rng.range(2.0, 20.0);
            (Ray::new(origin, way * length).with_range(0.0, f32::MAX), center, 1.0)
        };
        run.measure(&[spheres::kernel()], make, |input, met| {
            let exact = spheres::Exact::of(input);
            let error = exact.error_of_distance(&met.hit);
            Some(if exact.is_met()? == met.hit.is_hit { error } else { f64::INFINITY })
        })
    });
    row.misses(
        Bound::all(f64::INFINITY),
        "The square of the direction's length is not in the range of `f32`: the range that \
         `sphere::intersect` documents is 1e-18 to 1e18.",
    )
}

/// The distance is off by at most 16 eps of the farthest coordinate, over the cosine.
fn triangle_along(length: f32) -> Row {
    let name = format!("triangle, direction {length:e} long");
    Row::new(name, 3, Unit::Times, Bound::all(1.0), move |run| {
        let make = move |rng: &mut Rng| {
            let (ray, one) = triangles::at_inside(rng, 2.0);
            (Ray { direction: ray.direction * length, ..ray }, one)
        };
        run.measure(&[triangles::kernel()], make, |(ray, one), met| {
            let d = wide(ray.direction);
            let off = (f64::from(met.hit.t) - triangles::exact(ray, one).0).abs();
            // Rays meet these triangles at a cosine of 0.1 or more, from 2 away.
            let allowed = 16.0 * raydsl_tests::hard_rays::EPS * 4.0 / 0.1;
            let error = off * dot(d, d).sqrt() / allowed;
            Some(if met.hit.is_hit { error } else { f64::INFINITY })
        })
    })
}
