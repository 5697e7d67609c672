//! Integrals of light whose results are known, in every variant: those of the example `report`.

use std::error::Error;

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl::report::work_precision::{
    Backend, Case, Estimates, Method, Metrics, Run, Verdict, WorkPrecision,
};
use raydsl::texture::Filter;
use raydsl_tests::gpu::gpu;
use raydsl_tests::scaled;

// Parts of one example call each other by the names of modules at the crate's root.
#[path = "../../examples/report/cloud.rs"]
mod cloud;
#[path = "../../examples/report/light.rs"]
mod light;
#[path = "../../examples/report/textured.rs"]
mod textured;
#[path = "../../examples/report/visibility.rs"]
mod visibility;

const CPU: [Variant; 4] = [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16];
/// The film's edge: a run has as many independent estimates as the square of it.
const EDGE: u32 = 16;
/// Samples of each; 2^20 in all.
const SAMPLES: u32 = 4096;

fn all() -> Vec<Case<'static>> {
    [visibility::cases(), light::cases(), textured::cases()].into_iter().flatten().collect()
}

fn estimate(case: &Case<'_>, run: &Run<'_>) -> Result<Estimates, Box<dyn Error>> {
    case.estimate(run).map_err(|missing| format!("{}: {missing}", case.name()).into())
}

/// Whether the mean is that of the reference, to within 4.5 standard errors and 1e-5 of it.
fn is_right(estimates: &Estimates, case: &Case<'_>, exact: f64) -> bool {
    let found = Metrics::of(&estimates.values, case.reference());
    found.bias.abs() <= 4.5 * found.bias_error + 1e-5 * exact.abs()
}

/// The reference, which is one number.
fn exact(case: &Case<'_>) -> f64 {
    -Metrics::of(&[0.0], case.reference()).bias
}

#[track_caller]
fn assert_means(cases: &[Case<'_>]) -> Result<(), Box<dyn Error>> {
    let method = Method::from(SampleMethod::Random);
    let backend = Backend::Variant(Variant::widest());
    for case in cases {
        for seed in 0..scaled(8) as u32 {
            let run = Run::new(&method, backend, SAMPLES).sized(EDGE, EDGE).seeded(seed);
            let found = estimate(case, &run)?;
            assert_eq!(found.samples, 1 << 20);
            assert!(is_right(&found, case, exact(case)), "{}, seed {seed}", case.name());
        }
    }
    Ok(())
}

#[test]
fn skies_behind_one_thing() -> Result<(), Box<dyn Error>> {
    assert_means(&visibility::cases())
}

#[test]
fn lamps_patches_and_skies() -> Result<(), Box<dyn Error>> {
    assert_means(&light::cases())
}

#[test]
fn textures_and_a_lamp_that_shows_one() -> Result<(), Box<dyn Error>> {
    assert_means(&textured::cases())
}

/// The rule above finds results that are off by half a percent.
#[test]
fn a_wrong_reference_is_found() -> Result<(), Box<dyn Error>> {
    let method = Method::from(SampleMethod::Random);
    let run = Run::new(&method, Backend::Variant(Variant::Packet8), SAMPLES).sized(EDGE, EDGE);
    for case in &all()[..2] {
        let mut found = estimate(case, &run)?;
        found.values.iter_mut().for_each(|v| *v += 0.005 * exact(case));
        assert!(!is_right(&found, case, exact(case)), "{}", case.name());
    }
    Ok(())
}

/// The same bits on the CPU, the same mean on a device, and the same numbers in `f64`.
#[test]
fn every_variant() -> Result<(), Box<dyn Error>> {
    for (case, sampling) in all().iter().zip(
        [SampleMethod::Sobol, SampleMethod::Stratified, SampleMethod::Random].into_iter().cycle(),
    ) {
        let method = Method::from(sampling);
        let run = |backend| Run::new(&method, backend, 32).sized(7, 3).seeded(5);
        let of = |variant| estimate(case, &run(Backend::Variant(variant)));
        let expected = of(Variant::Scalar)?.values;
        for variant in CPU {
            assert_eq!(of(variant)?.values, expected, "{} {variant:?}", case.name());
        }
        let in_f64 = estimate(case, &run(Backend::F64).sized(2, 1))?.values;
        let of_same = run(Backend::Variant(Variant::Scalar)).sized(2, 1);
        let in_f32 = estimate(case, &of_same)?.values;
        for (a, b) in in_f64.iter().zip(&in_f32) {
            // A hit in `f64` may be a miss in `f32`, but not for these samples.
            assert!((a - b).abs() <= 2e-6 * b.abs(), "{}: {a} {b}", case.name());
        }
        if let Some(gpu) = gpu() {
            let run = Run::new(&method, Backend::Variant(Variant::Wgsl), SAMPLES);
            let found = estimate(case, &run.sized(EDGE, EDGE).on(gpu))?;
            assert!(is_right(&found, case, exact(case)), "{} in WGSL", case.name());
        }
    }
    Ok(())
}

/// With the same seed a device has the scalar variant's pictures: light to 1e-4 of itself, but for
/// one pixel in a thousand, where rounding may decide whether a ray meets an edge. By lavapipe no
/// pixel needs that.
#[test]
fn a_device_has_the_same_pictures() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu() else { return Ok(()) };
    let mut cases = all();
    cases.push(cloud::case(8)?);
    for case in &cases {
        for sampling in [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol] {
            let method = Method::from(sampling);
            let of = |variant| {
                let run = Run::new(&method, Backend::Variant(variant), 16);
                estimate(case, &run.sized(64, 64).seeded(7).on(gpu)).map(|e| e.values)
            };
            let (expected, found) = (of(Variant::Scalar)?, of(Variant::Wgsl)?);
            let agrees = |(a, b): &(&f64, &f64)| (*a - *b).abs() <= 1e-4 * a.abs();
            let good = expected.iter().zip(&found).filter(agrees).count();
            let what = format!("{} {}: {good} of 4096", case.name(), method.name());
            println!("{what}");
            assert_eq!((expected.len(), found.len()), (4096, 4096));
            assert!(good * 1000 >= 999 * 4096, "{what} pixels agree");
        }
    }
    Ok(())
}

