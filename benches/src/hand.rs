//! What a good engineer writes by hand: one ray, one loop, no abstraction.
//!
//! The same nodes, the same hits bit for bit. Everything that depends on the ray alone is done
//! once a ray, children are visited near first, and what lies behind the best hit is left out.

use raydsl::bvh::{Bvh, Node};
use raydsl::geometry::Primitive;
use raydsl::prelude::*;

use crate::scenes::ColorSphere;

/// A primitive with a test written by hand.
pub trait ByHand: Primitive<Hit = Hit, Shared = ()> {
    /// What depends on the ray alone.
    type Prepared;
    /// Computes it.
    fn prepare<const AXIS: usize>(ray: &Ray) -> Self::Prepared;
    /// `t, u, v` of a hit in the ray's range; the ray runs fastest along `AXIS`.
    fn meet<const AXIS: usize>(&self, ray: &Ray, p: &Self::Prepared) -> Option<(f32, f32, f32)>;
}

/// One instruction, unlike `f32::min`, which cares for NaN.
#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The same for the larger.
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cold]
#[inline(never)]
fn exact(triangle: &Triangle, ray: &Ray) -> Option<(f32, f32, f32)> {
    let hit = triangle.intersect(*ray);
    let is_within = hit.is_hit && hit.t >= ray.t_min && hit.t <= ray.t_max;
    is_within.then_some((hit.t, hit.u, hit.v))
}

/// The shear that takes a ray onto its fastest axis.
pub struct Shear {
    x: f32,
    y: f32,
    dz: f32,
}

impl ByHand for Triangle {
    type Prepared = Shear;

    #[inline(always)]
    fn prepare<const AXIS: usize>(ray: &Ray) -> Shear {
        let d = ray.direction.to_array();
        let (x, y, dz) = (d[(AXIS + 1) % 3], d[(AXIS + 2) % 3], d[AXIS]);
        Shear { x: x / dz, y: y / dz, dz }
    }

    #[inline(always)]
    fn meet<const AXIS: usize>(&self, ray: &Ray, s: &Shear) -> Option<(f32, f32, f32)> {
        let sheared = |v: Vec3| {
            let a = (v - ray.origin).to_array();
            let z = a[AXIS];
            (a[(AXIS + 1) % 3] - s.x * z, a[(AXIS + 2) % 3] - s.y * z, z)
        };
        let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) =
            (sheared(self.v0), sheared(self.v1), sheared(self.v2));
        let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        // The ray passes between the vertices, whatever rounding says of the edges.
        let is_beside = (ax < 0.0 && bx < 0.0 && cx < 0.0)
            || (ax > 0.0 && bx > 0.0 && cx > 0.0)
            || (ay < 0.0 && by < 0.0 && cy < 0.0)
            || (ay > 0.0 && by > 0.0 && cy > 0.0);
        if is_beside {
            return None;
        }
        let sum = u + v + w;
        // Seen along its plane: exact products are needed, which nobody writes twice.
        let (near, far) = (min(min(az, bz), cz), max(max(az, bz), cz));
        let products = (cx * by).abs() + (ax * cy).abs() + (bx * ay).abs();
        if 2.0 * sum.abs() <= products * ((far - near) / max(near.abs(), far.abs())) {
            return exact(self, ray);
        }
        let t = (u / sum) * (az / s.dz) + (v / sum) * (bz / s.dz) + (w / sum) * (cz / s.dz);
        (t >= ray.t_min && t <= ray.t_max).then(|| (t, v / sum, w / sum))
    }
}

impl ByHand for ColorSphere {
    type Prepared = f32;

    #[inline(always)]
    fn prepare<const AXIS: usize>(ray: &Ray) -> f32 {
        1.0 / ray.direction.dot(ray.direction)
    }

