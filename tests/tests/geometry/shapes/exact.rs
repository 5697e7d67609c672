//! The shapes in `f64`, by their implicit equations: all that a line meets, and what can be said of
//! the surface in closed form.

use std::f64::consts::PI;

pub(crate) type D3 = [f64; 3];

pub(crate) fn dot(a: D3, b: D3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn minus(a: D3, b: D3) -> D3 {
    std::array::from_fn(|i| a[i] - b[i])
}

/// `a + b * s`.
pub(crate) fn along(a: D3, b: D3, s: f64) -> D3 {
    std::array::from_fn(|i| a[i] + b[i] * s)
}

pub(crate) fn cross(a: D3, b: D3) -> D3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

pub(crate) fn length(a: D3) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn unit(a: D3) -> D3 {
    let l = length(a);
    a.map(|x| x / l)
}

/// A shape.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Exact {
    Sphere { center: D3, radius: f64 },
    Triangle([D3; 3]),
    Quad([D3; 4]),
    Disk { center: D3, normal: D3, radius: f64 },
    Plane { normal: D3, offset: f64 },
    Cylinder { p0: D3, p1: D3, radius: f64, has_caps: bool },
    Cone { base: D3, apex: D3, radius: f64 },
    Cuboid { min: D3, max: D3 },
}

/// A point of a line on a surface: its distance, and the normal there.
pub(crate) type Meeting = (f64, D3);

/// The roots of `a t² + 2 b t + c`.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let radicand = b * b - a * c;
    if radicand < 0.0 || (a == 0.0 && b == 0.0) {
        return Vec::new();
    }
    let q = if b > 0.0 { -b - radicand.sqrt() } else { radicand.sqrt() - b };
    let mut all = Vec::new();
    if a != 0.0 {
        all.push(q / a);
    }
    if q != 0.0 {
        all.push(c / q);
    }
    all
}

/// The normal of a triangle.
pub(crate) fn normal_of(v: [D3; 3]) -> D3 {
    unit(cross(minus(v[1], v[0]), minus(v[2], v[0])))
}

fn triangle(o: D3, d: D3, v: [D3; 3]) -> Option<Meeting> {
    let (e1, e2, w) = (minus(v[1], v[0]), minus(v[2], v[0]), minus(o, v[0]));
    // Cramer's rule for `w + t d = u e1 + v e2`.
    let n = cross(e1, e2);
    let det = -dot(d, n);
    let (u, v) = (dot(cross(w, e2), d) / -det, dot(cross(e1, w), d) / -det);
    let t = dot(w, n) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t.is_finite()).then(|| (t, unit(n)))
}

/// How far `p` is from the triangle, to within a factor of 2.
fn off_triangle(p: D3, v: [D3; 3]) -> f64 {
    let n = normal_of(v);
    let beside = (0..3).map(|i| {
        let edge = minus(v[(i + 1) % 3], v[i]);
        dot(minus(p, v[i]), unit(cross(edge, n)))
    });
    beside.fold(dot(minus(p, v[0]), n).abs(), f64::max)
}

/// The area of a triangle, and its centre of gravity.
fn area_of(v: [D3; 3]) -> (f64, D3) {
    let area = 0.5 * length(cross(minus(v[1], v[0]), minus(v[2], v[0])));
    (area, along(along(v[0], v[1], 1.0), v[2], 1.0).map(|x| x / 3.0))
}

fn disk(o: D3, d: D3, center: D3, normal: D3, radius: f64) -> Option<Meeting> {
    let t = dot(minus(center, o), normal) / dot(d, normal);
    let is_in = length(minus(along(o, d, t), center)) <= radius;
    (is_in && t.is_finite()).then(|| (t, unit(normal)))
}

fn cylinder(o: D3, d: D3, p0: D3, axis: D3, radius: f64) -> Vec<Meeting> {
    let (w, a2) = (minus(o, p0), dot(axis, axis));
    let (m, n) = (cross(w, axis), cross(d, axis));
    let found = roots(dot(n, n), dot(m, n), dot(m, m) - radius * radius * a2).into_iter();
    let meeting = |t| {
        let v = along(w, d, t);
        let z = dot(v, axis) / a2;
        (0.0..=1.0).contains(&z).then(|| (t, unit(along(v, axis, -z))))
    };
    found.filter_map(meeting).collect()
}

