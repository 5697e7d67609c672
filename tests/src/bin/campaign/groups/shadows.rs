//! Rays between a surface and a light, and a picture far from the world's origin: rows of `offsets`.

use std::slice;

use raydsl::Type;
use raydsl::prelude::*;
use raydsl_tests::hard_rays::bounces::{POSITIONS, is_resolved, position, towards};
use raydsl_tests::hard_rays::mesh::Icosphere;
use raydsl_tests::hard_rays::wide::{D3, cross, dot, meets_triangle, minus, wide};
use raydsl_tests::rng::Rng;

use super::fault;
use super::triangles::{exact, point_of};
use crate::measure::Run;
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Row, Unit};

pub(super) fn rows() -> Vec<Row> {
    let resolved = POSITIONS.into_iter().filter(|&p| is_resolved(p, SIZE));
    let mut all: Vec<Row> = resolved.map(between).collect();
    let far = Row::new("a picture 1e5 away, RMSE", 3, Unit::Absolute, Bound::all(OF_ROUNDING), far);
    all.push(far);
    all
}

/// Edges of the triangles.
const SIZE: f32 = 1.0;

/// Of a direction that is closer to the surface than this, as a cosine, rounding says on which side
/// it goes.
const TANGENT: f64 = 1e-5;

/// What a kernel found.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Shadow {
    first: Hit,
    point: SurfacePoint,
    end: SurfacePoint,
    /// Whether there is anything between the point and the light's point.
    is_dark: bool,
    /// Whether there is anything between the point and the lamp.
    is_dark_from_lamp: bool,
}

/// A closed mesh, and a light of two triangles beside it.
struct Lit {
    mesh: Icosphere,
    triangles: Vec<Triangle>,
    light: [Triangle; 2],
    /// A point between the two.
    lamp: Vec3,
}

impl Lit {
    fn new(at: Vec3) -> Self {
        let mesh = Icosphere::with_edges(at, SIZE);
        let to_light = vec3(0.36, 0.48, 0.8);
        let (u, v) = to_light.any_orthonormal_pair();
        let middle = at + to_light * (4.0 * mesh.radius);
        let [a, b, c, d] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| middle + u * x + v * y);
        let light = [[a, c, b], [a, d, c]].map(|[v0, v1, v2]| Triangle { v0, v1, v2 });
        let mut triangles = mesh.triangles();
        triangles.extend(light);
        let lamp = at + to_light * (2.0 * mesh.radius);
        Self { mesh, triangles, light, lamp }
    }

    /// Whether something is between the point of the first hit and `end`, by the side of the hit
    /// triangle on which that is: the mesh is convex. `None` where rounding decides.
    fn is_dark(&self, shadow: &Shadow, end: Vec3) -> Option<bool> {
        let face = &self.triangles[shadow.first.prim_id as usize];
        let a = wide(face.v0);
        let n = cross(minus(wide(face.v1), a), minus(wide(face.v2), a));
        let way = minus(wide(end), wide(shadow.point.position));
        let rise = dot(minus(wide(end), a), n) / (dot(n, n) * dot(way, way)).sqrt();
        if rise.abs() < TANGENT {
            return None;
        }
        // Next to an edge the origin may be moved across the neighbour, and the mesh is as convex as
        // its rounded vertices: `f64` says whether another triangle is met.
        let from = shadow.point.ray_to(end);
        let others = self.triangles[..self.mesh.faces.len()].iter().enumerate();
        let mut others = others.filter(|(id, _)| *id != shadow.first.prim_id as usize);
        let is_dark = others.any(|(_, other)| meets_triangle(&from, other));
        (is_dark == (rise < 0.0)).then_some(is_dark)
    }
}

