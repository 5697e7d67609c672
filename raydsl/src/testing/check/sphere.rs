//! Bins of the sphere that follow a lobe, and integrals over each.

use core::f64::consts::{PI, TAU};

use glam::{DVec3, DVec4, Vec3};

/// Rows of bins, and bins in each.
const ROWS: usize = 80;
const COLUMNS: usize = 160;

/// Bins of the sphere around an axis: rows of equal numbers of pilot samples between rows of equal
/// height, so that a narrow lobe around the axis has many.
#[derive(Clone, Debug)]
pub(super) struct SphereBins {
    axes: [DVec3; 3],
    /// Angles to the axis at which rows begin, and pi.
    edges: Vec<f64>,
}

/// Nodes and weights of Gauss and Legendre's rule on the unit interval.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How often a bin is divided at most.
const DEPTH: u32 = 6;

/// The integral over a part of a bin, and whether the density is 0 in some of it alone.
#[derive(Clone, Copy)]
struct Part {
    integral: DVec4,
    is_edge: bool,
}

impl SphereBins {
    /// Creates bins around `axis` from pilot samples.
    pub(super) fn new(axis: Vec3, pilot: &[Vec3]) -> Self {
        let z = axis.as_dvec3().normalize();
        let x = z.any_orthonormal_vector();
        let axes = [x, z.cross(x), z];
        let mut angles: Vec<f64> = pilot.iter().map(|w| angle(z, w.as_dvec3())).collect();
        angles.sort_by(f64::total_cmp);
        let half = ROWS / 2;
        let mut edges: Vec<f64> = (0..half).map(|i| PI * i as f64 / half as f64).collect();
        if !angles.is_empty() {
            let last = angles.len() - 1;
            edges.extend((1..half).map(|i| angles[last * i / (half - 1)]));
            // What the pilot did not reach of a narrow lobe.
            edges.push((1.1 * angles[last]).min(PI));
        }
        edges.push(PI);
        edges.sort_by(f64::total_cmp);
        edges.dedup_by(|a, b| *a - *b < 1e-9);
        Self { axes, edges }
    }

    pub(super) fn count(&self) -> usize {
        (self.edges.len() - 1) * COLUMNS
    }

    /// Returns the bin of a direction.
    pub(super) fn of(&self, w: Vec3) -> usize {
        let [x, y, z] = self.axes;
        let w = w.as_dvec3();
        let row = self.edges.partition_point(|e| *e <= angle(z, w)).clamp(1, self.edges.len() - 1);
        let turn = w.dot(y).atan2(w.dot(x)).rem_euclid(TAU) / TAU;
        (row - 1) * COLUMNS + ((turn * COLUMNS as f64) as usize).min(COLUMNS - 1)
    }

    /// Returns the direction at the middle of a bin.
    pub(super) fn middle(&self, bin: usize) -> Vec3 {
        let (row, column) = (bin / COLUMNS, bin % COLUMNS);
        let theta = 0.5 * (self.edges[row] + self.edges[row + 1]);
        self.direction(theta, TAU * (column as f64 + 0.5) / COLUMNS as f64)
    }

    fn direction(&self, theta: f64, phi: f64) -> Vec3 {
        let [x, y, z] = self.axes;
        let ((st, ct), (sp, cp)) = (theta.sin_cos(), phi.sin_cos());
        ((x * cp + y * sp) * st + z * ct).as_vec3()
    }

    /// Returns the integral of `f` over each bin, to about a tenth of the spread of `samples`
    /// samples with the density `f(w).w`.
    pub(super) fn integrals(&self, samples: f64, f: &dyn Fn(Vec3) -> DVec4) -> Vec<DVec4> {
        let width = TAU / COLUMNS as f64;
        (0..self.count())
            .map(|bin| {
                let (row, column) = (bin / COLUMNS, (bin % COLUMNS) as f64 * width);
                let cell = [self.edges[row], self.edges[row + 1], column, column + width];
                self.adaptive(cell, self.gauss(cell, f), samples, f, DEPTH)
            })
            .collect()
    }

    fn gauss(&self, [t0, t1, p0, p1]: [f64; 4], f: &dyn Fn(Vec3) -> DVec4) -> Part {
        let (height, width) = (t1 - t0, p1 - p0);
        let (mut sum, mut zeros) = (DVec4::ZERO, 0);
        for (t, wt) in GAUSS {
            let theta = t0 + t * height;
            for (p, wp) in GAUSS {
                let value = f(self.direction(theta, p0 + p * width));
                zeros += u32::from(value.w == 0.0);
                sum += value * (wt * wp * theta.sin());
            }
        }
        Part { integral: sum * (height * width), is_edge: zeros > 0 && zeros < 9 }
    }

    fn adaptive(
        &self,
        cell: [f64; 4],
        whole: Part,
        samples: f64,
        f: &dyn Fn(Vec3) -> DVec4,
        depth: u32,
    ) -> DVec4 {
        let [t0, t1, p0, p1] = cell;
        let (t, p) = (0.5 * (t0 + t1), 0.5 * (p0 + p1));
        let quarters = [[t0, t, p0, p], [t0, t, p, p1], [t, t1, p0, p], [t, t1, p, p1]];
        let parts = quarters.map(|q| self.gauss(q, f));
        let sum: DVec4 = parts.iter().map(|part| part.integral).sum();
        let error = (sum - whole.integral).abs() * samples;
        let expected = sum.abs() * samples;
        // The other numbers are for means: their errors add up.
        let is_close = error.w < 0.05 + 0.03 * expected.w.sqrt()
            && error.max_element() < 0.05 + 0.003 * expected.max_element();
        // At an edge the rule converges slowly, and may seem close by chance.
        let zeros = parts.iter().filter(|part| part.integral.w == 0.0).count();
        let is_edge =
            whole.is_edge || parts.iter().any(|part| part.is_edge) || (1..4).contains(&zeros);
        if depth == 0 || is_close && !is_edge {
            return sum;
        }
        let finer = |(q, part): (&[f64; 4], &Part)| self.adaptive(*q, *part, samples, f, depth - 1);
        quarters.iter().zip(&parts).map(finer).sum()
    }
}

/// Returns the angle between two unit vectors, accurate where it is small too.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_cover_the_sphere() {
        let pilot: Vec<Vec3> =
            (0..500).map(|i| Vec3::new(i as f32 * 1e-4, 0.3, 1.0).normalize()).collect();
        let bins = SphereBins::new(pilot[7], &pilot);
        let all = bins.integrals(1e6, &|w| DVec4::new(1.0, f64::from(w.z), 0.0, 1.0));
        let sum: DVec4 = all.iter().sum();
        assert!((sum.x - 4.0 * PI).abs() < 1e-6 && sum.y.abs() < 1e-6);
        for bin in (0..bins.count()).step_by(37) {
            assert_eq!(bins.of(bins.middle(bin)), bin);
        }
    }
}
