//! Light in volumes by all integrators: three transfer functions of one field, and a knob of steps.

use raydsl::prelude::*;
use raydsl::volume::{
    Adaptive, Euler, ExactCell, ExponentialLeft, Grid, GridConfig, MeanExtinction, Midpoint,
    PreIntegrated, TransferFunction, Volume, VolumeLight,
};
use raydsl_report::Missing;
use raydsl_report::work_precision::{
    Backend, Case, Estimates, Method, Order, Reference, Run, Work,
};

/// Names, values of the field in a step, and orders: those of the numerics of each rule, the same
/// for all fields. (Etiene, Kirby and Silva, "An Exploratory Study of Data Sampling Rate Impact on
/// Order of Accuracy in Direct Volume Rendering", 2013, measure orders in this way.)
pub(crate) const RULES: [(&str, u64, f64); 5] = [
    ("naive", 1, -1.0),
    ("left", 1, -1.0),
    ("midpoint", 1, -2.0),
    ("mean-extinction", 2, -2.0),
    ("pre-integrated", 2, -2.0),
];

/// Names of integrators without steps: to a tolerance, and without a choice.
pub(crate) const OTHERS: [&str; 2] = ["adaptive", "exact-cell"];

/// Names of the cases.
pub(crate) const FIELDS: [&str; 3] = ["volume-smooth", "volume-spike", "volume-shell"];

/// Cells along each axis of the cube from -1 to 1.
const CELLS: u32 = 24;

/// A bump beside the middle of a slope: no border where the field is symmetric, so that no error
/// cancels.
fn voxels() -> Vec<f32> {
    let side = CELLS + 1;
    let at = |i: u32| i as f32 * (2.0 / CELLS as f32) - 1.0;
    let value = |i: u32| {
        let p = vec3(at(i % side), at(i / side % side), at(i / (side * side)));
        let bump = (-3.0 * p.distance_squared(vec3(0.1, -0.15, 0.05))).exp();
        0.25 + 0.1 * p.x + 0.15 * p.y - 0.1 * p.z + 0.45 * bump
    };
    (0..side * side * side).map(value).collect()
}

/// A soft ramp, a peak that is narrower than what the field changes in a cell, and a layer that
/// becomes opaque within a few cells.
fn function(name: &str) -> TransferFunction {
    let colors = [(0.0, vec3(0.1, 0.2, 0.9)), (0.5, vec3(0.9, 0.6, 0.1)), (1.0, Vec3::ONE)];
    let extinctions: &[(f32, f32)] = match name {
        "volume-smooth" => &[(0.0, 0.1), (1.0, 2.0)],
        "volume-spike" => &[(0.4, 0.0), (0.43, 40.0), (0.46, 0.0)],
        _ => &[(0.3, 0.0), (0.6, 60.0), (1.0, 80.0)],
    };
    TransferFunction::from_extinction(&colors, extinctions).expect("sorted knots")
}

pub(crate) type View = Volume<'static, f32>;

pub(crate) fn camera() -> Pinhole {
    Pinhole::new(vec3(1.9, 2.6, 1.4), Vec3::ZERO, Vec3::Z, 0.5)
}

/// What the camera sees, by one integrator; the red of it counts.
macro_rules! seen {
    ($run:expr, $volume:expr, $integrator:expr) => {{
        let (volume, integrator) = ($volume, $integrator.least(0.0));
        let kernel =
            kernel!(|ray: Ray| volume.integrate(&integrator, ray, VolumeLight::new()).rgba());
        $run.with_samples(1).centers(&camera(), &kernel)
    }};
}

/// A knob of 2 is a step of the length of a cell, or a tolerance of 0.02 that falls with its square, as
/// the error of rules of the second order does.
fn estimate(run: &Run<'_>, volume: &View) -> Result<Estimates, Missing> {
    let step = 4.0 / (CELLS * run.knob()) as f32;
    let name = run.method().name();
    let found = match name {
        "naive" => seen!(run, volume, Euler::new(step)),
        "left" => seen!(run, volume, ExponentialLeft::new(step)),
        "midpoint" => seen!(run, volume, Midpoint::new(step)),
        "mean-extinction" => seen!(run, volume, MeanExtinction::new(step)),
        "pre-integrated" => seen!(run, volume, PreIntegrated::new(step)),
        "adaptive" => seen!(run, volume, Adaptive::new(0.08 / (run.knob() * run.knob()) as f32)),
        _ => seen!(run, volume, ExactCell::new()),
    }?;
    let Some((_, samples, _)) = RULES.iter().find(|rule| rule.0 == name) else { return Ok(found) };
    // Values that a ray through the middle takes.
    let steps = u64::from(CELLS * run.knob() / 2) * samples;
    Ok(Estimates { counted: Some(found.samples * steps), ..found })
}

/// The red of what is seen, or what passes.
#[raydsl::kernel]
fn counting(#[host] has_passed: bool, light: VolumeLight) -> f32 {
    if has_passed { light.transmittance() } else { light.radiance.x }
}

/// The parts of a ray of [`exact()`]: so short that the error of the exact cell's rule of four points, of
/// the eighth power of their optical depths, is far below 1e-9.
const PARTS: u32 = 256;

/// What the camera sees, or what passes, by the exact cell.
pub(crate) fn exact(run: &Run<'_>, volume: &View, has_passed: bool) -> Result<Estimates, Missing> {
    let exact = ExactCell::new().least(0.0);
    // Optical depths are exact as they are.
    let parts = if has_passed { 1 } else { PARTS };
    let kernel = kernel!(|ray: Ray| {
        let (enter, leave) = volume.grid().span(ray);
        let length = (max(leave, enter) - enter) / parts as f32;
        let mut light = VolumeLight::new();
        for i in 0..parts {
            let (from, to) = (enter + i as f32 * length, enter + (i + 1) as f32 * length);
            light = volume.integrate(&exact, ray.with_range(from, to), light);
        }
        counting(host(has_passed), light)
    });
    run.with_samples(1).centers(&camera(), &kernel)
}

/// The volume of a name of [`FIELDS`].
pub(crate) fn volume(name: &str) -> &'static View {
    let size = UVec3::splat(CELLS + 1);
    let spacing = Vec3::splat(2.0 / CELLS as f32);
    let config = GridConfig::new().spacing(spacing).origin(-Vec3::ONE);
    let grid = Grid::new(voxels(), size, config).expect("a small grid");
    let grid: &'static Grid<'static, f32> = Box::leak(Box::new(grid));
    Box::leak(Box::new(Volume::new(grid, function(name))))
}

/// The case of a name of [`FIELDS`], of pictures with `edge` pixels along each edge; its reference is
/// the exact cell in `f64`.
pub(crate) fn case(name: &str, edge: u32) -> Case<'static> {
    let volume = volume(name);
    let method = Method::from("exact cell");
    let run = Run::new(&method, Backend::F64, 1).sized(edge, edge);
    let exact = exact(&run, volume, false).expect("no device is needed");
    let case = Case::new(name, Reference::f64(exact.values, 1e-9), move |run: &Run<'_>| {
        estimate(run, volume)
    });
    let case = case.knob("step").values(&[1, 2, 4, 8, 16, 32]).family("volumes");
    let case = RULES.iter().fold(case.counted(|_| Work::NOTHING), |case, (name, _, order)| {
        case.method(*name, Some(Order::near(*order, 0.2)))
    });
    OTHERS.iter().fold(case, |case, name| case.method(*name, None))
}