/// The textbook's ray begins at the rounded point and ends `f32::EPSILON` before the light.
fn between(p: f32) -> Row {
    let row = Row::new(format!("to a light, at {p:?}"), 2, Unit::Faults, Bound::NONE, move |run| {
        let scene = Lit::new(position(p));
        let bvh = Bvh::build(&scene.triangles)?;
        let lamp = scene.lamp;
        let kernel = kernel!(|ray: Ray, light: Triangle, u: Vec2| {
            let first = bvh.closest_hit(ray);
            let point = bvh.primitive(first).surface_point(ray, first);
            let end = light.sample(u);
            Shadow {
                first,
                point,
                end,
                is_dark: bvh.any_hit(point.ray_between(end)),
                is_dark_from_lamp: bvh.any_hit(point.ray_to(lamp)),
            }
        });
        let make = |rng: &mut Rng| {
            let target =
                if rng.below(3) == 0 { scene.mesh.seam(rng).0 } else { scene.mesh.point(rng) };
            let ray = towards(rng, target, (target - scene.mesh.center) / scene.mesh.radius, SIZE);
            (ray, rng.pick(&scene.light), vec2(rng.unit(), rng.unit()))
        };
        let is_of_mesh =
            |s: &Shadow| s.first.is_hit && (s.first.prim_id as usize) < scene.mesh.faces.len();
        let judge = |s: &Shadow| {
            if !is_of_mesh(s) {
                return None;
            }
            let light = scene.is_dark(s, s.end.position).map(|is_dark| is_dark != s.is_dark);
            let lamp = scene.is_dark(s, lamp).map(|is_dark| is_dark != s.is_dark_from_lamp);
            fault(light.or(lamp)? || lamp.unwrap_or(false))
        };
        let outcome = run.measure(slice::from_ref(&kernel), make, |_, s| judge(s))?;
        let textbook = run.broken_by(run.count / 100, |rng| {
            let s = kernel.call(make(rng));
            if !is_of_mesh(&s) {
                return false;
            }
            let way = s.end.position - s.point.position;
            let ray = Ray::new(s.point.position, way.normalize())
                .with_range(f32::EPSILON, way.length() - f32::EPSILON);
            scene.is_dark(&s, s.end.position).is_some_and(|is_dark| is_dark != bvh.any_hit(ray))
        });
        Ok(outcome.beside(textbook))
    });
    row.share(0.1)
}

/// How far the scene of the picture is moved.
const MOVED: Vec3 = vec3(1e5, -1e5, 1e5);

/// An ulp at 1e5 is 1/128, so a vertex moves by at most 0.007, and a shadow ray's origin by at most
/// 0.03. Edges of the ball, 20 long in a picture of 12 by 12, move by the first, those of its shadow
/// and of facets that turn away, 40 long, by the second: 1 % of the pixels change by up to 0.6.
const OF_ROUNDING: f64 = 0.06;

/// The light of a ray in `f64`, by a loop over all triangles: the cosine to the lamp where that is
/// seen.
fn light_in_f64(triangles: &[Triangle], ray: &Ray, lamp: D3) -> f64 {
    let met = |(id, one): (usize, &Triangle)| {
        let (t, weights) = exact(ray, one);
        let is_met = weights.iter().all(|w| *w >= 0.0) && t > 0.0;
        is_met.then_some((t, id, weights))
    };
    let first = triangles.iter().enumerate().filter_map(met).min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((_, id, weights)) = first else { return 0.5 };
    let one = &triangles[id];
    let [a, b, c] = [one.v0, one.v1, one.v2].map(wide);
    let n = cross(minus(b, a), minus(c, a));
    let length = dot(n, n).sqrt() * -dot(n, wide(ray.direction)).signum();
    let point = point_of(one, weights);
    let way = minus(lamp, point);
    let cosine = dot(n, way) / (length * dot(way, way).sqrt());
    let is_between = |(other, one): (usize, &Triangle)| {
        other != id && crossing(one, point, way).is_some_and(|t| t > 0.0 && t < 1.0)
    };
    let is_dark = cosine <= 0.0 || triangles.iter().enumerate().any(is_between);
    if is_dark { 0.0 } else { cosine }
}

