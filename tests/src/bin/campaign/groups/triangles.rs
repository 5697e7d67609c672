//! Triangles: seams of closed meshes through a tree, insides at every scale, slivers, and
//! triangles that are no surface.

use std::slice;

use raydsl::Type;
use raydsl::prelude::*;
use raydsl_tests::hard_rays::mesh::Icosphere;
use raydsl_tests::hard_rays::seams::{self, PLACES, Place};
use raydsl_tests::hard_rays::wide::{D3, cross, dot, minus, plus, wide};
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes;

use super::{FLUSHED, closest, fault, tree};
use crate::outcome::Outcome;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "triangles",
    title: "Triangles: seams of a closed mesh of 320, insides, slivers",
    clauses: &[
        "No ray passes an edge or a vertex that triangles share, nor a sliver between triangles.",
        "A ray hits a triangle that it meets well inside, at its distance to 1 %, for coordinates from \
         1e-20 to 1e19.",
        "A triangle without area, with two equal vertices or a NaN is never hit, and changes no \
         other hit.",
        "The point of a hit, by its weights, lies in the plane of the triangle to within the error \
         that it names.",
    ],
    rows,
};

/// Sizes and distances of triangles that are hit inside.
const SCALES: [f32; 7] = [1e-20, 1e-18, 1e-10, 1.0, 1e10, 1e18, 1e19];

/// Heights of slivers of length 1.
const HEIGHTS: [f32; 3] = [1e-5, 1e-6, 1e-7];

fn rows() -> Vec<Row> {
    let mut all: Vec<Row> = PLACES.iter().map(seams_at).collect();
    all.extend(HEIGHTS.map(sliver));
    all.extend(SCALES.map(inside));
    all.extend([no_surface(), among_no_surfaces(), points()]);
    all
}

/// Half of the rays go through a wide tree. The textbook is Möller and Trumbore's test, without a tree.
fn seams_at(place: &'static Place) -> Row {
    Row::new(place.name, 1, Unit::Faults, Bound::NONE, |run| {
        let mesh = Icosphere::new(place.center, place.radius);
        let triangles = mesh.triangles();
        let mut all = Outcome::default();
        for (i, is_wide) in [false, true].into_iter().enumerate() {
            let bvh = tree(&triangles, is_wide)?;
            let kernels = [
                kernel!(|ray: Ray| bvh.closest_hit(ray).is_hit),
                kernel!(|ray: Ray| bvh.any_hit(ray)),
            ];
            let part = run.part(0.5, i as u64);
            let make = |rng: &mut Rng| (seams::ray(&mesh, rng),);
            all.merge(run.unit, part.measure(&kernels, make, |_, is_hit| fault(!is_hit))?);
        }
        let textbook = run.broken_by(run.count / 100, |rng| {
            let ray = seams::ray(&mesh, rng);
            !triangles.iter().any(|t| textbook(&ray, t))
        });
        Ok(all.beside(textbook))
    })
}

/// The test of Möller and Trumbore ("Fast, Minimum Storage Ray/Triangle Intersection", 1997), as it
/// stands in textbooks.
fn textbook(ray: &Ray, t: &Triangle) -> bool {
    let (e1, e2) = (t.v1 - t.v0, t.v2 - t.v0);
    let across = ray.direction.cross(e2);
    let inverse = 1.0 / e1.dot(across);
    let from_v0 = ray.origin - t.v0;
    let u = from_v0.dot(across) * inverse;
    let q = from_v0.cross(e1);
    let (v, t) = (ray.direction.dot(q) * inverse, e2.dot(q) * inverse);
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0
}

/// A square on its corner with a sliver of length 1 across it, in a plane at random.
struct Slit {
    /// The ends of the sliver, its tip, and the corners above and below.
    corners: [Vec3; 5],
    normal: Vec3,
}

impl Slit {
    fn new(rng: &mut Rng, height: f32) -> Self {
        let x = rng.direction().normalize();
        let (y, normal) = x.any_orthonormal_pair();
        let at = rng.point(1.0);
        let flat = [(0.0, 0.0), (1.0, 0.0), (0.3, height), (0.4, 1.0), (0.6, -1.0)];
        Self { corners: flat.map(|(u, v)| at + x * u + y * v), normal }
    }

    /// The sliver first.
    fn triangles(&self) -> Vec<Triangle> {
        let [a, b, tip, above, below] = self.corners;
        [[a, b, tip], [a, tip, above], [tip, b, above], [a, below, b]]
            .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
            .to_vec()
    }

    /// At the sliver, away from its ends.
    fn ray(&self, rng: &mut Rng) -> Ray {
        let [a, b, tip, ..] = self.corners;
        let target = a + (b - a) * rng.range(0.05, 0.95);
        let target = target + (tip - target) * rng.unit() * rng.pick(&[0.0, 0.5]);
        let way = self.normal * rng.pick(&[1.0, -1.0]) + rng.direction() * 0.7;
        let origin = target + way * rng.pick(&[0.3, 3.0, 100.0]);
        let d = target - origin;
        Ray::new(origin, if rng.below(2) == 0 { d } else { d.normalize() })
    }
}

