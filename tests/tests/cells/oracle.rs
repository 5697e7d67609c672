//! Emission and absorption through tetrahedra in plain `f64`: every one is clipped by its four
//! planes, the parts are sorted, and each is taken in many small steps between its knots.

use glam::DVec3;
use raydsl::prelude::*;
use raydsl::volume::TransferFunction;
use raydsl::volume::cells::{CellData, CellGrid};

/// Radiance and optical depth.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Light {
    pub(crate) radiance: DVec3,
    pub(crate) depth: f64,
}

/// Part of a ray in a tetrahedron.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) enter: f64,
    pub(crate) leave: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// Returns the parts of a ray in all tetrahedra, sorted.
pub(crate) fn parts(grid: &CellGrid<'_>, ray: Ray) -> Vec<Part> {
    parts_of(grid, ray.origin.as_dvec3(), ray)
}

/// Returns those of a ray with another origin.
pub(crate) fn parts_of(grid: &CellGrid<'_>, o: DVec3, ray: Ray) -> Vec<Part> {
    let d = ray.direction.as_dvec3();
    let mut all = Vec::new();
    for t in grid.mesh().tetrahedra() {
        let ids = t.vertices.to_array();
        let p = ids.map(|i| grid.mesh().points()[i as usize].as_dvec3());
        let (mut enter, mut leave) = (f64::from(ray.t_min), f64::from(ray.t_max));
        for lacking in 0..4 {
            let [a, b, c] = [1, 2, 3].map(|i| p[(lacking + i) % 4]);
            let normal = (b - a).cross(c - a);
            let inwards = normal * normal.dot(p[lacking] - a).signum();
            let (height, slope) = (inwards.dot(o - a), inwards.dot(d));
            let at = -height / slope;
            if slope > 0.0 {
                enter = enter.max(at);
            } else if slope < 0.0 {
                leave = leave.min(at);
            } else if height < 0.0 {
                leave = f64::NEG_INFINITY;
            }
        }
        if enter < leave {
            let value = |at: f64| match grid.data() {
                CellData::Cells(values) => f64::from(values[t.cell as usize]),
                CellData::Points(values) => {
                    linear(p, ids.map(|i| f64::from(values[i as usize])), o + d * at)
                }
            };
            all.push(Part { enter, leave, from: value(enter), to: value(leave) });
        }
    }
    all.sort_by(|a, b| a.enter.total_cmp(&b.enter));
    all
}

/// Returns the linear interpolant of a tetrahedron's values.
fn linear(p: [DVec3; 4], values: [f64; 4], at: DVec3) -> f64 {
    let whole = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
    let mut sum = 0.0;
    for i in 0..4 {
        let mut q = p;
        q[i] = at;
        sum += values[i] * (q[1] - q[0]).cross(q[2] - q[0]).dot(q[3] - q[0]) / whole;
    }
    sum
}

/// Returns what a ray gathers, `steps` in each piece between two knots.
pub(crate) fn integrate(
    grid: &CellGrid<'_>,
    transfer: &TransferFunction,
    ray: Ray,
    steps: usize,
) -> Light {
    let (knots, scale) = (transfer.knots(), ray.direction.as_dvec3().length());
    let mut light = Light::default();
    for part in parts(grid, ray) {
        let Part { enter, leave, from, to } = part;
        let mut cuts = vec![0.0, 1.0];
        cuts.extend(knots.iter().map(|k| (f64::from(k.value) - from) / (to - from)));
        cuts.retain(|x| (0.0..=1.0).contains(x));
        cuts.sort_by(f64::total_cmp);
        for piece in cuts.windows(2) {
            if light.depth > 40.0 {
                continue;
            }
            // Thick pieces take as many steps as keep each thin.
            let most = knots.iter().map(|k| f64::from(k.extinction)).fold(0.0, f64::max);
            let thick = most * (piece[1] - piece[0]) * (leave - enter) * scale * 50.0;
            let steps = steps.max((thick as usize).min(100_000));
            let width = (piece[1] - piece[0]) / steps as f64;
            for i in 0..steps {
                let share = piece[0] + (i as f64 + 0.5) * width;
                let value = from + (to - from) * share;
                let next = knots.partition_point(|k| f64::from(k.value) <= value);
                let (a, b) = (&knots[next.max(1) - 1], &knots[next.min(knots.len() - 1)]);
                let span = f64::from(b.value) - f64::from(a.value);
                let share = if span > 0.0 { (value - f64::from(a.value)) / span } else { 0.0 };
                let share = share.clamp(0.0, 1.0);
                let mix = |a: f32, b: f32| f64::from(a) + (f64::from(b) - f64::from(a)) * share;
                let color = a.color.as_dvec3().lerp(b.color.as_dvec3(), share);
                let depth = mix(a.extinction, b.extinction) * width * (leave - enter) * scale;
                light.radiance += color * (-light.depth).exp() * -(-depth).exp_m1();
                light.depth += depth;
            }
        }
    }
    light
}
