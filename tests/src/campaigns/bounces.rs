//! Rays that leave the surface that another ray has hit: none hits it again where it begins, and
//! none gets through to the other side.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use raydsl::Type;
use raydsl::bvh::BuildError;
use raydsl::prelude::*;

use super::exact::{D3, cross, dot, meets_triangle, minus, plus, wide};
use super::mesh::Icosphere;
use super::{Asked, Tally, VARIANTS};
use crate::gpu::gpu;
use crate::in_parallel;
use crate::rng::Rng;

/// Rays that a thread makes at a time.
const PART: usize = 1 << 13;

/// 2^-24.
const EPS: f64 = 1.0 / 16_777_216.0;

/// Where surfaces stand: the largest coordinate.
pub const POSITIONS: [f32; 5] = [0.0, 10.0, 1e3, 1e5, 1e6];

/// How large they are: a triangle's edge, a sphere's diameter.
pub const SIZES: [f32; 3] = [1e-3, 1.0, 100.0];

/// Of a direction that is closer to the surface than this, as a cosine, rounding says on which side
/// it goes.
const TANGENT: f64 = 1e-6;

/// What a kernel found.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Bounce {
    /// Where the first ray hit.
    pub first: Hit,
    /// The point there.
    pub point: SurfacePoint,
    /// The second ray.
    pub next: Ray,
    /// Where it hit.
    pub again: Hit,
}

const NOTHING: Bounce = Bounce {
    first: Hit::miss(),
    point: SurfacePoint { position: Vec3::ZERO, normal: Vec3::ZERO, error: 0.0 },
    next: Ray::new(Vec3::ZERO, Vec3::ZERO),
    again: Hit::miss(),
};

/// `local` in a frame whose z is the normal.
#[raydsl::kernel]
#[inline]
pub fn from_frame(normal: Vec3, local: Vec3) -> Vec3 {
    let (x, y) = normal.any_orthonormal_pair();
    x * local.x + y * local.y + normal * local.z
}

/// A direction in a frame whose z is the normal: on either side, often grazing, of any length.
pub fn local(rng: &mut Rng) -> Vec3 {
    let cosine = match rng.below(4) {
        0 => rng.unit(),
        1 => rng.unit() * 1e-2,
        2 => 10.0f32.powf(rng.range(-7.0, 0.0)),
        _ => 1.0 - rng.unit() * 1e-3,
    };
    let (sin, cos) = rng.range(0.0, std::f32::consts::TAU).sin_cos();
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let side = rng.pick(&[1.0, -1.0]);
    vec3(cos * sine, sin * sine, side * cosine) * rng.pick(&[1.0, 1.0, 1e-3, 20.0])
}

/// Whether `f32` resolves something of this size there: it has some ten numbers across it.
fn is_resolved(position: f32, size: f32) -> bool {
    size >= 8.0 * position * f32::EPSILON
}

/// A position whose largest coordinate is `p`.
fn position(p: f32) -> Vec3 {
    vec3(p, -0.7 * p, 0.4 * p)
}

/// The largest shift that is allowed: 4 ulp of the position's distance from the world's origin, and
/// 8 eps of the size.
fn allowed(position: Vec3, size: f64) -> f64 {
    let distance = dot(wide(position), wide(position)).sqrt() as f32;
    4.0 * f64::from(distance.next_up() - distance) + 8.0 * EPS * size
}

/// What is wrong with a bounce from something whose second hit is `expected`, if anything.
fn fault(bounce: &Bounce, size: f64, is_right: bool) -> Option<&'static str> {
    let shift = minus(wide(bounce.next.origin), wide(bounce.point.position));
    if dot(shift, shift).sqrt() > allowed(bounce.point.position, size) {
        return Some("shifted too far");
    }
    (!is_right).then_some("hit where it began, or through")
}

