//! Every integrator, of homogeneous media and of noise.

use std::error::Error;

use raydsl::Type;
use raydsl::prelude::*;
use raydsl::volume::{
    Adaptive, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, Labels, MeanExtinction,
    Midpoint, PreIntegrated, ShadedCell, TransferFunction, Volume, VolumeLight,
};
use raydsl_tests::close::functions;
use raydsl_tests::rng::Rng;

use super::super::statistics::Share;
use super::super::{Measure, Measured, fault, largest};
use crate::outcome::Outcome;
use crate::row::{Bound, Row, Unit};

pub(super) fn rows() -> Vec<Row> {
    let tolerances = [1e-2, 1e-3, 1e-4, 1e-5].map(tolerance);
    [range(), slab(), block(), skipping()].into_iter().chain(tolerances).collect()
}

/// Colour and opacity by every integrator.
#[derive(Clone, Copy, Debug, Type)]
struct All {
    exact: Vec4,
    shaded: Vec4,
    adaptive: Vec4,
    euler: Vec4,
    left: Vec4,
    midpoint: Vec4,
    labels: Vec4,
    mean: Vec4,
    pre: Vec4,
}

impl All {
    /// Those that are right of a homogeneous medium.
    fn of_homogeneous(&self) -> [Vec4; 7] {
        let Self { exact, adaptive, left, midpoint, labels, mean, pre, .. } = *self;
        [exact, adaptive, left, midpoint, labels, mean, pre]
    }
}

/// A ray, the length of steps, and a tolerance.
type Arguments = (Ray, f32, f32);

/// Measures with the one kernel for all volumes.
fn all(volume: &Volume<'_, f32>, measure: &Measure<'_, Arguments, All>) -> Measured {
    let to_light = vec3(0.6, 0.0, 0.8);
    measure(&[kernel!(|ray: Ray, step: f32, tolerance: f32| {
        let none = VolumeLight::new();
        let exact = ExactCell::new().least(0.0);
        let shaded = ShadedCell::new(to_light, 0.5).least(0.0);
        let adaptive = Adaptive::new(tolerance);
        let euler = Euler::new(step).least(0.0);
        let left = ExponentialLeft::new(step).least(0.0);
        let midpoint = Midpoint::new(step).least(0.0);
        let labels = Labels::new(step).least(0.0);
        let mean = MeanExtinction::new(step).least(0.0);
        let pre = PreIntegrated::new(step).least(0.0);
        All {
            exact: volume.integrate(&exact, ray, none).rgba(),
            shaded: volume.integrate(&shaded, ray, none).rgba(),
            adaptive: volume.integrate(&adaptive, ray, none).rgba(),
            euler: volume.integrate(&euler, ray, none).rgba(),
            left: volume.integrate(&left, ray, none).rgba(),
            midpoint: volume.integrate(&midpoint, ray, none).rgba(),
            labels: volume.integrate(&labels, ray, none).rgba(),
            mean: volume.integrate(&mean, ray, none).rgba(),
            pre: volume.integrate(&pre, ray, none).rgba(),
        }
    })])
}

/// Noise of 7 by 5 by 6 voxels.
fn noise() -> Result<Grid<'static, f32>, Box<dyn Error>> {
    let mut rng = Rng::of("noise");
    let voxels: Vec<f32> = (0..7 * 5 * 6).map(|_| rng.unit()).collect();
    let config = GridConfig::new().spacing(vec3(1.0, 0.5, 2.0));
    Ok(Grid::new(voxels, uvec3(7, 5, 6), config)?)
}

/// A ray from outside through a box from 0 to `size`, now and then along an axis, from within, or of
/// a limited range.
fn through(rng: &mut Rng, size: Vec3) -> Ray {
    let target = size * (rng.point(0.5) + 0.5);
    let axes = [Vec3::X, Vec3::Y, -Vec3::Z, vec3(1.0, 1.0, 0.0)];
    let direction = if rng.below(5) == 0 { rng.pick(&axes) } else { rng.direction() };
    let ray = Ray::new(target - direction * 20.0, direction);
    match rng.below(7) {
        0 => ray.with_range(19.0, 21.5),
        1 => Ray::new(target, direction),
        _ => ray,
    }
}

/// Least and greatest colours of the functions.
const LEAST: Vec3 = Vec3::new(0.1, 0.0, 0.1);
const GREATEST: Vec3 = Vec3::new(1.0, 0.9, 0.8);

