//! BSDFs: their formulas where numbers cancel, their energy and their reciprocity.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicU32, Ordering};

use raydsl::bsdf::{
    Bsdf, Coated, Conductor, Dielectric, Eon, F82, FresnelSplit, Lambert, MetallicRoughness,
    Mirror, Mix, Sheen, SheenCoated, ThinDielectric, fresnel_dielectric, ggx_distribution,
};
use raydsl::prelude::*;
use raydsl::sampling::{ONE_MINUS_EPSILON, pcg4d, scrambled_sobol_1d, scrambled_sobol_2d};
use raydsl::{Type, kernel};
use raydsl_tests::hard_rays::EPS;
use raydsl_tests::rng::Rng;

use super::largest;
use crate::gather::Gathered;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "bsdfs",
    title: "BSDFs: cancelling formulas, energy and reciprocity",
    clauses: &[
        "The GGX distribution is right to 2e-6 of itself for alpha from 1e-4 to 1.",
        "What a dielectric transmits is right to 1e-4 of itself up to 89.999 degrees.",
        "No BSDF scatters more than 1 + 1e-4 of the light: the figure is the excess over 1 of a \
         mean, less 12 of its standard errors, and 12 over the number of samples for what none of \
         them has met.",
        "There and back have the same value to 1e-5 of it.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    let furnaces = MODELS.into_iter().map(furnace);
    // A mirror has no value for two directions.
    let reciprocal = MODELS.into_iter().filter(|m| m.name != "Mirror").map(reciprocity);
    let formulas = [ggx(), transmitted("transmitted, from outside", from_outside)];
    let inside = transmitted("transmitted, from inside", from_inside);
    formulas.into_iter().chain([inside]).chain(furnaces).chain(reciprocal).collect()
}

/// Formulas of one angle.
#[derive(Clone, Copy, Debug, Type)]
pub(super) struct Formulas {
    pub(super) ggx: f32,
    pub(super) split: FresnelSplit,
    /// Of a cone with a sine: its height, and the distance of its rim from the axis.
    pub(super) height: f32,
    pub(super) rim: f32,
}

#[kernel]
pub(super) fn formulas(normal: Vec3, alpha: f32, cos: f32, eta: f32, sine: f32) -> Formulas {
    let height = one_minus_cos(sine);
    Formulas {
        ggx: ggx_distribution(normal, alpha),
        split: fresnel_dielectric(cos, eta),
        height,
        rim: sample_cone(vec2(ONE_MINUS_EPSILON, 0.0), height).x,
    }
}

/// The textbook forms the denominator as `cos^2 (alpha^2 - 1) + 1`.
fn ggx() -> Row {
    Row::new("GGX, alpha from 1e-4", 1, Unit::Relative, Bound::all(2e-6), |run| {
        let make = |rng: &mut Rng| {
            let alpha = 10f32.powf(rng.range(-4.0, 0.0)).clamp(1e-4, 1.0);
            // Tangents around alpha, the shoulder, and any.
            let tan = f64::from(alpha) * 10f64.powf(f64::from(rng.range(-3.0, 4.0)));
            let (sin, cos) = (tan / tan.hypot(1.0), 1.0 / tan.hypot(1.0));
            let turn = 2.0 * PI * f64::from(rng.unit());
            let normal = vec3((sin * turn.cos()) as f32, (sin * turn.sin()) as f32, cos as f32);
            (normal, alpha, 0.5, 1.5, 0.5)
        };
        let exact = |m: Vec3, alpha: f32| {
            let (m, a) = (m.as_dvec3(), f64::from(alpha));
            let e = (m.x * m.x + m.y * m.y) / (a * a) + m.z * m.z;
            1.0 / (PI * a * a * e * e)
        };
        let off = |found: f32, exact: f64| (f64::from(found) / exact - 1.0).abs();
        let kernel = [Kernel::of::<formulas>()];
        let outcome = run
            .measure(&kernel, make, |input, found| Some(off(found.ggx, exact(input.0, input.1))))?;
        let mut rng = Rng::new(run.seed);
        let textbook = (0..run.count.clamp(1000, 1_000_000)).map(|_| {
            let (m, alpha, ..) = make(&mut rng);
            let (a2, t) = (alpha * alpha, m.z * m.z * (alpha * alpha - 1.0) + 1.0);
            off(a2 / (core::f32::consts::PI * t * t), exact(m, alpha))
        });
        Ok(outcome.beside(largest(textbook)))
    })
}