/// Asks a kernel about `count` bounces. `make` gives a ray at the surface, and `check` says what is
/// wrong with a bounce.
fn ask(
    tally: &mut Tally,
    kernel: &Kernel<'_, (Ray, Vec3), Bounce>,
    count: usize,
    make: &(impl Fn(&mut Rng) -> Ray + Sync),
    check: &(impl Fn(&Bounce) -> Option<&'static str> + Sync),
) {
    let seed = Rng::of(&tally.name).bits();
    let lost = VARIANTS.map(|_| AtomicU64::new(0));
    let bounced = AtomicU64::new(0);
    let first = Mutex::new(None);
    in_parallel(count, PART, |range| {
        let mut rng = Rng::new(seed ^ range.start as u64);
        let inputs: Vec<(Ray, Vec3)> = range.map(|_| (make(&mut rng), local(&mut rng))).collect();
        let mut found = vec![NOTHING; inputs.len()];
        for (variant, lost) in VARIANTS.into_iter().zip(&lost) {
            kernel.run(variant, &inputs, &mut found);
            let hits = || found.iter().filter(|b| b.first.is_hit);
            let mut faults = hits().filter_map(|b| check(b).map(|why| (why, b)));
            if let Some((why, bounce)) = faults.next() {
                lost.fetch_add(1 + faults.count() as u64, Ordering::Relaxed);
                if let Ok(mut first) = first.lock() {
                    first.get_or_insert_with(|| format!("{}: {why}: {bounce:?}", variant.name()));
                }
            }
            if variant == Variant::Scalar {
                bounced.fetch_add(hits().count() as u64, Ordering::Relaxed);
            }
        }
    });
    let rays = bounced.into_inner();
    let asked = VARIANTS.into_iter().zip(lost).map(|(variant, lost)| {
        let (isa, lanes) = variant.isa();
        let who = format!("{} ({lanes} of {isa})", variant.name());
        Asked { who, rays, lost: lost.into_inner() }
    });
    let asked = asked.collect();
    tally.add(Tally { asked, first: first.into_inner().unwrap_or(None), ..Tally::default() });
}

/// [`ask`] of WGSL, if there is a device.
fn ask_wgsl(
    tally: &mut Tally,
    kernel: &Kernel<'_, (Ray, Vec3), Bounce>,
    count: usize,
    make: &impl Fn(&mut Rng) -> Ray,
    check: &impl Fn(&Bounce) -> Option<&'static str>,
) {
    let Some(gpu) = gpu().filter(|_| count > 0) else { return };
    let mut rng = Rng::of(&tally.name);
    let inputs: Vec<(Ray, Vec3)> = (0..count).map(|_| (make(&mut rng), local(&mut rng))).collect();
    let mut found = vec![NOTHING; count];
    if let Err(error) = gpu.batch(kernel, &inputs, &mut found) {
        panic!("{}: {error}\n{}", tally.name, kernel.wgsl());
    }
    let hits = || found.iter().filter(|b| b.first.is_hit);
    let faults: Vec<String> =
        hits().filter_map(|b| check(b).map(|why| format!("WGSL: {why}: {b:?}"))).collect();
    let (rays, lost) = (hits().count() as u64, faults.len() as u64);
    let asked = vec![Asked { who: "WGSL".to_owned(), rays, lost }];
    tally.add(Tally { asked, first: faults.into_iter().next(), ..Tally::default() });
}

/// A ray at a point of the surface, from either side of it.
fn towards(rng: &mut Rng, target: Vec3, normal: Vec3, size: f32) -> Ray {
    let way = rng.direction() + normal * rng.pick(&[1.0, -0.3]);
    let origin = target + way * (size * rng.pick(&[0.2, 1.0, 10.0]));
    let d = target - origin;
    Ray::new(origin, if rng.below(2) == 0 { d } else { d.normalize() })
}

/// On which side of the surface the second ray goes: the cosine of its angle with the normal.
fn rise(outwards: D3, bounce: &Bounce) -> f64 {
    let d = wide(bounce.next.direction);
    dot(outwards, d) / (dot(outwards, outwards) * dot(d, d)).sqrt()
}

/// What is wrong with a bounce on a closed convex mesh: outside it hits nothing, inside another
/// triangle.
fn fault_on_mesh(triangles: &[Triangle], bounce: &Bounce) -> Option<&'static str> {
    let first = &triangles[bounce.first.prim_id as usize];
    let [a, b, c] = [first.v0, first.v1, first.v2].map(wide);
    let edges = [minus(b, a), minus(c, b), minus(a, c)];
    let size = edges.iter().map(|e| dot(*e, *e)).fold(0.0, f64::max).sqrt();
    let outwards = cross(edges[0], minus(c, a));
    let height = dot(outwards, minus(wide(bounce.next.origin), a));
    let (rise, again) = (rise(outwards, bounce), bounce.again);
    let is_right = if height > 0.0 {
        // The mesh is as convex as its rounded vertices: `f64` says whether that hit is one.
        let is_other = again.prim_id != bounce.first.prim_id
            && meets_triangle(&bounce.next, &triangles[again.prim_id as usize]);
        rise > -TANGENT && (!again.is_hit || is_other)
    } else {
        // A direction that rises within the rounding of the plane leaves through it.
        let is_other = again.prim_id != bounce.first.prim_id || rise > 0.0;
        rise < TANGENT && height < 0.0 && again.is_hit && is_other
    };
    fault(bounce, size, is_right)
}