    #[inline(always)]
    fn meet<const AXIS: usize>(&self, ray: &Ray, per_d2: &f32) -> Option<(f32, f32, f32)> {
        let radius = self.radius.to_f32();
        let f = self.center - ray.origin;
        let closest = f.dot(ray.direction) * per_d2;
        let aside = f - ray.direction * closest;
        let distance = aside.length();
        let radicand = (radius - distance) * (radius + distance);
        if radicand < 0.0 || radius <= 0.0 {
            return None;
        }
        let half = (radicand * per_d2).sqrt();
        let near = closest - half;
        let t = if near < ray.t_min { closest + half } else { near };
        (t >= ray.t_min && t <= ray.t_max).then_some((t, 0.0, 0.0))
    }
}

/// A ray's origin and reciprocal direction for box tests that never lose a hit.
struct Boxes {
    lower: Vec3,
    upper: Vec3,
    inverse: Vec3,
    t_min: f32,
}

impl Boxes {
    #[inline(always)]
    fn new(ray: &Ray, root: &Node, slack: f32) -> Self {
        let reach = (root.min - ray.origin).abs().max((root.max - ray.origin).abs());
        let pad = slack * reach.max_element();
        let safe = |d: f32| 1.0 / if d.abs() < 1e-18 { 1e-18f32.copysign(d) } else { d };
        let d = ray.direction;
        Self {
            lower: ray.origin + pad,
            upper: ray.origin - pad,
            inverse: vec3(safe(d.x), safe(d.y), safe(d.z)),
            t_min: ray.t_min,
        }
    }

    /// Where the ray enters the box, if it does before `limit`.
    #[inline(always)]
    fn enter(&self, node: &Node, limit: f32) -> Option<f32> {
        let t0 = (node.min - self.lower) * self.inverse;
        let t1 = (node.max - self.upper) * self.inverse;
        let near = max(max(min(t0.x, t1.x), min(t0.y, t1.y)), max(min(t0.z, t1.z), self.t_min));
        let far = min(min(max(t0.x, t1.x), max(t0.y, t1.y)), min(max(t0.z, t1.z), limit));
        (near <= far).then_some(near)
    }
}

/// The closest hit of `ray`.
#[inline(always)]
pub fn closest_hit<P: ByHand>(bvh: &Bvh<'_, P>, ray: &Ray) -> Hit {
    let a = ray.direction.abs();
    if a.x > a.y && a.x > a.z {
        walk::<P, 0>(bvh, ray)
    } else if a.y > a.z {
        walk::<P, 1>(bvh, ray)
    } else {
        walk::<P, 2>(bvh, ray)
    }
}

#[inline(never)]
fn walk<P: ByHand, const AXIS: usize>(bvh: &Bvh<'_, P>, ray: &Ray) -> Hit {
    let mut best = Hit::miss();
    let (nodes, indices, prims) = (bvh.nodes(), bvh.indices(), bvh.primitives());
    let Some(root) = nodes.first() else { return best };
    let boxes = Boxes::new(ray, root, P::SLACK);
    let prepared = P::prepare::<AXIS>(ray);
    let mut limit = ray.t_max;
    let mut stack = [(0u32, 0.0f32); 64];
    let mut top = 0;
    let mut node = root;
    loop {
        if node.count > 0 {
            for &id in &indices[node.first as usize..][..node.count as usize] {
                if let Some((t, u, v)) = prims[id as usize].meet::<AXIS>(ray, &prepared)
                    && (!best.is_hit || t < best.t || (t == best.t && id < best.prim_id))
                {
                    best = Hit { prim_id: id, u, v, ..Hit::new(true, t) };
                    limit = t + t.abs() * P::SLACK;
                }
            }
        } else {
            let pair = &nodes[node.first as usize..][..2];
            match (boxes.enter(&pair[0], limit), boxes.enter(&pair[1], limit)) {
                (Some(left), Some(right)) => {
                    let swap = right < left;
                    stack[top] = (node.first + u32::from(!swap), left.max(right));
                    top += 1;
                    node = &pair[usize::from(swap)];
                    continue;
                }
                (Some(_), None) => {
                    node = &pair[0];
                    continue;
                }
                (None, Some(_)) => {
                    node = &pair[1];
                    continue;
                }
                (None, None) => {}
            }
        }
        loop {
            if top == 0 {
                return best;
            }
            top -= 1;
            if stack[top].1 <= limit {
                break;
            }
        }
        node = &nodes[stack[top].0 as usize];
    }
}