/// Where a line meets a triangle, in `f64`.
fn crossing(one: &Triangle, o: D3, d: D3) -> Option<f64> {
    let [a, b, c] = [one.v0, one.v1, one.v2].map(wide);
    let (e1, e2) = (minus(b, a), minus(c, a));
    let across = cross(d, e2);
    let det = dot(e1, across);
    let from_a = minus(o, a);
    let q = cross(from_a, e1);
    let (u, v) = (dot(from_a, across) / det, dot(d, q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| dot(e2, q) / det)
}

/// A ball on a floor, moved.
fn ball_on_floor(moved: Vec3) -> Vec<Triangle> {
    let mesh = Icosphere::with_edges(Vec3::ZERO, SIZE);
    let mut all = mesh.triangles();
    let corner = |x: f32, z: f32| vec3(x, -mesh.radius, z);
    let [a, b, c, d] = [corner(-8.0, -8.0), corner(8.0, -8.0), corner(8.0, 8.0), corner(-8.0, 8.0)];
    all.extend([[a, c, b], [a, d, c]].map(|[v0, v1, v2]| Triangle { v0, v1, v2 }));
    let place = |v: Vec3| v + moved;
    all.iter_mut().for_each(|t| (t.v0, t.v1, t.v2) = (place(t.v0), place(t.v1), place(t.v2)));
    all
}

/// The picture of a moved scene against that in `f64` of the scene where it was made.
fn far(run: &Run) -> Result<Outcome, Box<dyn std::error::Error>> {
    let side = if run.count > 100_000 { 256 } else { 48 };
    let (own, moved) = (ball_on_floor(Vec3::ZERO), ball_on_floor(MOVED));
    // Whole numbers: moving the camera and the lamp rounds nothing.
    let (eye, lamp) = (vec3(5.0, 6.0, 10.0), vec3(-4.0, 12.0, 5.0));
    let film = Pinhole::new(eye, Vec3::ZERO, Vec3::Y, 0.9).begin_frame(side, side);
    let pixel = |i: u32| film.primary_ray((i % side) as f32 + 0.5, (i / side) as f32 + 0.5);
    let rays: Vec<Ray> = (0..side * side).map(pixel).collect();
    let far = |ray: &Ray| Ray { origin: ray.origin + MOVED, ..*ray };
    let expected: Vec<f64> = rays.iter().map(|ray| light_in_f64(&own, ray, wide(lamp))).collect();
    let inputs: Vec<(Ray, Vec3)> = rays.iter().map(|ray| (far(ray), lamp + MOVED)).collect();
    let bvh = Bvh::build(&moved)?;
    let shade = kernel!(|ray: Ray, lamp: Vec3| {
        let hit = bvh.closest_hit(ray);
        let mut light = 0.5;
        if hit.is_hit {
            let point = bvh.primitive(hit).surface_point(ray, hit);
            let seen = facing(point, ray.direction);
            light = max(seen.normal.dot((lamp - seen.position).normalize()), 0.0);
            if light > 0.0 && bvh.any_hit(seen.ray_to(lamp)) {
                light = 0.0;
            }
        }
        light
    });
    let found = run.results(&shade, &inputs)?.into_iter().map(|(name, found)| {
        let rmse = rmse(&expected, found.into_iter().map(f64::from));
        Found::whole(name, inputs.len(), rmse)
    });
    let outcome = Outcome::of_figures(found.collect());
    // The textbook's shadow rays begin at the point at the distance of the hit.
    let textbook = rmse(&expected, inputs.iter().map(|(ray, lamp)| textbook(&bvh, ray, *lamp)));
    Ok(outcome.beside(textbook))
}

fn textbook(bvh: &Bvh<'_, Triangle>, ray: &Ray, lamp: Vec3) -> f64 {
    let hit = bvh.closest_hit(*ray);
    if !hit.is_hit {
        return 0.5;
    }
    let normal = bvh.primitives()[hit.prim_id as usize].normal(*ray, hit);
    let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
    let point = ray.at(hit.t);
    let way = lamp - point;
    let cosine = normal.dot(way.normalize());
    let shadow = Ray::new(point, way).with_range(f32::EPSILON, 1.0);
    if cosine <= 0.0 || bvh.any_hit(shadow) { 0.0 } else { f64::from(cosine) }
}

fn rmse(expected: &[f64], found: impl Iterator<Item = f64>) -> f64 {
    let sum: f64 = expected.iter().zip(found).map(|(a, b)| (a - b).powi(2)).sum();
    (sum / expected.len() as f64).sqrt()
}