/// On triangles of closed meshes, through a tree: about `count` bounces, whose origins are moved by
/// `share` of the error.
///
/// # Errors
///
/// None: the meshes have finite bounds.
pub fn on_triangles(count: usize, wgsl: usize, share: f32) -> Result<Vec<Tally>, BuildError> {
    let mut tallies = Vec::new();
    for p in POSITIONS {
        for size in SIZES.into_iter().filter(|size| is_resolved(p, *size)) {
            let mesh = Icosphere::with_edges(position(p), size);
            let triangles = mesh.triangles();
            let bvh = Bvh::build(&triangles)?;
            let kernel = kernel!(|ray: Ray, local: Vec3| {
                let first = bvh.closest_hit(ray);
                let point = bvh.primitive(first).surface_point(ray, first);
                let moved = SurfacePoint { error: share * point.error, ..point };
                let next = moved.ray(from_frame(point.normal, local));
                Bounce { first, point, next, again: bvh.closest_hit(next) }
            });
            let make = |rng: &mut Rng| {
                let target = match rng.below(3) {
                    0 => mesh.seam(rng).0,
                    _ => mesh.point(rng),
                };
                towards(rng, target, (target - mesh.center) / mesh.radius, size)
            };
            let mut tally = Tally::new(format!("edges of {size:?} at {p:?}"));
            let check = |b: &Bounce| fault_on_mesh(&triangles, b);
            ask(&mut tally, &kernel, count / CASES, &make, &check);
            ask_wgsl(&mut tally, &kernel, wgsl / CASES, &make, &check);
            tallies.push(tally);
        }
    }
    Ok(tallies)
}

/// Positions and sizes that `f32` resolves.
pub const CASES: usize = 13;

/// A sphere that is seen as a primitive.
#[primitive(sphere(center, radius))]
#[derive(Debug)]
pub struct Ball {
    /// The middle.
    pub center: Vec3,
    /// The radius.
    pub radius: f32,
}

/// Where in `f64` the line of a ray leaves the ball, in lengths of its direction; and whether the
/// ray begins inside.
fn end_in_ball(ball: &Ball, ray: &Ray) -> (f64, bool) {
    let (o, d): (D3, D3) = (minus(wide(ray.origin), wide(ball.center)), wide(ray.direction));
    let r2 = f64::from(ball.radius).powi(2);
    let closest = -dot(o, d) / dot(d, d);
    let aside = plus(o, d, closest);
    let half = ((r2 - dot(aside, aside)).max(0.0) / dot(d, d)).sqrt();
    (closest + half, dot(o, o) < r2)
}

/// What is wrong with a bounce on a ball: outside it hits nothing, inside the far side.
fn fault_on_ball(ball: &Ball, bounce: &Bounce) -> Option<&'static str> {
    let (end, is_inside) = end_in_ball(ball, &bounce.next);
    let again = bounce.again;
    let outwards = wide(bounce.point.normal);
    let rise = rise(outwards, bounce);
    let is_right = if is_inside {
        rise < TANGENT && again.is_hit && f64::from(again.t) > 0.5 * end
    } else {
        rise > -TANGENT && !again.is_hit
    };
    fault(bounce, 2.0 * f64::from(ball.radius), is_right)
}

/// On spheres: about `count` bounces, whose origins are moved by `share` of the error.
///
/// # Errors
///
/// None: spheres have finite bounds.
pub fn on_spheres(count: usize, wgsl: usize, share: f32) -> Result<Vec<Tally>, BuildError> {
    let mut tallies = Vec::new();
    for p in POSITIONS {
        for size in SIZES.into_iter().filter(|size| is_resolved(p, *size)) {
            let ball = Ball { center: position(p), radius: 0.5 * size };
            let balls = [ball];
            let bvh = Bvh::build(&balls)?;
            let kernel = kernel!(|ray: Ray, local: Vec3| {
                let first = bvh.closest_hit(ray);
                let point = bvh.primitive(first).surface_point(ray, first);
                let moved = SurfacePoint { error: share * point.error, ..point };
                let next = moved.ray(from_frame(point.normal, local));
                Bounce { first, point, next, again: bvh.closest_hit(next) }
            });
            let make = |rng: &mut Rng| {
                let normal = rng.direction().normalize();
                towards(rng, ball.center + normal * ball.radius, normal, size)
            };
            let mut tally = Tally::new(format!("diameter {size:?} at {p:?}"));
            let check = |b: &Bounce| fault_on_ball(&ball, b);
            ask(&mut tally, &kernel, count / CASES, &make, &check);
            ask_wgsl(&mut tally, &kernel, wgsl / CASES, &make, &check);
            tallies.push(tally);
        }
    }
    Ok(tallies)
}
