//! Rays at spheres from afar, at silhouettes, and at every scale.

use raydsl::Type;
use raydsl::prelude::*;
use raydsl_tests::hard_rays::EPS;
use raydsl_tests::hard_rays::wide::{D3, dot, minus, plus, wide};
use raydsl_tests::rng::Rng;
use raydsl_tests::scenes::ColorSphere;

use super::{FLUSHED, fault};
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "spheres",
    title: "Spheres, from afar and at every scale",
    clauses: &[
        "A ray hits a sphere if and only if it meets it, except within 4 eps of the distance of \
         the silhouette (eps = 2^-24); radii are 1e-18 to 1e19, and so are lengths of directions.",
        "A hit is off by at most 4 ulp of its distance, and by what 4 eps of the distance of the \
         centre change as a radius.",
        "A normal has unit length to 2 eps.",
        "A normal is off by at most 8 eps times distance over radius, and by what 4 eps of the \
         distance change as a radius.",
        "A sphere of 16 bytes is as large as its decoded radius, and with the code 0 is never hit.",
    ],
    rows,
};

/// Distances over the radius.
const FAR: [f32; 4] = [1e2, 1e3, 1e4, 1e5];

/// Radii, at ten times the radius.
const SCALES: [f32; 5] = [1e-18, 1e-10, 1.0, 1e10, 1e19];

fn rows() -> Vec<Row> {
    let mut all = Vec::new();
    all.extend(FAR.map(|far| decisions(format!("hit or not at {far:e} radii"), Spheres::at(far))));
    all.extend(SCALES.map(|radius| {
        let row = decisions(format!("hit or not, radius {radius:e}"), Spheres::of_radius(radius));
        let flushed = Bound { wgsl: 0.05, ..Bound::NONE };
        if radius == SCALES[0] { row.misses(flushed, FLUSHED) } else { row }
    }));
    all.extend(FAR.map(|far| distances(format!("distance at {far:e} radii"), Spheres::at(far))));
    all.extend(SCALES.map(|radius| {
        let row = distances(format!("distance, radius {radius:e}"), Spheres::of_radius(radius));
        let flushed = Bound { wgsl: f64::INFINITY, ..Bound::all(1.0) };
        if radius == SCALES[0] { row.misses(flushed, FLUSHED) } else { row }
    }));
    all.extend(FAR.map(lengths));
    all.extend(FAR.map(normals));
    all.push(color_spheres());
    all.push(color_sphere_bounds());
    all
}

/// What a kernel finds of a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(super) struct Met {
    pub(super) hit: Hit,
    pub(super) normal: Vec3,
}

/// Intersects a sphere.
pub(super) fn kernel() -> Kernel<'static, (Ray, Vec3, f32), Met> {
    kernel!(|ray: Ray, center: Vec3, radius: f32| {
        let hit = sphere::intersect(ray, center, radius);
        Met { hit, normal: sphere::normal(ray, hit, center, radius) }
    })
}

/// How inputs are made.
#[derive(Clone, Copy, Debug)]
struct Spheres {
    radius: f32,
    /// Of the ray's origin from the centre.
    distance: f32,
    /// Whether directions have unit length alone.
    is_unit: bool,
}

impl Spheres {
    fn at(far: f32) -> Self {
        Self { radius: 1.0, distance: far, is_unit: false }
    }

    /// Squares of other lengths leave the range of `f32`.
    fn of_radius(radius: f32) -> Self {
        Self { radius, distance: 10.0 * radius, is_unit: radius != 1.0 }
    }

    /// A ray at the sphere or past it, every other one near the silhouette.
    fn make(&self, rng: &mut Rng) -> (Ray, Vec3, f32) {
        let center = rng.point(2.0) * self.radius;
        let way = rng.direction().normalize();
        let across = way.any_orthonormal_pair();
        let (sin, cos) = rng.range(0.0, std::f32::consts::TAU).sin_cos();
        let near = 8.0 * self.distance / self.radius / 16_777_216.0;
        let aside = match rng.below(2) {
            0 => 1.5 * rng.unit().sqrt(),
            _ => 1.0 + rng.pick(&[near, 1e-3, 1e-2]) * rng.range(-4.0, 4.0),
        };
        let target = center + (across.0 * cos + across.1 * sin) * (aside * self.radius);
        let origin = center + way * self.distance;
        let unit = ((target - origin) / self.distance).normalize();
        let length = if self.is_unit { 1.0 } else { rng.pick(&[1.0, self.distance, 1e-3]) };
        (Ray::new(origin, unit * length), center, self.radius)
    }
}

/// A ray and a sphere in `f64`, and what is promised of them.
pub(super) struct Exact {
    /// From the centre to the line, at right angles.
    aside: D3,
    direction: D3,
    /// Where the line is next to the centre, in lengths of the direction.
    closest: f64,
    /// The length of the direction.
    length: f64,
    radius: f64,
    /// What the radius may be off by.
    ring: f64,
    /// Distance of the centre over the radius.
    far: f64,
}