/// A cosine and the index beyond.
fn from_outside(rng: &mut Rng) -> (f32, f32) {
    (cosine(rng), 1.0 + 10f32.powf(rng.range(-2.0, 0.3)))
}

fn from_inside(rng: &mut Rng) -> (f32, f32) {
    (cosine(rng), 1.0 / (1.0 + 10f32.powf(rng.range(-2.0, 0.3))))
}

/// Of angles up to 89.999 degrees, as often near that one as near 0.
fn cosine(rng: &mut Rng) -> f32 {
    let least = f64::to_radians(89.999).cos();
    let log = f64::from(rng.unit()) * least.ln();
    log.exp().max(least) as f32
}

/// The textbook is 1 less what is reflected. Next to the critical angle, where the rounding of the
/// cosine itself changes the share by a fifth of the bound, nothing is promised.
fn transmitted(name: &'static str, draw: fn(&mut Rng) -> (f32, f32)) -> Row {
    Row::new(name, 2, Unit::Relative, Bound::all(1e-4), move |run| {
        let make = |rng: &mut Rng| {
            let (cos, eta) = draw(rng);
            (Vec3::Z, 0.5, cos, eta, 0.5)
        };
        let exact = |cos: f32, eta: f32| {
            let (c, eta) = (f64::from(cos), f64::from(eta));
            let cos2 = 1.0 - (1.0 - c * c) / (eta * eta);
            let t = cos2.max(0.0).sqrt();
            let (s, p) = ((c - eta * t) / (c + eta * t), (eta * c - t) / (eta * c + t));
            let of_cosine = c * EPS / (eta * eta * cos2.abs());
            (of_cosine < 2e-5).then_some(if cos2 <= 0.0 {
                0.0
            } else {
                1.0 - 0.5 * (s * s + p * p)
            })
        };
        let off = |found: f32, exact: f64| match exact {
            0.0 => f64::from(found).abs(),
            exact => (f64::from(found) / exact - 1.0).abs(),
        };
        let kernel = [Kernel::of::<formulas>()];
        let outcome = run.measure(&kernel, make, |input, found| {
            let exact = exact(input.2, input.3)?;
            let reflected = f64::from(found.split.reflected) - (1.0 - exact);
            // Both shares: the larger one is right to rounding.
            Some(off(found.split.transmitted, exact).max(10.0 * reflected.abs()))
        })?;
        let mut rng = Rng::new(run.seed);
        let textbook = (0..run.count.clamp(1000, 1_000_000)).filter_map(|_| {
            let (cos, eta) = draw(&mut rng);
            Some(off(1.0 - fresnel_dielectric(cos, eta).reflected, exact(cos, eta)?))
        });
        Ok(outcome.beside(largest(textbook)))
    })
}

/// A BSDF of the rows, white.
#[derive(Clone, Copy)]
struct Model {
    name: &'static str,
    which: u32,
    /// Its parameters: of the GGX distribution, or the roughness.
    alphas: [f32; 5],
    /// Index of refraction below the surface.
    ior: f64,
}

const ROUGH: [f32; 5] = [0.0, 0.01, 0.1, 0.5, 1.0];

const FIBRES: [f32; 5] = [0.07, 0.1, 0.3, 0.6, 1.0];

const MODELS: [Model; 11] = [
    Model { name: "Lambert", which: 0, alphas: ROUGH, ior: 1.0 },
    Model { name: "Eon", which: 1, alphas: ROUGH, ior: 1.0 },
    Model { name: "Dielectric", which: 2, alphas: ROUGH, ior: 1.5 },
    Model { name: "Sheen", which: 3, alphas: FIBRES, ior: 1.0 },
    Model { name: "Conductor", which: 4, alphas: ROUGH, ior: 1.0 },
    Model { name: "Coated Lambert", which: 5, alphas: ROUGH, ior: 1.0 },
    Model { name: "Mirror", which: 6, alphas: ROUGH, ior: 1.0 },
    Model { name: "ThinDielectric", which: 7, alphas: ROUGH, ior: 1.0 },
    Model { name: "Mix", which: 8, alphas: ROUGH, ior: 1.0 },
    Model { name: "SheenCoated Eon", which: 9, alphas: FIBRES, ior: 1.0 },
    Model { name: "MetallicRoughness", which: 10, alphas: ROUGH, ior: 1.0 },
];

