//! Rays at boxes where a box test is easily wrong, through a tree; rays that are no rays; and how
//! many nodes are visited for it.

use std::slice;

use raydsl::prelude::*;
use raydsl_tests::hard_rays::boxes::{self, EXPONENTS, ROWS};
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes;

use super::{closest, fault, tree};
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Group, Row, Unit};
use crate::timing::ratio;
use crate::visits::visits;

pub(crate) const GROUP: Group = Group {
    name: "boxes",
    title: "Boxes of trees, at five sizes from 1e-15 to 1e15",
    clauses: &[
        "No ray misses a box that it meets.",
        "A ray with a NaN or an infinity hits nothing.",
        "A batch of which half the rays have one takes at most 2.5 times as long as one without.",
        "Rays visit at most 2 % more nodes than with a test that allows nothing for rounding.",
    ],
    rows,
};

/// Trees at each size.
const TREES: u64 = 16;

fn rows() -> Vec<Row> {
    let mut all: Vec<Row> = ROWS.iter().map(lost).collect();
    all.extend([broken(), time_of_broken(), visits_in_colonnade()]);
    all.push(visits_of("nodes visited, triangles", || scenes::triangles(2000)));
    all.push(visits_of("nodes visited, spheres", || scenes::spheres(2000)));
    all
}

/// Every second tree is wide. The textbook is the test in IEEE arithmetic, with nothing allowed for
/// rounding, without a tree.
fn lost(row: &'static boxes::Row) -> Row {
    Row::new(row.name, 1, Unit::Faults, Bound::NONE, |run| {
        let mut all = Outcome::default();
        let mut textbook = 0.0;
        let share = 1.0 / (EXPONENTS.len() as f64 * TREES as f64);
        for (i, exponent) in EXPONENTS.into_iter().enumerate() {
            let scale = 2.0f32.powi(exponent);
            for seed in 0..TREES {
                let marks = boxes::marks(row, seed);
                let scene = boxes::at_scale(&marks, scale);
                let bvh = tree(&scene, seed % 2 == 1)?;
                let kernels = [
                    kernel!(|ray: Ray| bvh.closest_hit(ray).is_hit),
                    kernel!(|ray: Ray| bvh.any_hit(ray)),
                ];
                let part = run.part(share, i as u64 * TREES + seed);
                // One tree of each kind at each size: another one is sent to the device, and asked little.
                let part = if seed <= 1 { part } else { part.without_wgsl() };
                let ray = |rng: &mut _| boxes::ray(rng, row, &marks, scale);
                let outcome =
                    part.measure(&kernels, |rng| (ray(rng),), |_, is_hit| fault(!is_hit))?;
                all.merge(run.unit, outcome);
                textbook += share
                    * part.broken_by(part.count / 100, |rng| {
                        !boxes::textbook(&marks, scale, &ray(rng))
                    });
            }
        }
        Ok(all.beside(textbook))
    })
}

/// A ray into the colonnade, from its camera.
fn primary(rays: &impl CameraRays, rng: &mut Rng) -> Ray {
    rays.primary_ray(SIDE as f32 * rng.unit(), SIDE as f32 * rng.unit())
}

/// Rays whose nodes are counted: fewer say little.
const LEAST_COUNTED: u64 = 4000;

/// Pixels along an edge of the film.
const SIDE: u32 = 512;

