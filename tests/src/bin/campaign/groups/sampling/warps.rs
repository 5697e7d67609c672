//! Warps: their samples, densities and inverses.

use std::f64::consts::{PI, TAU};

use raydsl::prelude::*;
use raydsl::sampling::{
    CONCENTRIC_DISK_PDF, ONE_MINUS_EPSILON, TRIANGLE_PDF, UNIFORM_HEMISPHERE_PDF,
    UNIFORM_SPHERE_PDF, invert_bilinear, invert_concentric_disk, invert_cone,
    invert_cosine_hemisphere, invert_power_cosine, invert_table_2d, invert_triangle,
    invert_uniform_hemisphere, invert_uniform_sphere,
};
use raydsl::{Type, kernel};
use raydsl_tests::rng::Rng as Source;

use super::super::statistics::Histogram;
use super::super::{Measure, Measured};
use crate::outcome::Outcome;
use crate::row::{Bound, Row, Unit};

/// A sample, its density, and what the inverse makes of it.
#[derive(Clone, Copy, Debug, Type)]
struct Warped {
    point: Vec3,
    pdf: f32,
    back: Vec2,
}

/// Weights of the bilinear density at the corners.
const WEIGHTS: [f64; 4] = [0.25, 1.0, 3.0, 0.5];

/// The warp of a row, with its parameter: all lanes take the same arm.
#[kernel]
fn warped(which: u32, u: Vec2, p: f32) -> Warped {
    match which {
        0 => {
            let d = sample_concentric_disk(u);
            let point = vec3(d.x, d.y, 0.0);
            Warped { point, pdf: CONCENTRIC_DISK_PDF, back: invert_concentric_disk(d) }
        }
        1 => {
            let point = sample_cosine_hemisphere(u);
            let pdf = cosine_hemisphere_pdf(point.z);
            Warped { point, pdf, back: invert_cosine_hemisphere(point) }
        }
        2 => {
            let point = sample_uniform_hemisphere(u);
            let back = invert_uniform_hemisphere(point);
            Warped { point, pdf: UNIFORM_HEMISPHERE_PDF, back }
        }
        3 => {
            let point = sample_uniform_sphere(u);
            Warped { point, pdf: UNIFORM_SPHERE_PDF, back: invert_uniform_sphere(point) }
        }
        4 => {
            let point = sample_cone(u, p);
            Warped { point, pdf: cone_pdf(p), back: invert_cone(point, p) }
        }
        5 => {
            let point = sample_power_cosine(u, p);
            let pdf = power_cosine_pdf(point.z, p);
            Warped { point, pdf, back: invert_power_cosine(point, p) }
        }
        6 => {
            let d = sample_triangle(u);
            let point = vec3(d.x, d.y, 0.0);
            Warped { point, pdf: TRIANGLE_PDF, back: invert_triangle(d) }
        }
        _ => {
            let weights = vec4(0.25, 1.0, 3.0, 0.5);
            let d = sample_bilinear(u, weights);
            let pdf = bilinear_pdf(d, weights);
            Warped { point: vec3(d.x, d.y, 0.0), pdf, back: invert_bilinear(d, weights) }
        }
    }
}

/// A warp of the rows.
#[derive(Clone, Copy)]
struct Warp {
    name: &'static str,
    which: u32,
    /// The height of a cone, or the exponent of a power.
    parameter: f32,
    /// Where a sample is in the unit square, over which it is uniform.
    place: fn(Vec3, f64) -> [f64; 2],
    /// Its density.
    pdf: fn(Vec3, f64) -> f64,
}

const WARPS: [Warp; 11] = [
    Warp {
        name: "disk",
        which: 0,
        parameter: 0.0,
        place: |p, _| [p.as_dvec3().length_squared(), turn(p)],
        pdf: |_, _| 1.0 / PI,
    },
    Warp {
        name: "cosine hemisphere",
        which: 1,
        parameter: 0.0,
        place: |p, _| [f64::from(p.z).powi(2), turn(p)],
        pdf: |p, _| f64::from(p.z) / PI,
    },
    Warp {
        name: "hemisphere",
        which: 2,
        parameter: 0.0,
        place: |p, _| [p.z.into(), turn(p)],
        pdf: |_, _| 1.0 / TAU,
    },
    Warp {
        name: "sphere",
        which: 3,
        parameter: 0.0,
        place: |p, _| [0.5 + 0.5 * f64::from(p.z), turn(p)],
        pdf: |_, _| 0.5 / TAU,
    },
    Warp { name: "cone, half", which: 4, parameter: 0.5, place: in_cone, pdf: of_cone },
    Warp { name: "cone, narrow", which: 4, parameter: 1e-6, place: in_cone, pdf: of_cone },
    Warp { name: "cosine^7.5", which: 5, parameter: 7.5, place: in_lobe, pdf: of_lobe },
    Warp { name: "cosine^80", which: 5, parameter: 80.0, place: in_lobe, pdf: of_lobe },
    Warp {
        name: "triangle",
        which: 6,
        parameter: 0.0,
        place: |p, _| {
            let (x, y) = (f64::from(p.x), f64::from(p.y));
            [1.0 - (1.0 - x).powi(2), if x < 1.0 { y / (1.0 - x) } else { 0.0 }]
        },
        pdf: |_, _| 2.0,
    },
    Warp { name: "bilinear", which: 7, parameter: 0.0, place: in_square, pdf: of_square },
    Warp { name: "cosine^1e6", which: 5, parameter: 1e6, place: in_lobe, pdf: of_lobe },
];