/// What a BSDF makes of a pair of directions and of a sample.
#[derive(Clone, Copy, Debug, Type)]
struct Scattered {
    there: f32,
    back: f32,
    /// The second direction of the pair.
    wi: Vec3,
    /// Weight of the sample.
    weight: f32,
    /// The series that the sample is of.
    series: u32,
}

/// Asks a BSDF; without a second direction the sample's is taken.
#[kernel]
fn asked<B: Bsdf + Type>(bsdf: B, wo: Vec3, wi: Vec3, u: Vec3, series: u32) -> Scattered {
    let sample = bsdf.sample(wo, u);
    let is_given = wi.dot(wi) > 0.0;
    let pair = if is_given { wi } else { sample.wi };
    let there = bsdf.eval(wo, pair);
    let back = bsdf.eval(pair, wo);
    Scattered { there: there.x, back: back.x, wi: pair, weight: sample.weight.x, series }
}

/// The BSDF of a row: all lanes take the same arm.
#[kernel]
fn scattered(which: u32, alpha: f32, wo: Vec3, wi: Vec3, u: Vec3, series: u32) -> Scattered {
    let white = vec3(1.0, 1.0, 1.0);
    let metal = F82 { normal: white, tint: white };
    match which {
        0 => asked::<Lambert>(Lambert { color: white }, wo, wi, u, series),
        1 => asked::<Eon>(Eon { color: white, roughness: alpha }, wo, wi, u, series),
        2 => asked::<Dielectric>(Dielectric { ior: 1.5, alpha, tint: white }, wo, wi, u, series),
        3 => asked::<Sheen>(Sheen { color: white, alpha }, wo, wi, u, series),
        4 => asked::<Conductor<F82>>(Conductor::<F82> { fresnel: metal, alpha }, wo, wi, u, series),
        5 => {
            let base = Lambert { color: white };
            let coated = Coated::<Lambert> { base, ior: 1.5, alpha, strength: white };
            asked::<Coated<Lambert>>(coated, wo, wi, u, series)
        }
        6 => asked::<Mirror>(Mirror { color: white }, wo, wi, u, series),
        7 => {
            let pane = ThinDielectric { ior: 1.5, alpha, tint: white };
            asked::<ThinDielectric>(pane, wo, wi, u, series)
        }
        8 => {
            let under = Eon { color: white, roughness: alpha };
            let mix = Mix::<Eon, Lambert> { under, over: Lambert { color: white }, share: 0.3 };
            asked::<Mix<Eon, Lambert>>(mix, wo, wi, u, series)
        }
        9 => {
            let (base, sheen) =
                (Eon { color: white, roughness: alpha }, Sheen { color: white, alpha });
            asked::<SheenCoated<Eon>>(SheenCoated::<Eon> { base, sheen }, wo, wi, u, series)
        }
        _ => {
            // Some of everything.
            let all = MetallicRoughness {
                base_color: white,
                metallic: 0.3,
                roughness: alpha,
                ior: 1.5,
                specular: white,
                transmission: 0.4,
                is_solid: false,
                clearcoat: 0.5,
                clearcoat_roughness: 0.5 * alpha,
                sheen_color: vec3(0.5, 0.5, 0.5),
                sheen_roughness: alpha,
            };
            asked::<MetallicRoughness>(all, wo, wi, u, series)
        }
    }
}

/// Cosines of the viewer's direction.
const COSINES: [f32; 5] = [1.0, 0.7, 0.3, 0.1, 0.01];
/// Scrambles of the samples of each parameter and cosine; their means are independent.
const SCRAMBLES: u32 = 8;
/// Series of samples: so many of each parameter and cosine.
const SERIES: u32 = SCRAMBLES * 25;

/// Samples of each parameter and cosine are 8 scrambled Sobol sequences, whose means say how far off
/// the mean of all may be by chance.
fn furnace(model: Model) -> Row {
    let name = format!("furnace, {}", model.name);
    Row::new(name, 3, Unit::Absolute, Bound::all(1e-4), move |run| {
        let next = AtomicU32::new(0);
        let make = |_: &mut Rng| {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let (series, index) = (i % SERIES, i / SERIES);
            let (alpha, wo) = cell_of(model, series);
            let seeds = |n| pcg4d(uvec4(series, n, model.which, run.seed as u32));
            let u = scrambled_sobol_2d(index, seeds(0));
            let u = u.extend(scrambled_sobol_1d(index, seeds(1)));
            (model.which, alpha, wo, Vec3::ZERO, u, series)
        };
        let none = Furnace { model, means: vec![[0.0; 2]; SERIES as usize] };
        run.gather(&Kernel::of::<scattered>(), &none, make)
    })
}