/// `(v·a)² (h² + r²) = v² h⁴`, with `v` from the apex and `a` from there to the base.
fn cone(o: D3, d: D3, apex: D3, a: D3, radius: f64) -> Vec<Meeting> {
    let (v, h2) = (minus(o, apex), dot(a, a));
    let slant2 = h2 + radius * radius;
    let form = |x: D3, y: D3| dot(x, a) * dot(y, a) * slant2 - dot(x, y) * h2 * h2;
    let meeting = |t| {
        let v = along(v, d, t);
        let z = dot(v, a) / h2;
        let outwards = unit(along(v, a, -z));
        let normal = unit(along(outwards, a, -radius / h2));
        (0.0..=1.0).contains(&z).then_some((t, normal))
    };
    roots(form(d, d), form(v, d), form(v, v)).into_iter().filter_map(meeting).collect()
}

fn cuboid(o: D3, d: D3, min: D3, max: D3) -> Vec<Meeting> {
    let mut all = Vec::new();
    for axis in 0..3 {
        // The two faces of a flat one are one, and it faces the ray.
        let is_flat = min[axis] == max[axis];
        let lower = if is_flat { -d[axis].signum() } else { -1.0 };
        for (face, sign) in
            [(min[axis], lower), (max[axis], 1.0)].into_iter().take(2 - usize::from(is_flat))
        {
            let t = (face - o[axis]) / d[axis];
            let p = along(o, d, t);
            let is_in = |i: usize| i == axis || (min[i] <= p[i] && p[i] <= max[i]);
            if t.is_finite() && (0..3).all(is_in) {
                let mut normal = [0.0; 3];
                normal[axis] = sign;
                all.push((t, normal));
            }
        }
    }
    all
}

impl Exact {
    /// All points of the line `o + t d` on the surface.
    fn meetings(&self, o: D3, d: D3) -> Vec<Meeting> {
        match *self {
            Self::Sphere { center, radius } => {
                let f = minus(o, center);
                let found = roots(dot(d, d), dot(f, d), dot(f, f) - radius * radius);
                found.into_iter().map(|t| (t, unit(along(f, d, t)))).collect()
            }
            Self::Triangle(v) => triangle(o, d, v).into_iter().collect(),
            Self::Quad([a, b, c, e]) => {
                let halves = [triangle(o, d, [a, b, e]), triangle(o, d, [c, e, b])];
                halves.into_iter().flatten().collect()
            }
            Self::Disk { center, normal, radius } => {
                disk(o, d, center, normal, radius).into_iter().collect()
            }
            Self::Plane { normal, offset } => {
                let t = (offset - dot(o, normal)) / dot(d, normal);
                if t.is_finite() { vec![(t, unit(normal))] } else { Vec::new() }
            }
            Self::Cylinder { p0, p1, radius, has_caps } => {
                let axis = minus(p1, p0);
                let mut all = cylinder(o, d, p0, axis, radius);
                if has_caps {
                    all.extend(disk(o, d, p0, axis.map(|x| -x), radius));
                    all.extend(disk(o, d, p1, axis, radius));
                }
                all
            }
            Self::Cone { base, apex, radius } => {
                let axis = minus(base, apex);
                let mut all = cone(o, d, apex, axis, radius);
                all.extend(disk(o, d, base, axis, radius));
                all
            }
            Self::Cuboid { min, max } => cuboid(o, d, min, max),
        }
    }