/// The same with a NaN or an infinity in one of its components.
fn spoilt(mut ray: Ray, rng: &mut Rng) -> Ray {
    let bad = rng.pick(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
    let part = if rng.below(2) == 0 { &mut ray.origin } else { &mut ray.direction };
    part[rng.below(3)] = bad;
    ray
}

fn broken() -> Row {
    Row::new("NaN or infinity in a ray", 2, Unit::Faults, Bound::NONE, |run| {
        let (triangles, camera) = scenes::colonnade();
        let (bvh, rays) = (Bvh::build(&triangles)?, camera.begin_frame(SIDE, SIDE));
        let make = |rng: &mut Rng| (spoilt(primary(&rays, rng), rng),);
        closest(&bvh, |kernel| {
            run.measure(slice::from_ref(kernel), make, |_, hit| fault(hit.is_hit))
        })
    })
}

/// On one thread each, in turns.
fn time_of_broken() -> Row {
    Row::new("time with every second one such", 3, Unit::Times, Bound::all(2.5), |run| {
        const ROUNDS: usize = 9;
        let (triangles, camera) = scenes::colonnade();
        let (bvh, rays) = (Bvh::build(&triangles)?, camera.begin_frame(SIDE, SIDE));
        // Row by row, as cameras go.
        let count = run.count.clamp(1 << 10, 1 << 16) as usize;
        let side = (count as f32).sqrt() as usize;
        let step = SIDE as f32 / side as f32;
        let pixel = |i: usize| {
            let [x, y] = [i % side, i / side].map(|i| (i as f32 + 0.5) * step);
            (rays.primary_ray(x, y),)
        };
        let whole: Vec<(Ray,)> = (0..side * side).map(pixel).collect();
        let mut mixed = whole.clone();
        let mut rng = Rng::new(run.seed);
        mixed.iter_mut().step_by(2).for_each(|(ray,)| *ray = spoilt(*ray, &mut rng));
        let found = closest(&bvh, |kernel| {
            let time = |variant: Variant| {
                let [mut a, mut b] = [0; 2].map(|_| vec![Hit::miss(); whole.len()]);
                let ratio = ratio(
                    ROUNDS,
                    || kernel.run(variant, &mixed, &mut a),
                    || kernel.run(variant, &whole, &mut b),
                );
                Found::whole(variant.name(), whole.len(), ratio)
            };
            run.of_cpu().into_iter().map(time).collect()
        });
        Ok(Outcome::of_figures(found))
    })
}

/// How many more nodes are visited than by the textbook's test, as a share: by these rays, and by
/// rays that leave what those hit.
fn more_visits<P: Primitive<Hit = Hit, Shared = ()>>(
    bvh: &Bvh<'_, P>,
    rays: &[Ray],
    rng: &mut Rng,
) -> Outcome {
    let leaves = |ray: &Ray| {
        let hit = bvh.closest_hit(*ray);
        hit.is_hit.then(|| Ray::new(ray.at(hit.t * 0.999), rng.direction()))
    };
    let bounced: Vec<Ray> = rays.iter().filter_map(leaves).collect();
    let mut all = Found::new("host");
    for rays in [rays, &bounced] {
        let (robust, plain) = visits(bvh, rays);
        let more = robust as f64 / plain as f64 - 1.0;
        all.merge(Unit::Relative, Found::whole("host", rays.len(), more));
    }
    Outcome::host(all)
}

fn visits_in_colonnade() -> Row {
    let row = Row::new("nodes visited, colonnade", 4, Unit::Relative, Bound::all(0.02), |run| {
        let (triangles, camera) = scenes::colonnade();
        let (bvh, rays) = (Bvh::build(&triangles)?, camera.begin_frame(SIDE, SIDE));
        let mut rng = Rng::new(run.seed);
        let primary: Vec<Ray> =
            (0..run.count.max(LEAST_COUNTED)).map(|_| primary(&rays, &mut rng)).collect();
        Ok(more_visits(&bvh, &primary, &mut rng))
    });
    row.share(0.01)
}

fn visits_of<P: Primitive<Hit = Hit, Shared = ()>>(
    name: &'static str,
    scene: impl Fn() -> Vec<P> + 'static,
) -> Row {
    let row = Row::new(name, 4, Unit::Relative, Bound::all(0.02), move |run| {
        let prims = scene();
        let bvh = Bvh::build(&prims)?;
        let mut rng = Rng::new(run.seed);
        let rays: Vec<Ray> =
            (0..run.count.max(LEAST_COUNTED)).map(|_| scenes::random_ray(&mut rng)).collect();
        Ok(more_visits(&bvh, &rays, &mut rng))
    });
    row.share(0.01)
}
