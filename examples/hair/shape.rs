//! A hair that knows where a ray meets it.

use raydsl::kernel;
use raydsl::prelude::*;

// ANCHOR: struct
/// A hair: a disc that goes along a Bezier curve, across it, and changes its size on the way.
#[primitive]
#[derive(Debug)]
pub(crate) struct Hair {
    /// The curve's control points, from the root to the tip.
    pub(crate) control: [Vec3; 4],
    /// The disc's radius at the root.
    pub(crate) root: f32,
    /// And at the tip.
    pub(crate) tip: f32,
}

/// What a ray finds.
#[derive(Clone, Copy, Debug, PartialEq, Type, HitRecord)]
pub(crate) struct HairHit {
    /// Where it enters the hair.
    pub(crate) hit: Hit,
    /// The curve's parameter: 0 at the root and 1 at the tip.
    pub(crate) share: f32,
    /// Which way the hair goes.
    pub(crate) tangent: Vec3,
}
// ANCHOR_END: struct

/// A cubic, as the factors of 1, u, u² and u³.
#[derive(Clone, Copy, Debug, Type)]
struct Cubic {
    start: Vec3,
    a: Vec3,
    b: Vec3,
    c: Vec3,
}

#[kernel]
impl Cubic {
    fn at(&self, u: f32) -> Vec3 {
        self.start + (self.a + (self.b + self.c * u) * u) * u
    }

    fn derivative(&self, u: f32) -> Vec3 {
        self.a + (self.b * 2.0 + self.c * (3.0 * u)) * u
    }
}

// ANCHOR: phantom
/// Where a ray along z through the origin enters a cone, measured along z from the cone's middle;
/// and how far that is beside the middle, as a share of `along`.
#[derive(Clone, Copy, Debug, Type)]
struct Entry {
    is_met: bool,
    z: f32,
    share: f32,
}

/// The cone around `middle` along `along`, whose radius grows from `radius` by `growth` a length.
#[kernel]
fn enter(middle: Vec3, along: Vec3, radius: f32, growth: f32) -> Entry {
    let (c, d) = (middle.truncate(), along.truncate());
    let (offset, slope) = (c.dot(d), radius * growth);
    let square = d.dot(d);
    let whole = square + along.z * along.z;
    let moment = c.perp_dot(d);
    let rest = c.dot(c) * along.z * along.z - radius * radius * whole;
    let p = rest + moment * moment + 2.0 * slope * offset;
    let q = along.z * (slope - offset);
    let radicand = q * q - p * square;
    let root = max(radicand, 0.0).sqrt();
    // The smaller root of `square z² - 2 q z + p`, without cancellation.
    let z = if q > 0.0 { p / (q + root) } else { (q - root) / square };
    Entry { is_met: radicand > 0.0, z, share: (z * along.z - offset) / whole }
}
// ANCHOR_END: phantom

#[primitive]
impl Hair {
    /// The curve is moved by at most 8 u of the distance (u = 2^-24), and a point of a cone within
    /// a twenty thousandth of its curve is as close to the hair.
    const SLACK: f32 = 1.0 / 262_144.0;

