//! Linear extinction and colour along a ray, with a closed form.

use std::error::Error;
use std::sync::LazyLock;

use raydsl::prelude::*;
use raydsl::volume::{ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight};
use raydsl_tests::rng::Rng;

use super::super::{Measure, Measured, largest};
use crate::measure::Run;
use crate::outcome::Outcome;
use crate::row::{Bound, Row, Unit};

const BOUND: Bound = Bound { cpu: 1e-5, wgsl: 1e-4, f64: 1e-12 };

/// The longest grid of WGSL: llvmpipe ends the loops of an invocation after 65535 iterations.
const MOST_CELLS_IN_WGSL: u32 = 4096;

pub(super) fn rows() -> Vec<Row> {
    let depths = [1e-8, 1e-6, 1e-4, 1e-2, 1.0, 30.0, 1e3, 1e6];
    let few = depths.map(|depth| {
        let name = format!("optical depth {depth:e}");
        Row::new(name, 1, Unit::Relative, BOUND, move |run| layers(run, depth, &[1, 4, 64]))
            .share(0.1)
    });
    let many = [1e-8, 1.0, 1e6].map(|depth| {
        let name = format!("optical depth {depth:e} in 2^20 cells");
        Row::new(name, 1, Unit::Relative, BOUND, move |run| {
            // A ray takes as long as a million of one cell.
            let cells = if run.count >= 100 { 1 << 20 } else { 1 << 14 };
            let run = Run { f64: false, ..run.part(1.0, 0) };
            Ok(layers(&run, depth, &[cells])?.beside(products(depth, cells)))
        })
        .share(3e-6)
    });
    few.into_iter().chain(many).collect()
}

/// Values at the corners of a column's bottom and top: along a ray they are linear, with other ends
/// for each ray. Multiples of 1/64, so that cells divide them exactly.
const ENDS: [[f32; 2]; 4] = [[0.25, 0.75], [1.0, 0.125], [0.0, 1.0], [0.875, 0.0]];

/// Colours at the values 0 and 1: rising and falling.
const COLORS: [[f32; 2]; 3] = [[0.25, 1.0], [1.0, 0.25], [0.0, 1.0]];

fn column(cells: u32) -> Result<Grid<'static, f32>, Box<dyn Error>> {
    let value =
        |z: u32, [bottom, top]: [f32; 2]| bottom + (top - bottom) * (z as f32 / cells as f32);
    let voxels: Vec<f32> = (0..=cells).flat_map(|z| ENDS.map(|ends| value(z, ends))).collect();
    let config = GridConfig::new().spacing(vec3(1.0, 1.0, 1.0 / cells as f32));
    Ok(Grid::new(voxels, uvec3(2, 2, cells + 1), config)?)
}

/// The values at both ends of a ray along the column.
fn ends(ray: Ray) -> [f64; 2] {
    let (x, y) = (f64::from(ray.origin.x), f64::from(ray.origin.y));
    [0, 1].map(|end| {
        let value = |i: usize| f64::from(ENDS[i][end]);
        let row = |i: usize| value(i) * (1.0 - x) + value(i + 1) * x;
        row(0) * (1.0 - y) + row(2) * y
    })
}

/// Measures with the one kernel for all columns.
fn exact_cell(volume: &Volume<'_, f32>, measure: &Measure<'_, (Ray,), Vec2>) -> Measured {
    let exact = ExactCell::new().least(0.0);
    measure(&[kernel!(|ray: Ray| {
        let light = volume.integrate(&exact, ray, VolumeLight::new());
        vec2(light.radiance.x, light.opacity())
    })])
}

