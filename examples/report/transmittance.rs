//! What passes through volumes, by random estimates: the fields and transfer functions of `volumes`.

use raydsl::prelude::*;
use raydsl::volume::{delta_tracking, jackknife_transmittance, ratio_transmittance};
use raydsl_report::Missing;
use raydsl_report::work_precision::{
    Backend, Case, Estimates, Method, Order, Reference, Run, Work,
};

use crate::volumes::{self, View, camera, exact};

/// Names of the cases, and of their volumes.
pub(crate) const NAMES: [(&str, &str); 3] = [
    ("transmittance-smooth", "volume-smooth"),
    ("transmittance-spike", "volume-spike"),
    ("transmittance-shell", "volume-shell"),
];

/// The step of the jackknife estimate: half a cell.
const STEP: f32 = 1.0 / 24.0;

/// Random numbers of a sample.
#[raydsl::kernel]
fn numbers(sampler: Sampler) -> Rng {
    Rng::new(sampler.key, sampler.index, 0)
}

/// Each sample is one estimate of the ray through the middle of a pixel.
fn estimate(run: &Run<'_>, volume: &View) -> Result<Estimates, Missing> {
    match run.method().name() {
        "delta" => run.centers(
            &camera(),
            &kernel!(|ray: Ray, sampler: Sampler| {
                let mut rng = numbers(sampler);
                if delta_tracking(volume, ray, &mut rng).is_none() { 1.0 } else { 0.0 }
            }),
        ),
        "ratio" => run.centers(
            &camera(),
            &kernel!(|ray: Ray, sampler: Sampler| {
                let mut rng = numbers(sampler);
                ratio_transmittance(volume, ray, &mut rng)
            }),
        ),
        _ => run.centers(
            &camera(),
            &kernel!(|ray: Ray, sampler: Sampler| {
                let mut rng = numbers(sampler);
                jackknife_transmittance(volume, ray, STEP, &mut rng)
            }),
        ),
    }
}

/// The case of a name and its volume, of pictures with `edge` pixels along each edge; its reference is
/// the exact cell in `f64`. Samples do not know of each other; the jackknife has a small bias
/// besides.
pub(crate) fn case((name, volume): (&str, &str), edge: u32) -> Case<'static> {
    let volume = volumes::volume(volume);
    let method = Method::from("exact cell");
    let run = Run::new(&method, Backend::F64, 1).sized(edge, edge);
    let passed = exact(&run, volume, true).expect("no device is needed");
    let reference = Reference::f64(passed.values, 1e-9);
    Case::new(name, reference, move |run: &Run<'_>| estimate(run, volume))
        .counted(|_| Work::NOTHING)
        .values(&[1, 4, 16, 64, 256, 1024])
        .family("transmittance")
        .method("delta", Some(Order::RANDOM))
        .method("ratio", Some(Order::RANDOM))
        .method("jackknife", Some(Order::RANDOM))
}