fn samplers(count: u32) -> Vec<(Sampler,)> {
    (0..count).map(|i| (Sampler::new(uvec2(i % 64, 3), 9, i / 64, 64),)).collect()
}

/// What rounding does to a sample accounts for all that differs.
#[test]
fn samples_agree() {
    let (method, inputs) = (SampleMethod::Sobol, samplers(2500));
    for scene in visibility::scenes() {
        let visibility::Scene { occluders, reach, is_uniform, .. } = scene;
        let occluders = &occluders[..];
        let kernel = kernel!(|sampler: Sampler| {
            visibility::visibility(occluders, reach, host(is_uniform), host(method), sampler)
        });
        assert_variants_agree!(&kernel, &inputs);
    }
    for which in 0..12 {
        let kernel = kernel!(|sampler: Sampler| light::light(host(which), host(method), sampler));
        assert_variants_agree!(&kernel, &inputs);
    }
    for (is_lamp, filter) in [(false, Filter::Linear), (true, Filter::Nearest)] {
        let texture = &textured::texture(filter);
        let kernel = kernel!(|sampler: Sampler| {
            textured::textured(texture, host(is_lamp), host(method), sampler)
        });
        assert_variants_agree!(&kernel, &inputs);
    }
}

/// Errors fall as theory says: -0.5 for random samples, -0.7 or faster past an edge, -1 and below
/// for stratified and Sobol samples of what has none.
#[test]
fn orders() -> Result<(), Box<dyn Error>> {
    let names = ["P-AO2", "P-AO5", "P-AO8", "P-D2", "P-D5-60", "P-S2", "texture", "textured-lamp"];
    let cases: Vec<Case<'_>> = all().into_iter().filter(|c| names.contains(&c.name())).collect();
    assert_eq!(cases.len(), names.len());
    let report = WorkPrecision::new()
        .backends(&[Backend::Variant(Variant::widest())])
        .knobs(&[64, 256, 1024, 4096])
        .repetitions(2)
        .run(&cases)?;
    println!("{}", report.table());
    for case in &report.cases {
        for curve in &case.curves {
            let (method, fit) = (curve.method.name(), curve.fit);
            assert_eq!(curve.verdict(), Verdict::AsExpected, "{} {method} {fit:?}", case.name);
        }
    }
    Ok(())
}