/// Columns of these numbers of cells, whose extinction is the value times `2 depth`, in every order
/// of colours.
fn layers(run: &Run, depth: f64, counts: &[u32]) -> Measured {
    let mut all = Outcome::default();
    let parts = counts.len() * COLORS.len();
    for (i, &cells) in counts.iter().enumerate() {
        let grid = column(cells)?;
        for (k, [first, last]) in COLORS.into_iter().enumerate() {
            let scale = (2.0 * depth) as f32;
            let colors = [(0.0, Vec3::splat(first)), (1.0, Vec3::splat(last))];
            let extinctions = [(0.0, 0.0), (1.0, scale)];
            let function = TransferFunction::from_extinction(&colors, &extinctions)?;
            let volume = Volume::new(&grid, function);
            let part = run.part(1.0 / parts as f64, (COLORS.len() * i + k) as u64);
            let part = if cells > MOST_CELLS_IN_WGSL { part.without_wgsl() } else { part };
            let make = |rng: &mut Rng| (Ray::new(vec3(rng.unit(), rng.unit(), -1.0), Vec3::Z),);
            let error = |ray: Ray, radiance: f64, opacity: f64| {
                let (values, [first, last]) = (ends(ray), [first, last].map(f64::from));
                let extinctions = values.map(|v| v * f64::from(scale));
                let colors = values.map(|v| first + (last - first) * v);
                let exact = layer(extinctions, colors);
                let off = |found: f64, exact: f64| (found - exact).abs() / exact;
                largest([off(radiance, exact[0]), off(opacity, exact[1])])
            };
            let outcome = exact_cell(&volume, &|kernel| {
                let outcome = part.measure(kernel, make, |&(ray,), found| {
                    Some(error(ray, found.x.into(), found.y.into()))
                })?;
                // Interpreted: a hundredth as many.
                let in_f64 = part.part(0.01, 0).in_f64(&kernel[0], make, |&(ray,), found| {
                    Some(error(ray, found[0], found[1]))
                });
                Ok(Outcome { found: outcome.found.into_iter().chain(in_f64).collect(), ..outcome })
            })?;
            all.merge(run.unit, outcome);
        }
    }
    Ok(all)
}

/// Places and weights of Gauss and Legendre's rule over an interval of length 1.
static GAUSS: LazyLock<[[f64; 2]; 20]> = LazyLock::new(|| {
    let n = 20;
    std::array::from_fn(|i| {
        // Newton's iteration for a root of the Legendre polynomial.
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (f64::from(n) + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=n {
                let k = f64::from(k);
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = f64::from(n) * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        [0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope)]
    })
});

/// Radiance and opacity of a layer of thickness 1 with linear extinction and colour: exactly, by a
/// rule of order 40 over pieces of an optical depth of at most 1.
fn layer([from, to]: [f64; 2], [first, last]: [f64; 2]) -> [f64; 2] {
    let depth = 0.5 * (from + to);
    // The place at an optical depth: the root of a square without cancelling.
    let place = |tau: f64| {
        let root = (from * from + 2.0 * (to - from) * tau).max(0.0).sqrt();
        (2.0 * tau / (from + root)).clamp(0.0, 1.0)
    };
    // Behind a depth of 50 less than rounding is seen.
    let seen = depth.min(50.0);
    let pieces = seen.ceil().max(1.0);
    let mut radiance = 0.0;
    for piece in 0..pieces as u32 {
        let at = |share: f64| place(seen * (f64::from(piece) + share) / pieces);
        let begin = if piece == 0 { 0.0 } else { at(0.0) };
        let end = if f64::from(piece + 1) == pieces && seen == depth { 1.0 } else { at(1.0) };
        for [share, weight] in *GAUSS {
            let t = begin + (end - begin) * share;
            let (extinction, color) = (from + (to - from) * t, first + (last - first) * t);
            let passed = (-(from * t + 0.5 * (to - from) * t * t)).exp();
            radiance += weight * (end - begin) * extinction * color * passed;
        }
    }
    [radiance, -(-depth).exp_m1()]
}

/// The textbook multiplies what each cell lets through: the error of the opacity of a homogeneous
/// slab of this depth.
fn products(depth: f64, cells: u32) -> f64 {
    let of_cell = (depth / f64::from(cells)) as f32;
    let passed = (0..cells).fold(1.0f32, |passed, _| passed * (1.0 - (1.0 - (-of_cell).exp())));
    let exact = -(-depth).exp_m1();
    (f64::from(1.0 - passed) - exact).abs() / exact
}