impl Exact {
    pub(super) fn of(&(ray, center, radius): &(Ray, Vec3, f32)) -> Self {
        let (f, d) = (minus(wide(center), wide(ray.origin)), wide(ray.direction));
        let (closest, distance) = (dot(f, d) / dot(d, d), dot(f, f).sqrt());
        let aside = plus(f, d, -closest);
        let radius = f64::from(radius);
        let ring = 4.0 * EPS * distance;
        let length = dot(d, d).sqrt();
        Self { aside, direction: d, closest, length, radius, ring, far: distance / radius }
    }

    fn distance(&self) -> f64 {
        dot(self.aside, self.aside).sqrt()
    }

    /// Whether the ray meets the sphere in front of its origin; `None` in the ring.
    pub(super) fn is_met(&self) -> Option<bool> {
        let distance = self.distance();
        let is_clear = (distance - self.radius).abs() > self.ring;
        is_clear.then(|| distance < self.radius && self.closest + self.half(0.0) > 0.0)
    }

    /// Half of the chord of a sphere whose radius is larger by `more`, in lengths of the direction.
    fn half(&self, more: f64) -> f64 {
        let (radius, distance) = (self.radius + more, self.distance());
        ((radius - distance) * (radius + distance)).max(0.0).sqrt() / self.length
    }

    /// What the ring changes in half a chord.
    fn of_silhouette(&self) -> f64 {
        let half = self.half(0.0);
        (self.half(self.ring) - half).max(half - self.half(-self.ring))
    }

    /// The error of a hit's distance, over what is allowed.
    pub(super) fn error_of_distance(&self, hit: &Hit) -> f64 {
        self.error_of(hit.t.into())
    }

    /// The same of a distance in `f64`.
    fn error_of(&self, t: f64) -> f64 {
        let half = self.half(0.0);
        let off = [self.closest - half, self.closest + half].map(|exact| (t - exact).abs());
        let rounded = t.abs() as f32;
        let ulp = f64::from(rounded.next_up()) - f64::from(rounded);
        off[0].min(off[1]) / (4.0 * ulp + self.of_silhouette())
    }

    /// The error of the normal of a hit, over what is allowed.
    fn error_of_normal(&self, met: &Met) -> f64 {
        let t = f64::from(met.hit.t);
        let half = self.half(0.0);
        let is_far = (t - self.closest).abs() > 0.0 && t > self.closest;
        let along = if is_far { half } else { -half };
        let out = plus(self.aside.map(|x| -x), self.direction, along);
        let length = dot(out, out).sqrt();
        let off = minus(wide(met.normal), out.map(|x| x / length));
        let of_silhouette = self.of_silhouette() * self.length / self.radius;
        dot(off, off).sqrt() / (8.0 * EPS * self.far + of_silhouette)
    }
}

/// The quadratic formula, as it stands in textbooks: distance of the nearer point, if there is one.
fn textbook(&(ray, center, radius): &(Ray, Vec3, f32)) -> Option<f32> {
    let (f, d) = (ray.origin - center, ray.direction);
    let (a, b, c) = (d.dot(d), 2.0 * f.dot(d), f.dot(f) - radius * radius);
    let radicand = b * b - 4.0 * a * c;
    (radicand >= 0.0).then(|| (-b - radicand.sqrt()) / (2.0 * a))
}

fn decisions(name: String, spheres: Spheres) -> Row {
    Row::new(name, 1, Unit::Faults, Bound::NONE, move |run| {
        let make = |rng: &mut Rng| spheres.make(rng);
        let outcome = run.measure(&[kernel()], make, |input, met| {
            fault(met.hit.is_hit != Exact::of(input).is_met()?)
        })?;
        let wrong = run.broken_by(run.count / 100, |rng| {
            let input = spheres.make(rng);
            Exact::of(&input).is_met().is_some_and(|is_met| textbook(&input).is_some() != is_met)
        });
        Ok(outcome.beside(wrong))
    })
}

fn distances(name: String, spheres: Spheres) -> Row {
    // At a silhouette the square root of eps counts: that of `f64` is 4e-5 of that of `f32`.
    let bound = Bound { f64: 1e-4, ..Bound::all(1.0) };
    Row::new(name, 2, Unit::Times, bound, move |run| {
        let make = |rng: &mut Rng| spheres.make(rng);
        let mut outcome = run.measure(&[kernel()], make, |input, met| {
            met.hit.is_hit.then(|| Exact::of(input).error_of_distance(&met.hit))
        })?;
        // `is_hit` and `t` come first.
        outcome.found.extend(run.in_f64(&kernel(), make, |input, met| {
            (met[0] != 0.0).then(|| Exact::of(input).error_of(met[1]))
        }));
        let mut rng = Rng::new(run.seed);
        let errors = (0..1000).filter_map(|_| {
            let input = spheres.make(&mut rng);
            let hit = Hit::new(true, textbook(&input)?);
            Some(Exact::of(&input).error_of_distance(&hit))
        });
        Ok(outcome.beside(errors.fold(0.0, f64::max)))
    })
}

