//! Instances that stretch, and planes through the camera.

use std::iter;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::volume::Cut;
use raydsl_tests::hard_rays::EPS;
use raydsl_tests::hard_rays::wide::{D3, cross, dot, minus, plus, wide};
use raydsl_tests::rng::Rng;

use super::super::fault;
use crate::outcome::Outcome;
use crate::row::{Bound, Row, Unit};

pub(super) fn rows() -> Vec<Row> {
    let mut all: Vec<Row> = [1.0, 1e2, 1e4, 1e6].map(stretched).into_iter().collect();
    all.push(planes("a cut plane through the camera", 1));
    all.push(planes("two such planes", 2));
    all
}

/// A turn at random.
fn turn(rng: &mut Rng) -> Mat3 {
    let x = rng.direction().normalize();
    let (y, z) = x.any_orthonormal_pair();
    Mat3::from_cols(x, y, z)
}

/// A point of the object in the scene, in `f64`.
fn placed(place: &Affine3, p: Vec3) -> D3 {
    let m = place.matrix3;
    let sum = plus(wide(place.translation), wide(m.x_axis), f64::from(p.x));
    plus(plus(sum, wide(m.y_axis), f64::from(p.y)), wide(m.z_axis), f64::from(p.z))
}

/// The distance of a hit, in eps times the amplification times the farthest coordinate, over the
/// cosine of the angle to the normal.
fn stretched(condition: f32) -> Row {
    let name = format!("instance of condition {condition:e}");
    let row = Row::new(name, 6, Unit::Times, Bound::all(16.0), move |run| {
        const PLACES: u64 = 4;
        let mut all = Outcome::default();
        for seed in 0..PLACES {
            let mut rng = Rng::new(seed);
            let triangles: Vec<Triangle> = iter::repeat_with(|| {
                let [v0, v1, v2] = [(); 3].map(|()| rng.point(1.0));
                Triangle { v0, v1, v2 }
            })
            .take(20)
            .collect();
            let stretch = vec3(1.0, condition.sqrt().recip(), condition.sqrt());
            let matrix3 = turn(&mut rng) * Mat3::from_diagonal(stretch) * turn(&mut rng);
            let place = Affine3 { matrix3, translation: rng.point(2.0) };
            let trees = [Bvh::build(&triangles)?];
            let scene = Instances::build(&trees, &[Instance::new(0, place)])?;
            let amplification = scene.amplification();
            let kernel = kernel!(|ray: Ray| scene.closest_hit(ray));
            let corners = |t: &Triangle| [t.v0, t.v1, t.v2].map(|v| placed(&place, v));
            let make = |rng: &mut Rng| {
                let [a, b, c] = corners(&rng.pick(&triangles));
                let (s, t) = (f64::from(rng.unit()), f64::from(rng.unit()));
                let target = plus(plus(a, minus(b, a), 0.5 * s), minus(c, a), 0.5 * t);
                let target = Vec3::from_array(target.map(|x| x as f32));
                let way = rng.direction() * (1.0 + target.length());
                (Ray::new(target + way, -way),)
            };
            let judge = |(ray,): &(Ray,), hit: &Hit| {
                let [a, b, c] = corners(triangles.get(hit.prim_id as usize)?);
                let n = cross(minus(b, a), minus(c, a));
                let (o, d) = (wide(ray.origin), wide(ray.direction));
                let along = dot(n, d);
                let t = dot(minus(a, o), n) / along;
                let length = dot(d, d).sqrt();
                let cosine = along.abs() / (length * dot(n, n).sqrt());
                let reach = [a, b, c, o].iter().map(|p| dot(*p, *p).sqrt()).fold(0.0, f64::max);
                let off = (f64::from(hit.t) - t).abs() * length * cosine;
                (hit.is_hit && cosine > 1e-3).then(|| off / (EPS * amplification * reach))
            };
            let part = run.part(1.0 / PLACES as f64, seed);
            let part = if seed == 0 { part } else { part.without_wgsl() };
            all.merge(run.unit, part.measure(&[kernel], make, judge)?);
        }
        Ok(all)
    });
    row.share(0.5)
}

/// A plane; what is behind it is inside.
#[primitive(plane(normal, offset))]
#[derive(Debug)]
struct Half {
    normal: Vec3,
    offset: f32,
}

#[kernel]
impl Surface for Half {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}

/// Planes through the camera: what is in front of them all is outside.
fn planes(name: &'static str, count: usize) -> Row {
    let row = Row::new(name, 7, Unit::Faults, Bound::NONE, move |run| {
        let eye = vec3(3.0, -2.0, 5.0);
        let through = |normal: Vec3| Half { normal, offset: normal.dot(eye) };
        // Whole numbers: the eye is exactly in both.
        let all = [vec3(1.0, 0.0, 0.0), vec3(-2.0, 1.0, 0.0)];
        let normals = &all[..count];
        let planes: Vec<Half> = normals.iter().map(|normal| through(*normal)).collect();
        let tool = &planes[..];
        let kernel = kernel!(|ray: Ray| {
            let mut inside = 0.0;
            let mut cut = Cut::new(tool, ray);
            while let Some(part) = cut.next_inside(tool) {
                inside += part.t_max - part.t_min;
            }
            let mut outside = 0.0;
            let mut cut = Cut::new(tool, ray);
            while let Some(part) = cut.next_outside(tool) {
                outside += part.t_max - part.t_min;
            }
            (inside, outside)
        });
        let make = |rng: &mut Rng| {
            let any = rng.direction();
            // Also in a plane, or along both.
            let d = rng.pick(&[any, any, vec3(0.0, any.y, any.z), vec3(1.0, 2.0, any.z), Vec3::Z]);
            (Ray::new(eye, d).with_range(0.0, 8.0),)
        };
        run.measure(&[kernel], make, |(ray,), &(inside, outside)| {
            // A plane that the ray lies in does not count: it is crossed nowhere.
            let is_inside = normals.iter().any(|n| n.dot(ray.direction) < 0.0);
            let expected = if is_inside { (8.0, 0.0) } else { (0.0, 8.0) };
            fault((inside, outside) != expected)
        })
    });
    let row = row.share(0.2);
    if count == 1 {
        return row;
    }
    row.misses(
        Bound::all(0.5),
        "Crossings alone do not tell whether a ray that leaves one half-space as it enters another \
         was outside of both before.",
    )
}