    /// The nearest of them from `t_min` to `t_max`.
    pub(crate) fn nearest(&self, o: D3, d: D3, range: [f64; 2]) -> Option<Meeting> {
        let is_in = |m: &Meeting| range[0] <= m.0 && m.0 <= range[1];
        self.meetings(o, d).into_iter().filter(is_in).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Whether it is the surface of a convex body, with normals outwards.
    pub(crate) fn is_body(&self) -> bool {
        match self {
            Self::Sphere { .. } | Self::Cone { .. } | Self::Cuboid { .. } => true,
            Self::Cylinder { has_caps, .. } => *has_caps,
            _ => false,
        }
    }

    /// How far `p` is from the surface, to within a factor of 2.
    pub(crate) fn distance(&self, p: D3) -> f64 {
        let on_disk = |center: D3, normal: D3, radius: f64| {
            let f = minus(p, center);
            dot(f, unit(normal)).abs().max(length(f) - radius)
        };
        match *self {
            Self::Sphere { center, radius } => (length(minus(p, center)) - radius).abs(),
            Self::Triangle(v) => off_triangle(p, v),
            Self::Quad([a, b, c, e]) => off_triangle(p, [a, b, e]).min(off_triangle(p, [c, e, b])),
            Self::Disk { center, normal, radius } => on_disk(center, normal, radius),
            Self::Plane { normal, offset } => (dot(p, normal) - offset).abs() / length(normal),
            Self::Cylinder { p0, p1, radius, has_caps } => {
                let axis = minus(p1, p0);
                let (v, h) = (minus(p, p0), length(axis));
                let z = dot(v, unit(axis));
                let side = (length(along(v, unit(axis), -z)) - radius).abs().max(-z).max(z - h);
                let cap = on_disk(p0, axis, radius).min(on_disk(p1, axis, radius));
                if has_caps { side.min(cap) } else { side }
            }
            Self::Cone { base, apex, radius } => {
                let axis = minus(base, apex);
                let (v, h) = (minus(p, apex), length(axis));
                let z = dot(v, unit(axis));
                let lateral = length(along(v, unit(axis), -z)) - radius / h * z;
                let side = (lateral * h / h.hypot(radius)).abs().max(-z).max(z - h);
                side.min(on_disk(base, axis, radius))
            }
            Self::Cuboid { min, max } => {
                let inside = (0..3).map(|i| (p[i] - min[i]).min(max[i] - p[i]));
                inside.fold(f64::INFINITY, f64::min).abs()
            }
        }
    }

    /// The area of the surface and its centre of gravity.
    pub(crate) fn area(&self) -> (f64, D3) {
        match *self {
            Self::Sphere { center, radius } => (4.0 * PI * radius * radius, center),
            Self::Triangle(v) => area_of(v),
            Self::Quad([a, b, c, e]) => weighted(&[area_of([a, b, e]), area_of([c, e, b])]),
            Self::Disk { center, radius, .. } => (PI * radius * radius, center),
            // Its samples lie around the foot of the world's origin.
            Self::Plane { normal, offset } => {
                (f64::INFINITY, normal.map(|n| n * offset / dot(normal, normal)))
            }
            Self::Cylinder { p0, p1, radius, has_caps } => {
                let caps = if has_caps { 2.0 * PI * radius * radius } else { 0.0 };
                let side = 2.0 * PI * radius * length(minus(p1, p0));
                (side + caps, along(p0, minus(p1, p0), 0.5))
            }
            Self::Cone { base, apex, radius } => {
                let axis = minus(base, apex);
                let side = PI * radius * length(axis).hypot(radius);
                let base = (PI * radius * radius, base);
                weighted(&[(side, along(apex, axis, 2.0 / 3.0)), base])
            }
            Self::Cuboid { min, max } => {
                let [x, y, z] = minus(max, min);
                (2.0 * (x * y + y * z + z * x), along(min, minus(max, min), 0.5))
            }
        }
    }

    /// The least and the largest coordinate on this axis.
    pub(crate) fn extent(&self, axis: usize) -> [f64; 2] {
        let span = |points: &[D3]| {
            let of =
                |start: f64, f: fn(f64, f64) -> f64| points.iter().map(|p| p[axis]).fold(start, f);
            [of(f64::INFINITY, f64::min), of(f64::NEG_INFINITY, f64::max)]
        };
        let mut e = [0.0; 3];
        e[axis] = 1.0;
        let of_disk = |center: D3, normal: D3, radius: f64| {
            let reach = radius * length(cross(e, normal)) / length(normal);
            [center[axis] - reach, center[axis] + reach]
        };
        let joined = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        match *self {
            Self::Sphere { center, radius } => [center[axis] - radius, center[axis] + radius],
            Self::Triangle(v) => span(&v),
            Self::Quad(v) => span(&v),
            Self::Disk { center, normal, radius } => of_disk(center, normal, radius),
            Self::Plane { .. } => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Cylinder { p0, p1, radius, .. } => {
                let axis = minus(p1, p0);
                joined(of_disk(p0, axis, radius), of_disk(p1, axis, radius))
            }
            Self::Cone { base, apex, radius } => {
                joined(of_disk(base, minus(apex, base), radius), span(&[apex]))
            }
            Self::Cuboid { min, max } => span(&[min, max]),
        }
    }
}

/// The sum of the areas, and the mean of the centres.
fn weighted(parts: &[(f64, D3)]) -> (f64, D3) {
    let whole: f64 = parts.iter().map(|p| p.0).sum();
    (whole, parts.iter().fold([0.0; 3], |sum, p| along(sum, p.1, p.0 / whole)))
}