/// Every second tree is wide. The textbook is Möller and Trumbore's test.
fn sliver(height: f32) -> Row {
    Row::new(format!("sliver of 1 by {height:e}"), 1, Unit::Faults, Bound::NONE, move |run| {
        const PLANES: u64 = 8;
        let mut all = Outcome::default();
        let mut wrong = 0.0;
        for seed in 0..PLANES {
            let slit = Slit::new(&mut Rng::new(seed), height);
            let triangles = slit.triangles();
            let bvh = tree(&triangles, seed % 2 == 1)?;
            let part = run.part(1.0 / PLANES as f64, seed);
            // One tree of each kind: another one is sent to the device, and asked little.
            let part = if seed <= 1 { part } else { part.without_wgsl() };
            let make = |rng: &mut Rng| (slit.ray(rng),);
            let outcome = closest(&bvh, |kernel| {
                part.measure(slice::from_ref(kernel), make, |_, hit| fault(!hit.is_hit))
            })?;
            all.merge(run.unit, outcome);
            let broken = part.broken_by(part.count / 100, |rng| {
                let ray = slit.ray(rng);
                !triangles.iter().any(|t| textbook(&ray, t))
            });
            wrong += broken / PLANES as f64;
        }
        Ok(all.beside(wrong))
    })
}

/// What a kernel finds of one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(super) struct Met {
    pub(super) hit: Hit,
    pub(super) point: SurfacePoint,
}

/// Intersects a triangle.
pub(super) fn kernel() -> Kernel<'static, (Ray, Triangle), Met> {
    kernel!(|ray: Ray, one: Triangle| {
        let hit = one.intersect(ray);
        Met { hit, point: one.surface_point(ray, hit) }
    })
}

/// The distance of the plane and the three weights, in `f64` (Möller and Trumbore).
pub(super) fn exact(ray: &Ray, one: &Triangle) -> (f64, [f64; 3]) {
    let (a, d) = (wide(one.v0), wide(ray.direction));
    let (e1, e2) = (minus(wide(one.v1), a), minus(wide(one.v2), a));
    let across = cross(d, e2);
    let det = dot(e1, across);
    let from_a = minus(wide(ray.origin), a);
    let q = cross(from_a, e1);
    let (u, v) = (dot(from_a, across) / det, dot(d, q) / det);
    (dot(e2, q) / det, [1.0 - u - v, u, v])
}

/// A triangle that is no sliver, and a ray well inside of it that does not graze.
pub(super) fn at_inside(rng: &mut Rng, far: f32) -> (Ray, Triangle) {
    loop {
        let (v0, v1, v2) = (rng.point(1.0), rng.point(1.0), rng.point(1.0));
        let n = (v1 - v0).cross(v2 - v0);
        let (b, c) = (rng.range(0.05, 0.9), rng.range(0.05, 0.9));
        let way = rng.direction().normalize();
        let is_clear = n.length() > 0.05 && b + c < 0.95 && way.dot(n).abs() > 0.1 * n.length();
        if is_clear {
            let target = v0 + (v1 - v0) * b + (v2 - v0) * c;
            return (Ray::new(target - way * far, way), Triangle { v0, v1, v2 });
        }
    }
}

/// The same, larger or smaller.
fn scaled((ray, one): (Ray, Triangle), scale: f32) -> (Ray, Triangle) {
    let Triangle { v0, v1, v2 } = one;
    let one = Triangle { v0: v0 * scale, v1: v1 * scale, v2: v2 * scale };
    (Ray { origin: ray.origin * scale, ..ray }, one)
}

/// The textbook is Möller and Trumbore's test.
fn inside(scale: f32) -> Row {
    let row = Row::new(format!("insides at {scale:e}"), 2, Unit::Faults, Bound::NONE, move |run| {
        let make = move |rng: &mut Rng| {
            let (ray, one) = at_inside(rng, 2.0);
            // Of unit length, or as long as the way.
            let length = if rng.below(2) == 0 { 1.0 } else { scale.clamp(1e-18, 1e18) };
            scaled((Ray { direction: ray.direction * length, ..ray }, one), scale)
        };
        let outcome = run.measure(&[kernel()], make, |(ray, one), met| {
            let t = exact(ray, one).0;
            fault(!met.hit.is_hit || (f64::from(met.hit.t) - t).abs() > 0.01 * t)
        })?;
        let wrong = run.broken_by(run.count / 100, |rng| {
            let (ray, one) = make(rng);
            !textbook(&ray, &one)
        });
        Ok(outcome.beside(wrong))
    });
    if scale == 1e-18 {
        return row.misses(Bound { wgsl: 0.1, ..Bound::NONE }, FLUSHED);
    }
    if (1e-18..=1e18).contains(&scale) {
        return row;
    }
    row.misses(
        Bound::all(0.05),
        "Products of three coordinates overflow or are denormal: the range that `triangle::intersect` \
         documents is 1e-18 to 1e18.",
    )
}