fn range() -> Row {
    let row = Row::new("opacity and radiance in range", 2, Unit::Faults, Bound::NONE, |run| {
        let grid = noise()?;
        let mut outcome = Outcome::default();
        for (i, function) in functions().into_iter().enumerate() {
            let volume = Volume::new(&grid, function);
            let make = |rng: &mut Rng| {
                let ray = through(rng, vec3(6.0, 2.0, 10.0));
                (ray, 10f32.powf(rng.range(-1.0, 1.5)), 10f32.powf(rng.range(-4.0, -1.0)))
            };
            let part = all(&volume, &|kernel| {
                run.part(0.25, i as u64).measure(kernel, make, |_, found| {
                    let is_in_range = |light: Vec4, least: Vec3| {
                        let (color, opacity) = (light.truncate(), light.w);
                        // Rounding of products and sums.
                        let (below, above) = (least * opacity, GREATEST * opacity);
                        (0.0..=1.0).contains(&opacity)
                            && color.cmpge(below * (1.0 - 4e-6)).all()
                            && color.cmple(above * (1.0 + 4e-6)).all()
                    };
                    let lit = [found.euler].into_iter().chain(found.of_homogeneous());
                    let is_right = lit.into_iter().all(|light| is_in_range(light, LEAST));
                    fault(!(is_right && is_in_range(found.shaded, Vec3::ZERO)))
                })
            })?;
            outcome.merge(run.unit, part);
        }
        Ok(outcome)
    });
    row.share(0.1).misses(
        Bound::all(1e-3),
        "`Labels`: where a label of great extinction has a share of some roundings, the colour that \
         it gives has no digits left, and may be outside of its range.",
    )
}

/// A grid of one value, with so many cells along each axis.
fn homogeneous(cells: UVec3) -> Result<Grid<'static, f32>, Box<dyn Error>> {
    let size = cells + 1;
    let voxels = vec![0.5; size.element_product() as usize];
    Ok(Grid::new(voxels, size, GridConfig::new())?)
}

/// Extinction that is twice the value times this, and one colour.
fn of_extinction(extinction: f32) -> Result<TransferFunction, Box<dyn Error>> {
    let knots = [(0.0, 0.0), (1.0, 2.0 * extinction)];
    Ok(TransferFunction::from_extinction(&[(0.0, Vec3::splat(0.75))], &knots)?)
}

/// The greatest error of opacities and colours.
fn off(lights: &[Vec4], opacity: f64) -> f64 {
    largest(lights.iter().flat_map(|light| {
        let errors = [f64::from(light.w) - opacity, f64::from(light.x) / 0.75 - opacity];
        errors.map(f64::abs)
    }))
}

fn any_step(rng: &mut Rng) -> f32 {
    2f32.powf(rng.range(-2.0, 4.0))
}

/// The textbook adds the opacity of a cell at every step, whatever its length.
fn slab() -> Row {
    let name = "slab, steps of 1/4 to 16 cells";
    Row::new(name, 3, Unit::Absolute, Bound::all(1e-5), |run| {
        let grid = homogeneous(uvec3(1, 1, 16))?;
        let mut outcome = Outcome::default();
        let mut textbook = 0.0f64;
        for (i, extinction) in [0.01, 0.3, 2.0].into_iter().enumerate() {
            let volume = Volume::new(&grid, of_extinction(extinction)?);
            let opacity = -(-f64::from(extinction) * 16.0).exp_m1();
            let make = |rng: &mut Rng| {
                (Ray::new(vec3(rng.unit(), rng.unit(), -1.0), Vec3::Z), any_step(rng), 1e-5)
            };
            let part = run.part(1.0 / 3.0, i as u64);
            let part = all(&volume, &|kernel| {
                part.measure(kernel, make, |_, found| Some(off(&found.of_homogeneous(), opacity)))
            })?;
            outcome.merge(run.unit, part);
            let uncorrected = |step: f64| -(-f64::from(extinction) * (16.0 / step)).exp_m1();
            textbook = [0.25, 16.0]
                .map(|step| (uncorrected(step) - opacity).abs())
                .into_iter()
                .fold(textbook, f64::max);
        }
        Ok(outcome.beside(textbook))
    })
    .share(0.1)
}

