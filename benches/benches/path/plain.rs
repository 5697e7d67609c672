//! A path tracer as one writes it without kernels, one path after another: the same estimator.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{Vec3A, vec3a};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray as TheirRay, RayHit};
use obvhs::triangle::Triangle as TheirTriangle;
use raydsl::camera::Camera;
use raydsl::prelude::*;

use crate::case::Case;

/// Density of uniform directions.
const SPHERE_PDF: f32 = 0.25 * FRAC_1_PI;

/// A triangle as rays meet it and as it is shaded.
struct Facet {
    v0: Vec3A,
    e1: Vec3A,
    e2: Vec3A,
    normal: Vec3A,
    color: Vec3A,
    radiance: Vec3A,
    /// Density with which a point of it is chosen as a light's, per area.
    density: f32,
}

impl Facet {
    /// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
    fn meet(&self, ray: &TheirRay) -> f32 {
        let p = ray.direction.cross(self.e2);
        let per_det = 1.0 / self.e1.dot(p);
        let from = ray.origin - self.v0;
        let u = from.dot(p) * per_det;
        if !(0.0..=1.0).contains(&u) {
            return f32::INFINITY;
        }
        let q = from.cross(self.e1);
        let v = ray.direction.dot(q) * per_det;
        let t = self.e2.dot(q) * per_det;
        let is_met = v >= 0.0 && u + v <= 1.0 && t >= ray.tmin && t <= ray.tmax;
        if is_met { t } else { f32::INFINITY }
    }
}

/// O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
/// Number Generation" (2014): PCG32.
struct Pcg(u64);

impl Pcg {
    const STEP: u64 = 6_364_136_223_846_793_005;

    fn new(seed: u64) -> Self {
        let mut rng = Self(seed.wrapping_mul(Self::STEP) ^ 0x853c_49e6_748f_ea9b);
        rng.next();
        rng
    }

    /// A number from 0 to below 1.
    fn next(&mut self) -> f32 {
        let state = self.0;
        self.0 = state.wrapping_mul(Self::STEP).wrapping_add(1_442_695_040_888_963_407);
        let bits = (((state >> 18) ^ state) >> 27) as u32;
        let bits = bits.rotate_right((state >> 59) as u32);
        (bits >> 8) as f32 * (1.0 / (1 << 24) as f32)
    }
}

/// The direction to a light, how far it is, its radiance and the density of the choice.
struct LightSample {
    wi: Vec3A,
    distance: f32,
    radiance: Vec3A,
    pdf: f32,
}

/// A scene with its tree.
pub(crate) struct Plain {
    tree: CwBvh,
    /// In the order of the tree's leaves.
    facets: Vec<Facet>,
    /// Those that shine, and the probability of choosing it or one before it.
    lamps: Vec<(usize, f32)>,
    sky: Vec3A,
    /// How far rays begin above a surface.
    offset: f32,
}

/// The power heuristic.
fn weight(pdf: f32, rival: f32) -> f32 {
    let ratio = rival / pdf;
    1.0 / (1.0 + ratio * ratio)
}

impl Plain {
    pub(crate) fn new(case: &Case) -> Self {
        assert!(case.sky == Vec3::ZERO || case.facets.iter().all(|f| f.radiance == Vec3::ZERO));
        let theirs =
            |[v0, v1, v2]: [Vec3; 3]| TheirTriangle { v0: v0.into(), v1: v1.into(), v2: v2.into() };
        let triangles: Vec<TheirTriangle> = case.facets.iter().map(|f| theirs(f.corners)).collect();
        let params = BvhBuildParams::very_slow_build();
        let tree = build_cwbvh_from_tris(&triangles, params, &mut Default::default());
        let mut facets: Vec<Facet> = Vec::new();
        for id in &tree.primitive_indices {
            let facet = &case.facets[*id as usize];
            let [v0, v1, v2] = facet.corners.map(Vec3A::from);
            let (e1, e2) = (v1 - v0, v2 - v0);
            let normal = e1.cross(e2).normalize_or_zero();
            let (color, radiance) = (facet.color.into(), facet.radiance.into());
            facets.push(Facet { v0, e1, e2, normal, color, radiance, density: 0.0 });
        }
        let area = |f: &Facet| 0.5 * f.e1.cross(f.e2).length();
        let power = |f: &Facet| area(f) * f.radiance.dot(vec3a(0.2126, 0.7152, 0.0722));
        let total: f32 = facets.iter().map(power).sum();
        let (mut lamps, mut sum) = (Vec::new(), 0.0);
        for (i, facet) in facets.iter_mut().enumerate().filter(|(_, f)| power(f) > 0.0) {
            let share = power(facet) / total;
            facet.density = share / area(facet);
            sum += share;
            lamps.push((i, sum));
        }
        let reach = |f: &Facet| f.v0.abs().max_element();
        let offset = 1e-5 * facets.iter().map(reach).fold(0.0, f32::max);
        Self { tree, facets, lamps, sky: case.sky.into(), offset }
    }

