//! Emission and absorption along a ray in plain `f64`: every cell is divided at its planes and
//! where the value meets a knot, found by bisection, and each piece is taken in many small steps.

use raydsl::prelude::*;
use raydsl::volume::{Grid, TransferFunction, TransferKnot, Voxel};

/// Radiance and optical depth.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Light {
    pub(crate) radiance: glam::DVec3,
    pub(crate) depth: f64,
}

/// A grid's values in `f64`, in voxel coordinates, with placement by spacing and origin alone.
pub(crate) struct Field {
    numbers: Vec<f64>,
    size: [usize; 3],
    spacing: glam::DVec3,
    origin: glam::DVec3,
    margin: f64,
}

impl Field {
    pub(crate) fn new<T: Voxel>(voxels: &[T], grid: &Grid<'_, T>) -> Self {
        let Affine3 { matrix3: m, translation } = grid.config().to_world;
        let is_cell = grid.config().centering == raydsl::volume::Centering::Cell;
        Self {
            numbers: voxels.iter().map(|v| f64::from(v.number())).collect(),
            size: grid.size().to_array().map(|n| n as usize),
            spacing: vec3(m.x_axis.x, m.y_axis.y, m.z_axis.z).as_dvec3(),
            origin: translation.as_dvec3(),
            margin: if is_cell { 0.5 } else { 0.0 },
        }
    }

    pub(crate) fn value(&self, at: glam::DVec3) -> f64 {
        let at = at.to_array();
        let parts = [0, 1, 2].map(|a| {
            let last = self.size[a] as f64 - 1.0;
            let x = at[a].clamp(0.0, last);
            let cell = x.floor().min((last - 1.0).max(0.0));
            (cell as usize, x - cell)
        });
        let mut sum = 0.0;
        for corner in 0..8 {
            let (mut i, mut stride, mut weight) = (0, 1, 1.0);
            for (a, part) in parts.iter().enumerate() {
                let side = corner >> a & 1;
                let index = (part.0 + side).min(self.size[a] - 1);
                weight *= if side == 1 { part.1 } else { 1.0 - part.1 };
                i += index * stride;
                stride *= self.size[a];
            }
            sum += weight * self.numbers[i];
        }
        sum
    }
}

/// Colour and extinction on the same side of steps as a point between two crossings.
fn sampled(knots: &[TransferKnot], value: f64) -> (glam::DVec3, f64) {
    let next = knots.partition_point(|k| f64::from(k.value) <= value);
    let end = |k: &TransferKnot| (k.color.as_dvec3(), f64::from(k.extinction));
    if next == 0 {
        return end(&knots[0]);
    }
    let Some(b) = knots.get(next) else { return end(&knots[next - 1]) };
    let a = &knots[next - 1];
    let share = (value - f64::from(a.value)) / (f64::from(b.value) - f64::from(a.value));
    let ((ca, ea), (cb, eb)) = (end(a), end(b));
    (ca + (cb - ca) * share, ea + (eb - ea) * share)
}

/// Returns what a ray gathers, `steps` in each piece.
pub(crate) fn integrate(
    field: &Field,
    transfer: &TransferFunction,
    ray: Ray,
    steps: usize,
) -> Light {
    let origin = (ray.origin.as_dvec3() - field.origin) / field.spacing;
    let direction = ray.direction.as_dvec3() / field.spacing;
    let (mut enter, mut leave) = (f64::from(ray.t_min), f64::from(ray.t_max));
    let mut places = Vec::new();
    for a in 0..3 {
        let (o, d, last) = (origin[a], direction[a], field.size[a] as f64 - 1.0);
        let (low, high) = (-field.margin, last + field.margin);
        if d == 0.0 {
            if o < low || o > high {
                return Light::default();
            }
            continue;
        }
        let (p, q) = ((low - o) / d, (high - o) / d);
        enter = enter.max(p.min(q));
        leave = leave.min(p.max(q));
        places.extend((0..field.size[a]).map(|i| (i as f64 - o) / d));
    }
    if enter >= leave {
        return Light::default();
    }
    places.retain(|t| *t > enter && *t < leave);
    places.extend([enter, leave]);
    places.sort_by(f64::total_cmp);
    let at = |t: f64| field.value(origin + direction * t);
    let knots = transfer.knots();
    let mut light = Light::default();
    for cell in places.windows(2) {
        let mut cuts = vec![cell[0], cell[1]];
        // A cubic meets each knot at most three times; between 64 points hardly twice.
        for i in 0..64 {
            let share = |i: usize| cell[0] + (cell[1] - cell[0]) * i as f64 / 64.0;
            let (from, to) = (share(i), share(i + 1));
            for knot in knots {
                let knot = f64::from(knot.value);
                let (mut a, mut b) = (from, to);
                if (at(a) < knot) == (at(b) < knot) {
                    continue;
                }
                let is_below = at(a) < knot;
                for _ in 0..60 {
                    let middle = 0.5 * (a + b);
                    if (at(middle) < knot) == is_below { a = middle } else { b = middle }
                }
                cuts.push(b);
            }
        }
        cuts.sort_by(f64::total_cmp);
        for piece in cuts.windows(2) {
            let length = (piece[1] - piece[0]) * ray.direction.as_dvec3().length();
            let extinction = |t: f64| sampled(knots, at(t)).1;
            let most = [0.01, 0.5, 0.99].map(|s| extinction(piece[0] + s * (piece[1] - piece[0])));
            let thick = most.into_iter().fold(0.0, f64::max) * length * 100.0;
            if light.depth > 30.0 {
                continue;
            }
            let steps = steps.max((thick as usize).min(1_000_000));
            let width = (piece[1] - piece[0]) / steps as f64;
            for i in 0..steps {
                let (color, extinction) = sampled(knots, at(piece[0] + (i as f64 + 0.5) * width));
                let depth = extinction * width * ray.direction.as_dvec3().length();
                light.radiance += color * (-light.depth).exp() * -(-depth).exp_m1();
                light.depth += depth;
            }
        }
    }
    light
}