/// The share of a turn at which a point lies.
fn turn(p: Vec3) -> f64 {
    f64::from(p.y).atan2(p.x.into()).rem_euclid(TAU) / TAU
}

/// How far below the pole a direction is, whatever `1 - z` rounds to.
fn below_pole(p: Vec3) -> f64 {
    let across = f64::from(p.x).powi(2) + f64::from(p.y).powi(2);
    across / (1.0 + f64::from(p.z))
}

fn in_cone(p: Vec3, height: f64) -> [f64; 2] {
    [below_pole(p) / height, turn(p)]
}

fn of_cone(_: Vec3, height: f64) -> f64 {
    1.0 / (TAU * height)
}

fn in_lobe(p: Vec3, exponent: f64) -> [f64; 2] {
    [((exponent + 1.0) * (-below_pole(p)).ln_1p()).exp(), turn(p)]
}

/// The density takes the cosine as it is rounded.
fn of_lobe(p: Vec3, exponent: f64) -> f64 {
    (exponent + 1.0) / TAU * f64::from(p.z).powf(exponent)
}

/// The integral to `t` of a density that runs from `a` to `b`, as a share of the whole.
fn share(t: f64, a: f64, b: f64) -> f64 {
    (a * t + 0.5 * (b - a) * t * t) / (0.5 * (a + b))
}

/// The densities at both ends of a row.
fn row_ends(y: f64) -> [f64; 2] {
    let [v00, v10, v01, v11] = WEIGHTS;
    [v00 + (v01 - v00) * y, v10 + (v11 - v10) * y]
}

fn in_square(p: Vec3, _: f64) -> [f64; 2] {
    let (x, y) = (f64::from(p.x), f64::from(p.y));
    let [v00, v10, v01, v11] = WEIGHTS;
    let [left, right] = row_ends(y);
    [share(x, left, right), share(y, v00 + v10, v01 + v11)]
}

fn of_square(p: Vec3, _: f64) -> f64 {
    let [left, right] = row_ends(p.y.into());
    4.0 * (left + (right - left) * f64::from(p.x)) / WEIGHTS.iter().sum::<f64>()
}

pub(super) fn rows() -> Vec<Row> {
    let histograms = WARPS.into_iter().map(histogram);
    let more = [table_histogram(), densities(), table_integral(), inverses(), table_inverse()];
    histograms.chain(more).collect()
}

/// Numbers from 0 to 1, now and then at an end.
fn any_u(rng: &mut Source) -> Vec2 {
    let ends = [0.0, 6e-8, 1e-4, 0.25, 0.5, 0.75, ONE_MINUS_EPSILON];
    let mut unit = || if rng.below(64) == 0 { rng.pick(&ends) } else { rng.unit() };
    vec2(unit(), unit())
}

fn histogram(warp: Warp) -> Row {
    let name = format!("samples, {}", warp.name);
    Row::new(name, 4, Unit::Times, Bound::all(5.0), move |run| {
        let of = move |_: &_, found: &Warped| (warp.place)(found.point, warp.parameter.into());
        let none = Histogram::new(run.count, of);
        run.gather(&Kernel::of::<warped>(), &none, |rng| {
            (warp.which, vec2(rng.unit(), rng.unit()), warp.parameter)
        })
    })
}

fn densities() -> Row {
    Row::new("density of every warp", 5, Unit::Relative, Bound::all(1e-4), |run| {
        let mut all = Outcome::default();
        for (i, warp) in WARPS.into_iter().enumerate() {
            let part = run.part(1.0 / WARPS.len() as f64, i as u64);
            let make = |rng: &mut Source| (warp.which, any_u(rng), warp.parameter);
            let outcome = part.measure(&[Kernel::of::<warped>()], make, |_, found| {
                let exact = (warp.pdf)(found.point, warp.parameter.into());
                // On the horizon, and where a power is a denormal, both are 0.
                (exact > 1e-30).then(|| (f64::from(found.pdf) / exact - 1.0).abs())
            })?;
            all.merge(run.unit, outcome);
        }
        Ok(all)
    })
}

/// The greater difference; the second number may be a turn off, and means nothing at the pole.
fn apart(u: Vec2, back: Vec2, has_turns: bool) -> f64 {
    let off = (back - u).abs().as_dvec2();
    let of_turn = if has_turns { off.y.min((1.0 - off.y).abs()) } else { off.y };
    off.x + if has_turns && u.x == 0.0 { 0.0 } else { of_turn }
}