    fn closest(&self, origin: Vec3A, direction: Vec3A) -> Option<(f32, &Facet)> {
        let ray = TheirRay::new(origin, direction, 0.0, f32::MAX);
        let mut hit = RayHit::none();
        let is_hit = self.tree.ray_traverse(ray, &mut hit, |ray, i| self.facets[i].meet(ray));
        is_hit.then(|| (hit.t, &self.facets[hit.primitive_id as usize]))
    }

    fn is_occluded(&self, origin: Vec3A, direction: Vec3A, distance: f32) -> bool {
        let ray = TheirRay::new(origin, direction, 0.0, distance);
        !self.tree.ray_traverse_miss(ray, |ray, i| self.facets[i].meet(ray))
    }

    /// Chooses a direction to the sky, or to a point of a lamp.
    fn sample_light(&self, from: Vec3A, rng: &mut Pcg) -> Option<LightSample> {
        let (u, v, w) = (rng.next(), rng.next(), rng.next());
        if self.lamps.is_empty() {
            let (z, turn) = (1.0 - 2.0 * u, TAU * v);
            let (sin, cos) = turn.sin_cos();
            let radius = (1.0 - z * z).max(0.0).sqrt();
            let wi = vec3a(radius * cos, radius * sin, z);
            return Some(LightSample {
                wi,
                distance: f32::MAX,
                radiance: self.sky,
                pdf: SPHERE_PDF,
            });
        }
        let (lamp, _) = self.lamps.iter().find(|(_, sum)| w < *sum).or(self.lamps.last())?;
        let lamp = &self.facets[*lamp];
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let way = lamp.v0 + lamp.e1 * u + lamp.e2 * v - from;
        let distance = way.length();
        let wi = way / distance;
        let cos = -lamp.normal.dot(wi);
        let pdf = lamp.density * distance * distance / cos;
        let distance = distance * (1.0 - 1e-4);
        (cos > 0.0).then_some(LightSample { wi, distance, radiance: lamp.radiance, pdf })
    }

    /// The radiance along a ray by one path, scattered up to `bounces` times.
    fn path(&self, origin: Vec3A, direction: Vec3A, bounces: u32, rng: &mut Pcg) -> Vec3A {
        let (mut origin, mut direction) = (origin, direction);
        let (mut radiance, mut throughput) = (Vec3A::ZERO, Vec3A::ONE);
        let mut pdf = f32::INFINITY;
        for bounce in 0..=bounces {
            let Some((t, facet)) = self.closest(origin, direction) else {
                radiance += throughput * self.sky * weight(pdf, SPHERE_PDF);
                break;
            };
            let cos = facet.normal.dot(direction);
            if facet.density > 0.0 && cos < 0.0 {
                let rival = facet.density * t * t / -cos;
                radiance += throughput * facet.radiance * weight(pdf, rival);
            }
            if bounce == bounces {
                break;
            }
            let normal = if cos < 0.0 { facet.normal } else { -facet.normal };
            origin += direction * t + normal * self.offset;
            if let Some(light) = self.sample_light(origin, rng) {
                let own = normal.dot(light.wi) * FRAC_1_PI;
                if own > 0.0 && !self.is_occluded(origin, light.wi, light.distance) {
                    let share = weight(light.pdf, own) * own / light.pdf;
                    radiance += throughput * facet.color * light.radiance * share;
                }
            }
            let (radius, turn) = (rng.next(), TAU * rng.next());
            let (sin, cos) = turn.sin_cos();
            let (x, y) = normal.any_orthonormal_pair();
            let (height, radius) = ((1.0 - radius).sqrt(), radius.sqrt());
            direction = (x * (radius * cos) + y * (radius * sin) + normal * height).normalize();
            pdf = height / PI;
            throughput *= facet.color;
        }
        radiance
    }

    /// The picture, row by row from the bottom.
    pub(crate) fn render(
        &self,
        camera: &Pinhole,
        (size, samples): (u32, u32),
        bounces: u32,
        seed: u32,
    ) -> Vec<[f32; 3]> {
        let rays = camera.begin_frame(size, size);
        let (eye, corner) = (Vec3A::from(rays.origin), Vec3A::from(rays.corner));
        let (right, up) = (Vec3A::from(rays.right), Vec3A::from(rays.up));
        let mut picture = Vec::with_capacity((size * size) as usize);
        for y in 0..size {
            for x in 0..size {
                let mut rng = Pcg::new(u64::from(seed) << 32 | u64::from(y * size + x));
                let mut sum = Vec3A::ZERO;
                for _ in 0..samples {
                    let (x, y) = (x as f32 + rng.next(), y as f32 + rng.next());
                    let direction = (corner + right * x + up * y).normalize();
                    sum += self.path(eye, direction, bounces, &mut rng);
                }
                picture.push((sum / samples as f32).to_array());
            }
        }
        picture
    }
}