    // ANCHOR: intersect
    /// Reshetov and Luebke, "Phantom Ray-Hair Intersector" (HPG 2018): the cone that touches the
    /// hair at `u` says where to look next. From either end, since a ray may enter twice.
    ///
    /// The hair is seen from outside: a ray that starts in it does not meet its far side.
    pub(crate) fn intersect(&self, ray: Ray) -> HairHit {
        let scale = ray.direction.abs().max_element();
        let length = (ray.direction / scale).length();
        let forward = ray.direction / scale / length;
        let (right, up) = forward.any_orthonormal_pair();
        let frame = Mat3::from_cols(right, up, forward).transpose();
        let origin = frame * (self.control[0] - ray.origin);
        let p1 = frame * (self.control[1] - self.control[0]);
        let p2 = frame * (self.control[2] - self.control[0]);
        let p3 = frame * (self.control[3] - self.control[0]);

        // The control points are around the curve: in a box, and in a strip along its chord.
        let start = vec3(origin.x, origin.y, 0.0);
        let low = start + min(min(p1, p2), min(p3, Vec3::ZERO));
        let high = start + max(max(p1, p2), max(p3, Vec3::ZERO));
        let wide = max(self.root, self.tip);
        let is_in_box = max(low.x, low.y) <= wide && min(high.x, high.y) >= -wide;
        let chord = p3.truncate();
        let (beside1, beside2) = (chord.perp_dot(p1.truncate()), chord.perp_dot(p2.truncate()));
        let (beside, edge) = (chord.perp_dot(-start.truncate()), wide * chord.length());
        let is_in_strip = beside >= min(min(beside1, beside2), 0.0) - edge
            && beside <= max(max(beside1, beside2), 0.0) + edge;
        if !(is_in_box && is_in_strip && wide > 0.0) {
            return HairHit { hit: Hit::miss(), share: 0.0, tangent: Vec3::ZERO };
        }

        let b = (p2 - p1 * 2.0) * 3.0;
        let curve = Cubic { start, a: p1 * 3.0, b, c: p3 + (p1 - p2) * 3.0 };
        let growth = self.tip - self.root;
        let mut best = Hit::miss();
        for end in 0..2u32 {
            let mut u = end as f32;
            let (mut last_u, mut last_step) = (0.0, 0.0);
            for i in 0..32u32 {
                let middle = curve.at(u);
                let radius = self.root + growth * u;
                let entry = enter(middle, curve.derivative(u), radius, growth);
                if entry.is_met && entry.share.abs() < 5e-5 {
                    let t = (origin.z + (middle.z + entry.z)) / length / scale;
                    if t >= ray.t_min && !(best.is_hit && best.t <= t) {
                        best = Hit { u, ..Hit::new(true, t) };
                    }
                    break;
                }
                let step = clamp(entry.share, -0.5, 0.5);
                let before = u;
                if step * last_step < 0.0 {
                    // Between the two, by regula falsi, and now and then in the middle.
                    let between = (step * last_u - last_step * u) / (step - last_step);
                    u = if i % 4 == 0 { 0.5 * (last_u + u) } else { between };
                } else {
                    u += step;
                }
                (last_u, last_step) = (before, step);
                if u != clamp(u, 0.0, 1.0) {
                    break;
                }
            }
        }
        HairHit { hit: best, share: best.u, tangent: self.tangent(best.u) }
    }
    // ANCHOR_END: intersect

    /// Which way the hair goes at `u`, with length 1.
    fn tangent(&self, u: f32) -> Vec3 {
        let [p0, p1, p2, p3] = self.control;
        let (a, b, c) = (p1 - p0, p2 - p1, p3 - p2);
        let v = 1.0 - u;
        (a * (v * v) + b * (2.0 * u * v) + c * (u * u)).normalize()
    }

    // ANCHOR: bounds
    pub(crate) fn get_bounds(&self) -> Aabb {
        pieces(self).fold(Aabb::EMPTY, Aabb::union)
    }

    /// Each piece of the curve is cut.
    pub(crate) fn split_primitive(&self, axis: usize, at: f32) -> (Aabb, Aabb) {
        let cut = |sides: (Aabb, Aabb), piece: Aabb| {
            let parts = piece.split(axis, at);
            let join = |a: Aabb, b: Aabb| if b.is_valid() { a.union(b) } else { a };
            (join(sides.0, parts.0), join(sides.1, parts.1))
        };
        pieces(self).fold((Aabb::EMPTY, Aabb::EMPTY), cut)
    }
    // ANCHOR_END: bounds
}

// ANCHOR: pieces
/// Boxes around pieces of the hair: around their control points, as far as the hair is wide there.
fn pieces(hair: &Hair) -> impl Iterator<Item = Aabb> {
    const COUNT: u32 = 8;
    let hair = *hair;
    let control = hair.control.map(|p| p.to_array().map(f64::from));
    // The blossom of the curve: its control points between u and v are those of (u, u, u),
    // (u, u, v), (u, v, v) and (v, v, v).
    let blossom = move |i: usize, u: [f64; 3]| {
        let mut p = control.map(|p| p[i]);
        for (k, u) in u.into_iter().enumerate() {
            for j in 0..3 - k {
                p[j] += (p[j + 1] - p[j]) * u;
            }
        }
        p[0]
    };
    (0..COUNT).map(move |piece| {
        let (u, v) = (f64::from(piece) / f64::from(COUNT), f64::from(piece + 1) / f64::from(COUNT));
        let radius = |u: f64| f64::from(hair.root) * (1.0 - u) + f64::from(hair.tip) * u;
        let wide = radius(u).max(radius(v)).max(0.0);
        let ends = |i: usize| {
            let all = [[u, u, u], [u, u, v], [u, v, v], [v, v, v]].map(|at| blossom(i, at));
            let low = all.into_iter().fold(f64::INFINITY, f64::min) - wide;
            let high = all.into_iter().fold(f64::NEG_INFINITY, f64::max) + wide;
            ((low as f32).next_down(), (high as f32).next_up())
        };
        let [x, y, z] = [0, 1, 2].map(ends);
        Aabb::new(vec3(x.0, y.0, z.0), vec3(x.1, y.1, z.1))
    })
}
// ANCHOR_END: pieces