fn inverses() -> Row {
    Row::new("inverse of every warp", 6, Unit::Absolute, Bound::all(1e-6), |run| {
        let mut all = Outcome::default();
        for (i, warp) in WARPS.into_iter().enumerate() {
            let part = run.part(1.0 / WARPS.len() as f64, i as u64);
            let make = |rng: &mut Source| (warp.which, any_u(rng), warp.parameter);
            let outcome =
                part.measure(&[Kernel::of::<warped>()], make, |&(which, u, _), found| {
                    Some(apart(u, found.back, (2..6).contains(&which)))
                })?;
            all.merge(run.unit, outcome);
        }
        Ok(all)
    })
}

/// A table of 37 by 29 weights over four orders of magnitude, a fifth of them 0.
struct Table {
    weights: Vec<f32>,
    table: Distribution2d,
}

const COLUMNS: u32 = 37;
const ROWS: u32 = 29;

impl Table {
    fn new() -> Result<Self, Box<dyn std::error::Error>> {
        let mut rng = Source::new(12);
        let mut weight = || match rng.below(5) {
            0 => 0.0,
            _ => 10f32.powf(rng.range(-2.0, 2.0)),
        };
        let weights: Vec<f32> = (0..COLUMNS * ROWS).map(|_| weight()).collect();
        let table = Distribution2d::new(&weights, uvec2(COLUMNS, ROWS))?;
        Ok(Self { weights, table })
    }

    /// Measures with the one kernel of tables.
    fn measured(&self, measure: &Measure<'_, (u32, Vec2, f32), Warped>) -> Measured {
        let (cdf, size) = (self.table.cdf(), self.table.size());
        measure(&[kernel!(|_which: u32, u: Vec2, _p: f32| {
            let sample = sample_table_2d(u, cdf, size);
            let back = invert_table_2d(sample.point, cdf, size);
            let point = vec3(sample.point.x, sample.point.y, table_2d_pdf(sample.point, cdf, size));
            Warped { point, pdf: sample.pdf, back }
        })])
    }
}

/// Sums of weights up to each, from 0 to 1.
fn sums(weights: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = 0.0;
    let mut all = vec![0.0];
    all.extend(weights.map(|w| {
        sum += w;
        sum
    }));
    all.iter().map(|s| s / sum).collect()
}

/// Where `x` is in the sums of cells that halve the line evenly.
fn in_sums(sums: &[f64], x: f64) -> f64 {
    let place = x * (sums.len() - 1) as f64;
    let cell = (place as usize).min(sums.len() - 2);
    sums[cell] + (sums[cell + 1] - sums[cell]) * (place - cell as f64)
}

fn table_histogram() -> Row {
    Row::new("samples, table", 4, Unit::Times, Bound::all(5.0), |run| {
        let table = Table::new()?;
        let lines: Vec<&[f32]> = table.weights.chunks(COLUMNS as usize).collect();
        let wide = |line: &[f32]| line.iter().map(|w| f64::from(*w)).collect::<Vec<_>>();
        let of_rows = sums(lines.iter().map(|line| wide(line).iter().sum()));
        let of_cells: Vec<Vec<f64>> =
            lines.iter().map(|line| sums(wide(line).into_iter())).collect();
        let place = |_: &_, found: &Warped| {
            let [x, y] = [f64::from(found.point.x), f64::from(found.point.y)];
            let row = ((y * f64::from(ROWS)) as usize).min(ROWS as usize - 1);
            [in_sums(&of_cells[row], x), in_sums(&of_rows, y)]
        };
        let none = Histogram::new(run.count, place);
        let make = |rng: &mut Source| (0, vec2(rng.unit(), rng.unit()), 0.0);
        table.measured(&|kernel| run.gather(&kernel[0], &none, make))
    })
}

/// The densities of cells add up to 1, and are those of the samples.
fn table_integral() -> Row {
    Row::new("density of a table", 5, Unit::Absolute, Bound::all(1e-4), |run| {
        let table = Table::new()?;
        let centers = (0..COLUMNS * ROWS).map(|i| {
            let cell = uvec2(i % COLUMNS, i / COLUMNS).as_vec2();
            (cell + 0.5) / uvec2(COLUMNS, ROWS).as_vec2()
        });
        let (cdf, size) = (table.table.cdf(), table.table.size());
        let pdf = |center: Vec2| f64::from(table_2d_pdf(center, cdf, size));
        let integral = centers.map(pdf).sum::<f64>() / f64::from(COLUMNS * ROWS);
        let make = |rng: &mut Source| (0, any_u(rng), 0.0);
        table.measured(&|kernel| {
            run.measure(kernel, make, |_, found| {
                let of_point = f64::from(found.point.z);
                Some((integral - 1.0).abs() + (f64::from(found.pdf) / of_point - 1.0).abs())
            })
        })
    })
}

/// A cell's place is rounded to 2^-24 of the table, which is more of a heavy cell.
fn table_inverse() -> Row {
    Row::new("inverse of a table", 6, Unit::Absolute, Bound::all(1e-6), |run| {
        let table = Table::new()?;
        let make = |rng: &mut Source| (0, any_u(rng), 0.0);
        table.measured(&|kernel| {
            run.measure(kernel, make, |&(_, u, _), found| {
                Some(apart(u, found.back, false) / f64::from(found.pdf.max(1.0)))
            })
        })
    })
}