fn block() -> Row {
    let name = "block, steps of 1/4 to 16 cells";
    Row::new(name, 3, Unit::Absolute, Bound::all(1e-3), |run| {
        let grid = homogeneous(UVec3::splat(16))?;
        let volume = Volume::new(&grid, of_extinction(0.2)?);
        let make = |rng: &mut Rng| (through(rng, Vec3::splat(16.0)), any_step(rng), 1e-4);
        all(&volume, &|kernel| {
            run.measure(kernel, make, |&(ray, ..), found| {
                let depth = f64::from(0.2f32) * chord(ray, 16.0);
                Some(off(&found.of_homogeneous(), -(-depth).exp_m1()))
            })
        })
    })
    .share(0.1)
}

/// The length of a ray in a cube from 0 to `size`.
fn chord(ray: Ray, size: f64) -> f64 {
    let (mut enter, mut leave) = (f64::from(ray.t_min), f64::from(ray.t_max));
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    for axis in 0..3 {
        if d[axis] == 0.0 {
            if !(0.0..=size).contains(&o[axis]) {
                return 0.0;
            }
            continue;
        }
        let (p, q) = (-o[axis] / d[axis], (size - o[axis]) / d[axis]);
        enter = enter.max(p.min(q));
        leave = leave.min(p.max(q));
    }
    (leave - enter).max(0.0) * d.length()
}

/// A ball in empty space, and the same with an extinction around it that no rounding keeps, so that
/// nothing is skipped.
fn skipping() -> Row {
    let bound = Bound { cpu: 2e-6, wgsl: 1e-4, f64: 0.0 };
    Row::new("empty space skipped", 5, Unit::Absolute, bound, |run| {
        let ball = |i: u32| {
            let at = uvec3(i % 40, i / 40 % 40, i / 1600).as_vec3();
            (1.0 - at.distance(vec3(12.0, 25.0, 18.0)) / 9.0).max(0.0)
        };
        let voxels: Vec<f32> = (0..64_000).map(ball).collect();
        let grid = Grid::new(voxels, UVec3::splat(40), GridConfig::new())?;
        let colors = [(0.0, Vec3::ONE)];
        let ball = TransferFunction::from_extinction(&colors, &[(0.1, 0.0), (0.5, 2.0)])?;
        let around = [(0.0, 1e-30), (0.1, 1e-30), (0.5, 2.0)];
        let around = TransferFunction::from_extinction(&colors, &around)?;
        let (skipped, full) = (Volume::new(&grid, ball), Volume::new(&grid, around));
        if !skipped.majorants().contains(&0.0) || full.majorants().contains(&0.0) {
            return Err("nothing is skipped, or something is in both".into());
        }
        let make = |rng: &mut Rng| (through(rng, Vec3::splat(39.0)), 0.37, 1e-3);
        let judged = |whole: &Kernel<'_, Arguments, All>, input: &Arguments, found: &All| {
            let whole = whole.call(*input);
            let pairs = [
                (found.exact, whole.exact),
                (found.left, whole.left),
                (found.midpoint, whole.midpoint),
                (found.mean, whole.mean),
                (found.pre, whole.pre),
            ];
            let off = |(a, b): (Vec4, Vec4)| (a - b).to_array().map(|off| off.abs().into());
            Some(largest(pairs.into_iter().flat_map(off)))
        };
        all(&full, &|whole| {
            all(&skipped, &|kernel| {
                run.measure(kernel, make, |input, found| judged(&whole[0], input, found))
            })
        })
    })
    .share(0.01)
}

/// The figure is the share of rays that are further off than the tolerance; the exact cell stands for
/// what is exact.
fn tolerance(tolerance: f32) -> Row {
    let name = format!("adaptive, tolerance {tolerance:e}");
    Row::new(name, 4, Unit::Absolute, Bound::all(0.01), move |run| {
        let grid = noise()?;
        let mut outcome = Outcome::default();
        for (i, function) in functions().into_iter().enumerate() {
            let volume = Volume::new(&grid, function);
            let make = |rng: &mut Rng| (through(rng, vec3(6.0, 2.0, 10.0)), 1.0, tolerance);
            let none = Share::new(|_: &Arguments, found: &All| {
                !(found.adaptive - found.exact).abs().cmple(Vec4::splat(tolerance)).all()
            });
            let part = run.part(0.25, i as u64);
            let part = all(&volume, &|kernel| part.gather(&kernel[0], &none, make))?;
            outcome.merge(run.unit, part);
        }
        Ok(outcome)
    })
    .share(0.1)
}
