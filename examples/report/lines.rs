//! The end of streamlines in a vortex, by the adaptive integrator: a closed form, and a knob of
//! tolerances.

use raydsl::flow::{FlowSettings, FlowState, Ways, streamlines, trace};
use raydsl::prelude::*;
use raydsl_report::Missing;
use raydsl_report::work_precision::{Backend, Case, Estimates, Order, Reference, Run, Work};

/// How long lines are followed: about a turn at the mean distance from the axis.
const TIME: f32 = 6.0;

/// The velocity of a vortex that turns faster the closer to its axis.
#[raydsl::kernel]
fn vortex(p: Vec3) -> Vec3 {
    let turn = 1.0 / (0.25 + p.x * p.x + p.y * p.y);
    vec3(-p.y * turn, p.x * turn, 0.1)
}

/// Where lines begin: the middles of a square of `edge` by `edge`.
fn seeds(edge: u32) -> Vec<Vec3> {
    let at = |i: u32| 0.4 + 0.6 * (i as f32 + 0.5) / edge as f32;
    (0..edge * edge).map(|i| vec3(at(i % edge), at(i / edge), 0.0)).collect()
}

/// The x of the end of a line from there.
fn end(seed: Vec3) -> f64 {
    let (x, y) = (f64::from(seed.x), f64::from(seed.y));
    let angle = f64::from(TIME) / (0.25 + x * x + y * y);
    x * angle.cos() - y * angle.sin()
}

/// Lines to a tolerance of 0.1 over the knob; what is counted are the steps that were tried.
fn estimate(run: &Run<'_>, seeds: &[Vec3]) -> Result<Estimates, Missing> {
    let refused = |e: raydsl::flow::FlowError| Missing::Refused(e.to_string());
    let settings = FlowSettings::new(0.1 / run.knob() as f32, 1.0).map_err(refused)?;
    let settings = settings.max_time(TIME).map_err(refused)?;
    let kernel = kernel!(|state: FlowState| trace(|p: Vec3| Some(vortex(p)), state, settings));
    let lines = match run.backend() {
        Backend::Variant(Variant::Wgsl) => {
            let none = || Missing::NoDevice("there is no device".to_owned());
            let device = run.device().ok_or_else(none)?;
            let found = streamlines(device, &kernel, seeds, Ways::Forwards);
            found.map_err(|e| Missing::Refused(e.to_string()))?
        }
        Backend::Variant(cpu) => {
            let scheduler = SimpleScheduler::new().variant(cpu);
            streamlines(&scheduler, &kernel, seeds, Ways::Forwards)
        }
        Backend::F64 => {
            return Err(Missing::Refused("lines have no reference machine in f64".to_owned()));
        }
    };
    let last = |line: &raydsl::flow::Streamline| line.points().last().map_or(f32::NAN, |p| p.at.x);
    let values: Vec<f64> = lines.iter().map(|line| f64::from(last(line))).collect();
    let tried = lines.iter().map(|line| u64::from(line.attempts())).sum();
    let samples = values.len() as u64;
    Ok(Estimates { counted: Some(tried), ..Estimates::new(values, samples) })
}

/// The case, of `edge` by `edge` lines. The error of a line is proportional to the tolerance at
/// best, and below that to its power of 4/5, as steps are of the fifth order.
pub(crate) fn case(edge: u32) -> Case<'static> {
    let seeds = seeds(edge);
    let exact: Vec<f64> = seeds.iter().map(|seed| end(*seed)).collect();
    Case::new("streamlines", Reference::closed_forms(exact), move |run| estimate(run, &seeds))
        .knob("1/tolerance")
        .values(&[1, 10, 100, 1000, 10_000])
        .counted(|_| Work::NOTHING)
        .family("streamlines")
        .method("adaptive", Some(Order { steepest: -1.1, flattest: -0.75 }))
}
