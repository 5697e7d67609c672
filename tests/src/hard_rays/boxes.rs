//! Rays at boxes where a box test is easily wrong: none is lost.
//!
//! A [`Mark`] is met by the rays that name it, wherever they go. So a query finds it if and only if
//! the tests of all boxes above it let the ray through. Which rays must get there is decided in
//! `f64`, for numbers with which that is exact.

use raydsl::prelude::*;

use crate::queries::Answers;
use crate::rng::Rng;

/// A box that is met by the rays whose `t_max` has the bits of its key.
#[primitive]
#[derive(Debug)]
pub struct Mark {
    /// Lower corner.
    pub min: Vec3,
    /// The name.
    pub key: u32,
    /// Upper corner.
    pub max: Vec3,
    /// Nothing.
    pub padding: u32,
}

#[primitive]
impl Mark {
    // The least that a shape of the library has: boxes are widened by no more than by this.
    const SLACK: f32 = plane::SLACK;

    /// At 0, if the ray names it.
    pub fn intersect(&self, ray: Ray) -> Hit {
        let is_hit = ray.t_max.to_bits() == self.key;
        Hit::new(is_hit, 0.0)
    }

    /// The box.
    pub fn get_bounds(&self) -> Aabb {
        Aabb { min: self.min, max: self.max }
    }
}

impl Mark {
    /// Number `id`; its key is a number next to the largest.
    fn new(id: usize, min: Vec3, max: Vec3) -> Self {
        Self { min, key: f32::MAX.to_bits() - id as u32, max, padding: 0 }
    }

    /// Whether the ray from `origin` along `direction` meets the closed box. Exact where
    /// differences and quotients of coordinates are, else for all but one ray in 2^50.
    fn is_met(&self, origin: Vec3, direction: Vec3) -> bool {
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            let [o, d, low, high] =
                [origin[axis], direction[axis], self.min[axis], self.max[axis]].map(f64::from);
            if d == 0.0 {
                if o < low || o > high {
                    return false;
                }
                continue;
            }
            let (a, b) = ((low - o) / d, (high - o) / d);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        near <= far
    }
}

/// A way to make boxes, and rays at one of them.
pub struct Row {
    /// In words.
    pub name: &'static str,
    bounds: fn(&mut Rng) -> (Vec3, Vec3),
    ray: fn(&mut Rng, &Mark) -> (Vec3, Vec3),
}

/// What breaks other box tests.
pub const ROWS: [Row; 5] = [
    Row { name: "along an axis, from a face, with ±0", bounds: any_box, ray: along },
    Row { name: "flat boxes, in their plane", bounds: flat_box, ray: in_plane },
    Row { name: "components from 1e-9 to 1e-6", bounds: any_box, ray: nearly_along },
    Row { name: "through edges and corners", bounds: whole_box, ray: at_seam },
    Row { name: "size 1 at 1e5, through all of it", bounds: far_box, ray: at_seam },
];

/// Every row is done at these sizes: powers of two near 1e-15, 1e-8, 1, 1e8 and 1e15.
pub const EXPONENTS: [i32; 5] = [-50, -27, 0, 27, 50];

/// Boxes of one tree: few, so that it is small and boxes are widened by little.
const MARKS: usize = 6;

fn any_box(rng: &mut Rng) -> (Vec3, Vec3) {
    let (a, b) = (rng.point(1.0), rng.point(1.0));
    (a.min(b), a.max(b))
}

fn flat_box(rng: &mut Rng) -> (Vec3, Vec3) {
    let (min, mut max) = any_box(rng);
    let axis = rng.below(3);
    max[axis] = min[axis];
    (min, max)
}

/// A whole number of eighths, with few digits.
fn eighths(rng: &mut Rng, from: i32, to: i32) -> f32 {
    (from + rng.below((to - from) as usize) as i32) as f32 / 8.0
}

fn whole_box(rng: &mut Rng) -> (Vec3, Vec3) {
    let mut corner = || Vec3::from_array([(); 3].map(|()| eighths(rng, -64, 64)));
    let (a, b) = (corner(), corner());
    (a.min(b), a.max(b))
}

fn far_box(rng: &mut Rng) -> (Vec3, Vec3) {
    let mut at = || eighths(rng, -64, 64);
    let min = vec3(1e5, -1e5, 0.75e5) + vec3(at(), at(), at());
    (min, min + Vec3::ONE)
}

/// One of the signs of a zero.
fn zero(rng: &mut Rng) -> f32 {
    rng.pick(&[0.0, -0.0])
}

fn sign(rng: &mut Rng) -> f32 {
    rng.pick(&[1.0, -1.0])
}

/// A point of the box; on each axis at the lower face, at the upper one, or between.
fn point(rng: &mut Rng, mark: &Mark, is_at_face: impl Fn(&mut Rng) -> bool) -> Vec3 {
    let mut p = Vec3::ZERO;
    for axis in 0..3 {
        let (low, high) = (mark.min[axis], mark.max[axis]);
        p[axis] = match (is_at_face(rng), rng.below(2)) {
            (true, 0) => low,
            (true, _) => high,
            _ => (low + (high - low) * rng.unit()).clamp(low, high),
        };
    }
    p
}