/// A triangle that is no surface, and a ray at it.
fn flat(rng: &mut Rng) -> (Ray, Triangle) {
    // Few digits: sums and multiples are exact.
    let mut whole = || Vec3::from_array([(); 3].map(|()| rng.below(17) as f32 - 8.0));
    let (a, b) = (whole(), whole());
    let [v0, v1, mut v2] = [a, b, b + (b - a)];
    let kind = rng.below(5);
    match kind {
        0 => {}
        1 => v2 = a,
        2 => v2 = b,
        3 => v2 = a.midpoint(b),
        _ => v2 = rng.point(8.0),
    }
    let mut corners = if kind == 1 && rng.below(4) == 0 { [a; 3] } else { [v0, v1, v2] };
    corners.rotate_left(rng.below(3));
    let target = corners[0] + (corners[1] - corners[0]) * (rng.below(5) as f32 / 4.0);
    if kind == 4 {
        corners[rng.below(3)][rng.below(3)] = f32::NAN;
    }
    let [v0, v1, v2] = corners;
    let any = rng.direction();
    let way = rng.pick(&[Vec3::X, Vec3::Y, Vec3::Z, any]);
    let scale = rng.pick(&[1.0, 1.0 / 1_048_576.0, 1_048_576.0]);
    scaled((Ray::new(target - way * 4.0, way), Triangle { v0, v1, v2 }), scale)
}

/// The textbook's share is that of hits by Möller and Trumbore.
fn no_surface() -> Row {
    Row::new("no area, equal vertices, NaN", 3, Unit::Faults, Bound::NONE, |run| {
        let outcome = run.measure(&[kernel()], flat, |_, met| fault(met.hit.is_hit))?;
        let wrong = run.broken_by(run.count / 100, |rng| {
            let (ray, one) = flat(rng);
            textbook(&ray, &one)
        });
        Ok(outcome.beside(wrong))
    })
}

/// Every other triangle of a tree is no surface.
fn among_no_surfaces() -> Row {
    Row::new("a tree with such triangles", 3, Unit::Faults, Bound::NONE, |run| {
        let sound = scenes::triangles(100);
        let mut rng = Rng::new(5);
        let mut mixed = Vec::new();
        for one in &sound {
            // A box with a NaN is refused; where the vertex is not the last, `min` passes over it.
            let mut bad = flat(&mut rng).1;
            while !bad.get_bounds().is_finite() {
                bad = flat(&mut rng).1;
            }
            mixed.extend([bad, *one]);
        }
        let (reference, bvh) = (Bvh::build(&sound)?, Bvh::build(&mixed)?);
        let make = |rng: &mut Rng| (scenes::random_ray(rng),);
        let judge = |(ray,): &(Ray,), hit: &Hit| {
            let expected = reference.closest_hit(*ray);
            let id = if expected.is_hit { 2 * expected.prim_id + 1 } else { 0 };
            fault(*hit != Hit { prim_id: id, ..expected })
        };
        closest(&bvh, |kernel| run.measure(slice::from_ref(kernel), make, judge))
    })
}

/// How far the point of a hit is from the plane, over the error that it names. The textbook's
/// point is that at the distance of the hit.
fn points() -> Row {
    Row::new("points of hits, from up to 1e4", 4, Unit::Times, Bound::all(1.0), |run| {
        let make = |rng: &mut Rng| {
            let far = rng.pick(&[0.3, 3.0, 100.0, 1e4]);
            scaled(at_inside(rng, far), rng.pick(&[1e-6, 1.0, 1e6]))
        };
        let off = |one: &Triangle, met: &Met, p: D3| {
            let v0 = wide(one.v0);
            let n = cross(minus(wide(one.v1), v0), minus(wide(one.v2), v0));
            let height = dot(minus(p, v0), n) / dot(n, n).sqrt();
            height.abs() / f64::from(met.point.error)
        };
        let outcome = run.measure(&[kernel()], make, |(_, one), met| {
            met.hit.is_hit.then(|| off(one, met, wide(met.point.position)))
        })?;
        let (kernel, mut rng) = (kernel(), Rng::new(run.seed));
        let errors = (0..1000).map(|_| {
            let input = make(&mut rng);
            let met = kernel.call(input);
            off(&input.1, &met, wide(input.0.at(met.hit.t)))
        });
        Ok(outcome.beside(errors.fold(0.0, f64::max)))
    })
}

/// The same point in `f64`, for other groups.
pub(super) fn point_of(one: &Triangle, weights: [f64; 3]) -> D3 {
    let corners = [one.v0, one.v1, one.v2].map(wide);
    (0..3).fold([0.0; 3], |sum, i| plus(sum, corners[i], weights[i]))
}
