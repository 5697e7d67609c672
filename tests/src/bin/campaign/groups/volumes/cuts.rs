//! Parts of rays inside of balls.

use raydsl::prelude::*;
use raydsl::volume::Cut;
use raydsl::{Type, kernel};
use raydsl_tests::hard_rays::EPS;
use raydsl_tests::rng::Rng;

use super::super::ball::Ball;
use super::super::fault;
use crate::row::{Bound, Row, Unit};

/// The parts of a ray, at most four: where each begins and ends; and the length outside of all.
#[derive(Clone, Copy, Debug, Type)]
struct Parts {
    count: u32,
    begins: [f32; 4],
    ends: [f32; 4],
    outside: f32,
}

#[kernel]
fn parts<S: Scene + ?Sized>(scene: &S, ray: Ray) -> Parts {
    let mut count = 0u32;
    let mut begins = [0.0; 4];
    let mut ends = [0.0; 4];
    let mut cut = Cut::new(scene, ray);
    while let Some(part) = cut.next_inside(scene) {
        let i = min(count, 3u32);
        begins[i as usize] = part.t_min;
        ends[i as usize] = part.t_max;
        count += 1;
    }
    let mut outside = 0.0;
    let mut rest = Cut::new(scene, ray);
    while let Some(part) = rest.next_outside(scene) {
        outside += part.t_max - part.t_min;
    }
    Parts { count, begins, ends, outside }
}

/// One in another, two that touch, two that are one.
const BALLS: [Ball; 5] = [
    Ball { center: Vec3::ZERO, radius: 1.0 },
    Ball { center: Vec3::new(0.25, 0.0, 0.0), radius: 0.5 },
    Ball { center: Vec3::new(2.0, 0.0, 0.0), radius: 1.0 },
    Ball { center: Vec3::new(-3.0, 0.5, 0.0), radius: 0.75 },
    Ball { center: Vec3::new(-3.0, 0.5, 0.0), radius: 0.75 },
];

/// From outside and from within, at all places of a ball, half of them at its rim.
fn ray(rng: &mut Rng) -> Ray {
    let ball = rng.pick(&[0, 1, 2, 3]);
    let Ball { center, radius } = BALLS[ball];
    let origin = match rng.below(3) {
        0 => BALLS[rng.below(5)].center + rng.point(0.4),
        1 => rng.point(3.0),
        _ => rng.direction().normalize() * 10f32.powf(rng.range(0.7, 2.0)),
    };
    let way = center - origin;
    let aside = way.cross(rng.direction()).normalize_or_zero();
    let to_rim = if rng.below(2) == 0 {
        1.0 + rng.pick(&[-1.0, 0.0, 1.0]) * 10f32.powf(rng.range(-7.0, -2.0))
    } else {
        rng.range(0.0, 1.2)
    };
    let direction = way + aside * (radius * to_rim);
    let ray = Ray::new(origin, direction * 2f32.powf(rng.range(-3.0, 3.0)));
    if rng.below(5) == 0 { ray.with_range(0.3, 1.1) } else { ray.with_range(0.0, 1e4) }
}

/// The union of the parts inside of the balls, with radii off by a multiple of what is allowed for, in
/// `f64`.
fn union(ray: Ray, sign: f64) -> Vec<[f64; 2]> {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let of_ball = |ball: &Ball| {
        let from = o - ball.center.as_dvec3();
        let distance = from.length().max(f64::from(ball.radius));
        let radius = f64::from(ball.radius) + sign * 4.0 * EPS * distance;
        let nearest = -from.dot(d) / d.length_squared();
        let radicand = radius * radius - (from + d * nearest).length_squared();
        let half = (radicand.max(0.0) / d.length_squared()).sqrt();
        let begin = (nearest - half).max(ray.t_min.into());
        let end = (nearest + half).min(ray.t_max.into());
        (radicand > 0.0 && begin < end).then_some([begin, end])
    };
    let mut intervals: Vec<[f64; 2]> = BALLS.iter().filter_map(of_ball).collect();
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for [begin, end] in intervals {
        match all.last_mut() {
            Some(last) if begin <= last[1] => last[1] = last[1].max(end),
            _ => all.push([begin, end]),
        }
    }
    all
}

/// Whether each interval is within one of the others, to `slack`.
fn are_within(intervals: &[[f64; 2]], others: &[[f64; 2]], slack: impl Fn(f64) -> f64) -> bool {
    intervals.iter().all(|[begin, end]| {
        // What is shorter than rounding may be missed.
        end - begin <= slack(*begin) + slack(*end)
            || others.iter().any(|other| {
                other[0] - slack(other[0]) <= *begin && *end <= other[1] + slack(other[1])
            })
    })
}

pub(super) fn row() -> Row {
    let name = "nested, touching, coincident balls";
    Row::new(name, 6, Unit::Faults, Bound::NONE, |run| {
        let tool = &BALLS[..];
        let kernel = kernel!(|ray: Ray| parts(tool, ray));
        run.measure(
            &[kernel],
            |rng| (ray(rng),),
            |&(ray,), found| {
                let count = found.count as usize;
                if count > 4 {
                    return fault(true);
                }
                let ends = found.begins.into_iter().zip(found.ends).take(count);
                let inside: Vec<[f64; 2]> = ends.map(|(a, b)| [a.into(), b.into()]).collect();
                // Distances round as those from the origin to the balls do.
                let size = f64::from(ray.origin.length()) / f64::from(ray.direction.length());
                let slack = |t: f64| 4.0 * 2.0 * EPS * t.abs().max(size);
                let is_enough = are_within(&union(ray, -1.0), &inside, slack);
                let is_no_more = are_within(&inside, &union(ray, 1.0), slack);
                let length = inside.iter().map(|[a, b]| b - a).sum::<f64>();
                let whole = f64::from(ray.t_max) - f64::from(ray.t_min);
                let is_whole =
                    (length + f64::from(found.outside) - whole).abs() <= 8.0 * EPS * whole;
                fault(!(is_enough && is_no_more && is_whole))
            },
        )
    })
    .share(0.1)
}