fn along(rng: &mut Rng, mark: &Mark) -> (Vec3, Vec3) {
    let mut origin = point(rng, mark, |rng| rng.below(3) > 0);
    let axis = rng.below(3);
    let mut d = vec3(zero(rng), zero(rng), zero(rng));
    d[axis] = sign(rng) * rng.pick(&[1.0, 1e-3, 0.7, 1e5]);
    origin[axis] -= d[axis].signum() * rng.pick(&[0.0, 0.01, 1.0, 1000.0]);
    (origin, d)
}

fn in_plane(rng: &mut Rng, mark: &Mark) -> (Vec3, Vec3) {
    let target = point(rng, mark, |rng| rng.below(8) == 0);
    let mut d = rng.direction() * rng.pick(&[1.0, 1e-3, 1e3]);
    for axis in 0..3 {
        if mark.min[axis] == mark.max[axis] || rng.below(8) == 0 {
            d[axis] = zero(rng);
        }
    }
    if d == Vec3::ZERO {
        d = vec3(zero(rng), zero(rng), zero(rng));
        let flat = (0..3).find(|&axis| mark.min[axis] == mark.max[axis]).unwrap_or(0);
        d[(flat + 1) % 3] = 1.0;
    }
    (target - d * rng.pick(&[0.5, 2.0, 30.0]), d)
}

fn nearly_along(rng: &mut Rng, mark: &Mark) -> (Vec3, Vec3) {
    let target = point(rng, mark, |rng| rng.below(4) == 0);
    let mut small = || sign(rng) * 1e-9 * rng.range(0.0, 3.0 * std::f32::consts::LN_10).exp();
    let mut d = vec3(small(), small(), small());
    d[rng.below(3)] = sign(rng) * rng.pick(&[1.0, 0.37]);
    (target - d * rng.pick(&[0.0, 1.0, 7.0, 1000.0]), d)
}

/// At an edge or a corner, in numbers of few digits: where the ray touches the box is exact.
fn at_seam(rng: &mut Rng, mark: &Mark) -> (Vec3, Vec3) {
    let target = point(rng, mark, |_| true);
    let mut d = Vec3::ZERO;
    while d == Vec3::ZERO {
        d = Vec3::from_array([(); 3].map(|()| eighths(rng, -31, 32)));
    }
    let between = rng.below(4);
    let mut at = target;
    if between < 3 {
        let (low, high) = (mark.min[between], mark.max[between]);
        at[between] = low + ((high - low) * 8.0 * rng.unit()).floor() / 8.0;
    }
    (at - d * rng.pick(&[0.5, 1.0, 4.0, 16.0]), d)
}

/// A ray that must reach the mark that it names, where boxes are multiplied by `scale`.
pub fn ray(rng: &mut Rng, row: &Row, marks: &[Mark], scale: f32) -> Ray {
    loop {
        let mark = &marks[rng.below(marks.len())];
        let (origin, d) = (row.ray)(rng, mark);
        if mark.is_met(origin, d) {
            // Powers of two change no digit.
            let d = d * rng.pick(&[1.0, 1.0 / 1024.0, 4096.0]);
            return Ray::new(origin * scale, d).with_range(0.0, f32::from_bits(mark.key));
        }
    }
}

/// What textbooks test, in IEEE arithmetic and with nothing allowed for rounding: `1 / 0` is
/// infinite, and what is not a number is passed over.
pub fn textbook(marks: &[Mark], scale: f32, ray: &Ray) -> bool {
    let mark = &marks[id_of(ray) as usize];
    let inverse = ray.direction.recip();
    let a = (mark.min * scale - ray.origin) * inverse;
    let b = (mark.max * scale - ray.origin) * inverse;
    let near = a.min(b).max_element().max(ray.t_min);
    near <= a.max(b).min_element().min(ray.t_max)
}

/// The boxes of a tree, before they are multiplied by a scale.
pub fn marks(row: &Row, seed: u64) -> Vec<Mark> {
    let mut rng = Rng::new(seed);
    let mark = |id| {
        let (min, max) = (row.bounds)(&mut rng);
        Mark::new(id, min, max)
    };
    (0..MARKS).map(mark).collect()
}

/// Boxes of a row at one of its sizes, and rays that must reach them, with their answers.
pub fn answers(row: &Row, count: usize) -> Vec<(Vec<Mark>, Answers)> {
    let at_size = |exponent: i32| {
        let (marks, scale) = (marks(row, 0), 2.0f32.powi(exponent));
        let mut rng = Rng::of(row.name);
        let rays: Vec<Ray> = (0..count).map(|_| ray(&mut rng, row, &marks, scale)).collect();
        let hit = |ray: &Ray| Hit { prim_id: id_of(ray), ..Hit::new(true, 0.0) };
        let closest = rays.iter().map(hit).collect();
        let any = vec![true; rays.len()];
        (at_scale(&marks, scale), Answers { rays, closest, any })
    };
    EXPONENTS.into_iter().map(at_size).collect()
}

/// The number of the mark that a ray names.
fn id_of(ray: &Ray) -> u32 {
    f32::MAX.to_bits() - ray.t_max.to_bits()
}

/// The same boxes, smaller or larger.
pub fn at_scale(marks: &[Mark], scale: f32) -> Vec<Mark> {
    marks.iter().map(|m| Mark { min: m.min * scale, max: m.max * scale, ..*m }).collect()
}
