//! A ring that knows where a ray meets it.

use raydsl::kernel;
use raydsl::prelude::*;

// ANCHOR: struct
/// A ring: all that is no farther than `minor` from a circle. One that has no hole is never hit.
#[primitive]
#[derive(Debug)]
pub(crate) struct Torus {
    /// The circle's middle.
    pub(crate) center: Vec3,
    /// The circle's radius.
    pub(crate) major: f32,
    /// What the circle turns around, of length 1.
    pub(crate) axis: Vec3,
    /// The radius of the tube, less than that of the circle.
    pub(crate) minor: f32,
}
// ANCHOR_END: struct

// ANCHOR: line
/// A line seen from a ring: its point at `s` is at the height `height.x + height.y * s` above the
/// circle's plane, and at `aside + step * s` in it. It is closest to the
/// middle at 0.
#[derive(Clone, Copy, Debug, Type)]
struct Line {
    height: Vec2,
    aside: Vec3,
    step: Vec3,
    moment: f32,
}

/// The square of the distance from the circle, less that of the tube's radius; its derivative; and
/// the distance from the axis.
#[kernel]
fn gap(line: Line, major: f32, minor: f32, s: f32) -> Vec3 {
    let aside = line.aside + line.step * s;
    let radius = max(aside.length(), 1e-12);
    let (x, y) = (radius - major, line.height.x + line.height.y * s);
    let distance = (x * x + y * y).sqrt();
    let growth = s - major * aside.dot(line.step) / radius;
    vec3((distance - minor) * (distance + minor), 2.0 * growth, radius)
}
// ANCHOR_END: line

// ANCHOR: root
/// Where the line crosses the surface, if it does.
#[derive(Clone, Copy, Debug, Type)]
struct Root {
    is_met: bool,
    s: f32,
}

/// The first root from `low` to `high`: before it `sign * gap` is positive, and it is bent one way.
/// Newton's method comes from the left where that is convex and from the right where it is concave,
/// so it never passes the root.
#[kernel]
fn root(
    line: Line,
    major: f32,
    minor: f32,
    low: f32,
    high: f32,
    sign: f32,
    is_convex: bool,
) -> Root {
    let mut s = if is_convex { low } else { high };
    let mut is_met = false;
    for i in 0..40u32 {
        let g = gap(line, major, minor, s);
        if sign * g.y >= 0.0 {
            // The bottom of a valley, or the top of a hill that has a root.
            is_met = !is_convex && i > 0;
            break;
        }
        let step = g.x / g.y;
        s -= step;
        if s < low - 4e-6 || s > high + 4e-6 {
            break;
        }
        // Half the second derivative, which is about the same where the step leads to.
        let bend = 1.0 + line.moment / (g.z * g.z * g.z);
        if step * step * bend < 1e-3 * minor * g.y.abs() && step.abs() < 0.1 * g.z {
            is_met = true;
            break;
        }
    }
    // What is left is about a thousandth of the tube, and each step more squares that.
    if is_met {
        for _ in 0..2u32 {
            let g = gap(line, major, minor, s);
            s -= clamp(g.x / g.y, -1e-3 * minor, 1e-3 * minor);
        }
    }
    Root { is_met, s }
}
// ANCHOR_END: root

#[primitive]
impl Torus {
    // ANCHOR: slack
    /// With u = 2^-24: on the way to its point next to the centre the ray is moved by at most 16 u
    /// of the distance. From there on everything has the size of the ring: the gap is known to
    /// within 8 u, a root to within 4 u, and what comes as close as 3.4e-6 of the tube, which is
    /// less than half of the ring, may be taken for one: 28 u. That makes 56 u; 64 are allowed.
    const SLACK: f32 = 1.0 / 262_144.0;
    // ANCHOR_END: slack

    // ANCHOR: intersect
    pub(crate) fn intersect(&self, ray: Ray) -> Hit {
        // From the ray's point next to the centre, in units of the ring's size: nothing cancels,
        // overflows or underflows, wherever the ray comes from. From far away it takes two steps.
        let reach = self.major + self.minor;
        let scale = ray.direction.abs().max_element();
        let length = (ray.direction / scale).length();
        let d = ray.direction / scale / length;
        let offset = ray.origin - self.center;
        let first = -offset.dot(d);
        let rest = -(offset + d * first).dot(d);
        let near = (offset + d * first + d * rest) / reach;
        let along = first + rest;
        let square = 1.00001 - near.dot(near);
        if !(square >= 0.0 && self.minor > 0.0 && self.minor < self.major) {
            return Hit::miss();
        }
        let half = square.sqrt();
        let (major, minor) = (self.major / reach, self.minor / reach);
        let height = vec2(near.dot(self.axis), d.dot(self.axis));
        let aside = near - self.axis * height.x;
        let step = d - self.axis * height.y;
        let turn = aside.cross(step).length_squared();
        let moment = major * turn;
        let line = Line { height, aside, step, moment };

        // The gap is convex, but for a part in the middle, next to the axis, where it is concave.
        let (mut from, mut to) = (half, half);
        let slant = step.dot(step);
        if slant > 1e-6 {
            let middle = -aside.dot(step) / slant;
            let bend = pow(moment, 2.0 / 3.0) - turn / slant;
            let width = max((max(bend, 0.0) / slant).sqrt(), 1e-4);
            (from, to) = (middle - width, middle + width);
        }

        // The roots of each part, one after the other; at each the line changes sides.
        let (mut s, mut sign, mut part) = (-half, 1.0, 0u32);
        for _ in 0..7u32 {
            let part_end = if part == 0 {
                from
            } else if part == 1 {
                to
            } else {
                half
            };
            let end = clamp(part_end, s, half);
            let is_convex = (part == 1) != (sign > 0.0);
            let root = root(line, major, minor, s, end, sign, is_convex);
            let t = (along + root.s * reach) / length / scale;
            if root.is_met && t >= ray.t_min {
                return Hit::new(true, t);
            }
            if root.is_met {
                sign = -sign;
                s = clamp(root.s, s, end);
            } else {
                part += 1;
                s = end;
            }
            if part == 3 {
                break;
            }
        }
        Hit::miss()
    }
    // ANCHOR_END: intersect

    // ANCHOR: bounds
    pub(crate) fn get_bounds(&self) -> Aabb {
        let axis = self.axis.to_array().map(f64::from);
        let square = axis.iter().map(|a| a * a).sum::<f64>().max(f64::MIN_POSITIVE);
        let size = |i: usize| {
            let across = ((square - axis[i] * axis[i]) / square).max(0.0).sqrt();
            f64::from(self.major) * across + f64::from(self.minor)
        };
        let face = |i: usize, sign: f64| f64::from(self.center[i]) + sign * size(i);
        let low = |i: usize| (face(i, -1.0) as f32).next_down();
        let high = |i: usize| (face(i, 1.0) as f32).next_up();
        Aabb::new(vec3(low(0), low(1), low(2)), vec3(high(0), high(1), high(2)))
    }
    // ANCHOR_END: bounds

    // ANCHOR: normal
    /// The normal where `ray` hits, outwards.
    pub(crate) fn normal(&self, ray: Ray, hit: Hit) -> Vec3 {
        let p = ray.at(hit.t) - self.center;
        let aside = p - self.axis * p.dot(self.axis);
        (p - aside * (self.major / aside.length())).normalize()
    }
    // ANCHOR_END: normal
}