/// The parameter and the viewer's direction of a series.
fn cell_of(model: Model, series: u32) -> (f32, Vec3) {
    let cell = (series / SCRAMBLES) as usize;
    let cos = COSINES[cell / model.alphas.len()];
    (model.alphas[cell % model.alphas.len()], vec3((1.0 - cos * cos).sqrt(), 0.0, cos))
}

/// Mean weights of series: of each the number of samples and their sum.
#[derive(Clone)]
struct Furnace {
    model: Model,
    means: Vec<[f64; 2]>,
}

impl<A> Gathered<A, Scattered> for Furnace {
    fn add(&mut self, _: &A, result: &Scattered) {
        let [count, sum] = &mut self.means[result.series as usize];
        *count += 1.0;
        *sum += f64::from(result.weight);
    }

    fn join(&mut self, other: Self) {
        for (mine, theirs) in self.means.iter_mut().flatten().zip(other.means.iter().flatten()) {
            *mine += theirs;
        }
    }

    fn judge(&self) -> (f64, String) {
        let mut worst = (f64::NEG_INFINITY, String::new());
        for (cell, means) in self.means.chunks(SCRAMBLES as usize).enumerate() {
            let samples = means.iter().map(|[count, _]| count).sum::<f64>();
            let means = means.iter().map(|[count, sum]| sum / count);
            let n = f64::from(SCRAMBLES);
            let mean = means.clone().sum::<f64>() / n;
            let squares = means.map(|m| (m - mean).powi(2)).sum::<f64>();
            let error = (squares / (n - 1.0) / n).sqrt();
            // Student's t of 7 degrees of freedom is above that once in 300,000 times.
            let excess = mean - 1.0 - 12.0 * error - 12.0 / samples;
            if excess.is_nan() || excess > worst.0 {
                let (alpha, wo) = cell_of(self.model, cell as u32 * SCRAMBLES);
                worst = (excess, format!("alpha {alpha}, wo {wo}: {mean} +- {error:.1e}"));
            }
        }
        // A NaN is not the lesser of two.
        (if worst.0.is_nan() { f64::INFINITY } else { worst.0.max(0.0) }, worst.1)
    }
}

/// Half of the pairs are those of samples, so that narrow lobes are met.
fn reciprocity(model: Model) -> Row {
    let name = format!("reciprocity, {}", model.name);
    let row = Row::new(name, 4, Unit::Relative, Bound::all(1e-5), move |run| {
        let make = |rng: &mut Rng| {
            let direction = |rng: &mut Rng| loop {
                let d = rng.direction().normalize();
                if d.z.abs() > 0.01 {
                    return d;
                }
            };
            let (wo, wi) = (direction(rng), direction(rng));
            let wi = if rng.below(2) == 0 { Vec3::ZERO } else { wi };
            let u = vec3(rng.unit(), rng.unit(), rng.unit());
            // Smooth lobes have no value.
            let alpha = rng.pick(&model.alphas[1..]);
            (model.which, alpha, wo, wi, u, 0)
        };
        let index = |w: Vec3| if w.z < 0.0 { model.ior } else { 1.0 };
        let kernel = [Kernel::of::<scattered>()];
        run.measure(&kernel, make, |&(_, _, wo, ..), found| {
            let over = |value: f32, wi: Vec3| {
                f64::from(value) / (f64::from(wi.z.abs()) * index(wi).powi(2))
            };
            let (there, back) = (over(found.there, found.wi), over(found.back, wo));
            if found.wi.z.abs() <= 0.01 || there == back {
                return (found.wi.z.abs() > 0.01).then_some(0.0);
            }
            Some((there - back).abs() / there.max(back))
        })
    });
    match model.name {
        "Conductor" | "Coated Lambert" | "ThinDielectric" => row.misses(
            Bound::all(1.0),
            "As documented: light that is scattered several times is added by a factor of the viewer's \
             direction alone (Turquin 2019).",
        ),
        "SheenCoated Eon" | "MetallicRoughness" => row.misses(
            Bound::all(1.0),
            "As documented: what is under sheen gets the light that the sheen does not reflect towards the \
             viewer, a factor of one direction alone.",
        ),
        "Dielectric" => row.misses(
            Bound::all(1.0),
            "The half vector of refracted light is a difference: where the two directions are nearly \
             in line it loses digits, and with it the distribution; values of 1e-12 per steradian \
             differ by some percent.",
        ),
        _ => row,
    }
}