/// The length of a normal, in eps.
fn lengths(far: f32) -> Row {
    let name = format!("length of a normal at {far:e} radii");
    let row = Row::new(name, 3, Unit::Times, Bound::all(2.0), move |run| {
        let spheres = Spheres::at(far);
        run.measure(
            &[kernel()],
            |rng| spheres.make(rng),
            |_, met| {
                let n = wide(met.normal);
                met.hit.is_hit.then(|| (dot(n, n).sqrt() - 1.0).abs() / EPS)
            },
        )
    });
    row.misses(
        Bound::all(3.2),
        "A normal is the offset from the centre over its length: the sum of squares, the root and the \
         quotients are rounded.",
    )
}

/// The textbook's normal is that of the point at the distance of the hit.
fn normals(far: f32) -> Row {
    let name = format!("normal at {far:e} radii");
    Row::new(name, 4, Unit::Times, Bound::all(1.0), move |run| {
        let spheres = Spheres::at(far);
        let kernel = kernel();
        let outcome = run.measure(
            std::slice::from_ref(&kernel),
            |rng| spheres.make(rng),
            |input, met| met.hit.is_hit.then(|| Exact::of(input).error_of_normal(met)),
        )?;
        let mut rng = Rng::new(run.seed);
        let errors = (0..1000).filter_map(|_| {
            let input = spheres.make(&mut rng);
            let met = kernel.call(input);
            let normal = (input.0.at(met.hit.t) - input.1).normalize();
            met.hit.is_hit.then(|| Exact::of(&input).error_of_normal(&Met { normal, ..met }))
        });
        Ok(outcome.beside(errors.fold(0.0, f64::max)))
    })
}

/// One of every radius, apart from one another.
fn every_code() -> Vec<ColorSphere> {
    let sphere = |code: u8| ColorSphere {
        center: vec3(f32::from(code % 16), f32::from(code / 16), 0.5 * f32::from(code % 3)) * 3.0,
        radius: Unorm8::from_bits(code),
        color: [Unorm8::from_bits(code); 3],
    };
    (0..=255).map(sphere).collect()
}

fn color_spheres() -> Row {
    let row = Row::new("16 bytes, every radius", 5, Unit::Faults, Bound::NONE, |run| {
        let spheres = every_code();
        let bvh = Bvh::build(&spheres)?;
        let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
        let make = |rng: &mut Rng| {
            let sphere = &spheres[if rng.below(4) == 0 { 0 } else { rng.below(256) }];
            let out = rng.direction().normalize();
            // At the middle, or at about the silhouette.
            let aside = out * (sphere.radius.to_f32() * rng.pick(&[0.0, 0.5, 0.99, 1.01]));
            let way = rng.direction().cross(out).normalize_or(Vec3::X);
            let origin = sphere.center + aside - way * rng.range(1.0, 60.0);
            (Ray::new(origin, way * rng.pick(&[1.0, 7.0])),)
        };
        run.measure(&[kernel], make, |(ray,), hit| {
            if hit.is_hit && spheres[hit.prim_id as usize].radius.to_bits() == 0 {
                return fault(true);
            }
            let mut nearest: Option<(f64, u32)> = None;
            for (id, sphere) in (1..).zip(&spheres[1..]) {
                let exact = Exact::of(&(*ray, sphere.center, sphere.radius.to_f32()));
                let t = exact.closest - exact.half(0.0);
                if exact.is_met()? && nearest.is_none_or(|(least, _)| t < least) {
                    nearest = Some((t, id));
                }
            }
            fault(nearest.map(|(_, id)| id) != hit.is_hit.then_some(hit.prim_id))
        })
    });
    row.share(0.1)
}

/// The box of a sphere has the decoded radius in it, and is no more than an ulp larger.
fn color_sphere_bounds() -> Row {
    Row::new("16 bytes, boxes", 5, Unit::Faults, Bound::NONE, |run| {
        Ok(run.on_host(|rng| {
            let size = 10f32.powi(rng.below(7) as i32 - 3);
            let center = rng.point(size);
            let code = rng.bits() as u8;
            let sphere = ColorSphere {
                center,
                radius: Unorm8::from_bits(code),
                color: [Unorm8::from_bits(0); 3],
            };
            let bounds = sphere.get_bounds();
            let radius = f64::from(sphere.radius.to_f32());
            let decoded = f64::from(code) / 255.0;
            let holds = (0..3).all(|i| {
                let (low, high) = (f64::from(center[i]) - radius, f64::from(center[i]) + radius);
                let (min, max) = (bounds.min[i], bounds.max[i]);
                f64::from(min) <= low
                    && high <= f64::from(max)
                    && f64::from(min.next_up().next_up()) >= low
                    && f64::from(max.next_down().next_down()) <= high
            });
            let is_wrong = !holds || (radius - decoded).abs() > EPS * decoded;
            (f64::from(u8::from(is_wrong)), format!("{sphere:?}"))
        }))
    })
}
