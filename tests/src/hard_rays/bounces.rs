//! Rays that leave the surface that another ray has hit: none hits it again where it begins, and
//! none gets through to the other side.

use raydsl::Type;
use raydsl::prelude::*;

use super::EPS;
use super::wide::{D3, cross, dot, meets_triangle, minus, plus, wide};
use crate::rng::Rng;

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
pub fn is_resolved(position: f32, size: f32) -> bool {
    size >= 8.0 * position * f32::EPSILON
}

/// A position whose largest coordinate is `p`.
pub fn position(p: f32) -> Vec3 {
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

/// A ray at a point of the surface, from either side of it.
pub fn towards(rng: &mut Rng, target: Vec3, normal: Vec3, size: f32) -> Ray {
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
pub fn fault_on_mesh(triangles: &[Triangle], bounce: &Bounce) -> Option<&'static str> {
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
pub fn fault_on_ball(ball: &Ball, bounce: &Bounce) -> Option<&'static str> {
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
