//! Integrals of light whose results are known, in every variant: those of the example `report`.

use std::error::Error;
use std::time::Duration;

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl::texture::Filter;
use raydsl_report::work_precision::{
    Backend, Case, Estimates, Method, Metrics, Run, Verdict, WorkPrecision,
};
use raydsl_tests::gpu::gpu;

// Parts of one example call each other by the names of modules at the crate's root.
#[path = "../../examples/report/cloud.rs"]
mod cloud;
#[expect(unreachable_pub, reason = "a module of the scenes' library")]
#[path = "../../scenes/src/cornell.rs"]
mod cornell;
#[expect(unreachable_pub, reason = "a module of the examples' library")]
#[path = "../../examples/src/lens.rs"]
mod lens;
#[path = "../../examples/report/light.rs"]
mod light;
#[path = "../../examples/report/luneburg.rs"]
mod luneburg;
#[path = "../../examples/report/open.rs"]
mod open;
#[path = "../../examples/report/paths.rs"]
mod paths;
#[path = "../../examples/report/quadrature.rs"]
mod quadrature;
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
    let run = |variant, seed| {
        let run = Run::new(&method, Backend::Variant(variant), SAMPLES);
        run.sized(EDGE, EDGE).seeded(seed)
    };
    let check = |case: &Case<'_>, run: Run<'_>, what: &str| -> Result<(), Box<dyn Error>> {
        let found = estimate(case, &run)?;
        assert_eq!(found.samples, 1 << 20);
        assert!(is_right(&found, case, exact(case)), "{} {what}", case.name());
        Ok(())
    };
    for case in cases {
        for seed in 0..8 {
            check(case, run(Variant::widest(), seed), &format!("by packets, seed {seed}"))?;
        }
        let Some(gpu) = gpu() else { continue };
        for seed in 0..8 {
            check(case, run(Variant::Wgsl, seed).on(gpu), &format!("in WGSL, seed {seed}"))?;
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

/// Some balls on top of each other, in the place of a scene from a file.
fn balls() -> open::Scene<visibility::Ball> {
    let ball = |i: u16| {
        let (x, y, z) = (f32::from(i % 6), f32::from(i / 6 % 6), f32::from(i / 36));
        visibility::Ball { center: vec3(x, y, z - 0.1 * x), radius: 0.4 + 0.01 * y }
    };
    let camera = Pinhole::new(vec3(9.0, 7.0, 8.0), vec3(2.5, 2.5, 1.0), Vec3::Z, 0.7);
    open::Scene { primitives: (0..108).map(ball).collect(), camera, radius: 2.0 }
}

/// Every sample has a ray, and another one where it meets something: then it is open or not.
#[test]
fn a_scene_is_open_and_counted() -> Result<(), Box<dyn Error>> {
    let case = [open::case("balls", balls(), 64)?];
    let scalar = [Backend::Variant(Variant::Scalar)];
    let report = WorkPrecision::new().backends(&scalar).knobs(&[16]).repetitions(3).run(&case)?;
    let [random, .., sobol] = &report.cases[0].curves[..] else { panic!("three curves") };
    let work = random.points[0].work();
    let samples = u64::from(EDGE * EDGE * 16);
    assert!((samples + 1..2 * samples).contains(&work.rays.unwrap_or(0)), "{work:?}");
    assert!(work.nodes > work.rays && work.texture_fetches == Some(0), "{work:?}");
    let light = random.points[0].repetitions[0].values.iter().sum::<f64>();
    assert!((0.1..0.9).contains(&(light / f64::from(EDGE * EDGE))), "{light}");
    assert!(sobol.points[0].rmse() < random.points[0].rmse());
    Ok(())
}

/// With the same seed a device has the scalar variant's pictures: light to 1e-4 of itself, but for
/// one pixel in a thousand, where rounding may decide whether a ray meets an edge. By lavapipe one
/// pixel in 4096 needs that, of paths.
#[test]
fn a_device_has_the_same_pictures() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu() else { return Ok(()) };
    let mut cases = all();
    cases.push(cloud::case(8)?);
    cases.push(open::case("balls", balls(), 8)?);
    cases.push(quadrature::case());
    cases.push(luneburg::case());
    for name in paths::NAMES {
        cases.push(paths::case(name, 8)?);
    }
    for case in &cases {
        for method in case.methods() {
            let of = |variant| {
                let run = Run::new(method, Backend::Variant(variant), 16);
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
    (0..count)
        .map(|i| (Sampler::new(uvec2(i % 64, 3), 9, i / 64, 64, SampleMethod::Sobol),))
        .collect()
}

/// What rounding does to a sample accounts for all that differs.
#[test]
fn samples_agree() {
    let inputs = samplers(2500);
    for scene in visibility::scenes() {
        let visibility::Scene { occluders, reach, is_uniform, .. } = scene;
        let occluders = &occluders[..];
        let kernel = kernel!(|sampler: Sampler| {
            visibility::visibility(occluders, reach, host(is_uniform), sampler)
        });
        assert_variants_agree!(&kernel, &inputs);
    }
    for which in 0..12 {
        let kernel = kernel!(|sampler: Sampler| light::light(host(which), sampler));
        assert_variants_agree!(&kernel, &inputs);
    }
    for (is_lamp, filter) in [(false, Filter::Linear), (true, Filter::Nearest)] {
        let texture = &textured::texture(filter);
        let kernel =
            kernel!(|sampler: Sampler| { textured::textured(texture, host(is_lamp), sampler) });
        assert_variants_agree!(&kernel, &inputs);
    }
}

/// Errors fall as theory says, which each case tells: -0.5 to within 0.05 for random samples, -0.7
/// or faster past an edge, about -1 and below for stratified and Sobol samples of what has none.
/// Seeds are fixed, so it is the fitted orders that must, not only their intervals.
#[track_caller]
fn assert_orders(cases: &[Case<'_>], knobs: &[u32]) -> Result<(), Box<dyn Error>> {
    let report = WorkPrecision::new()
        .backends(&[Backend::Variant(Variant::widest())])
        .knobs(knobs)
        .repetitions(2)
        .time(Duration::from_secs(3600))
        .run(cases)?;
    println!("{}", report.table());
    for case in &report.cases {
        for curve in &case.curves {
            let what = format!("{} {}: {:?}", case.name, curve.method.name(), curve.fit);
            let Some(order) = curve.expected else {
                assert_eq!(curve.verdict(), Verdict::NoTheory, "{what}");
                continue;
            };
            let fitted = curve.fit.ok_or(what.as_str())?.order;
            assert!((order.steepest..=order.flattest).contains(&fitted), "{what}");
            assert_eq!(curve.verdict(), Verdict::AsExpected, "{what}");
        }
    }
    Ok(())
}

/// From 256 samples on: with 64 the rim of a thing that hides little of the sky, such as that of
/// P-AO5, crosses as many strata as there are inside it, and the curve is still too flat.
fn assert_orders_past_edges(cases: &[Case<'_>]) -> Result<(), Box<dyn Error>> {
    assert_orders(cases, &[256, 1024, 4096, 16_384])
}

// Two tests, as it takes long: each has a core.
#[test]
fn orders_past_edges_first_half() -> Result<(), Box<dyn Error>> {
    let cases = visibility::cases();
    assert_orders_past_edges(&cases[..cases.len() / 2])
}

#[test]
fn orders_past_edges_second_half() -> Result<(), Box<dyn Error>> {
    let cases = visibility::cases();
    assert_orders_past_edges(&cases[cases.len() / 2..])
}

/// The one edge without an order: it runs along lines between strata, so that nothing but rounding
/// is left.
#[test]
fn an_edge_along_strata_leaves_no_error() -> Result<(), Box<dyn Error>> {
    let cases = visibility::cases();
    let case = cases.iter().find(|c| c.name() == "P-AO7-uniform").ok_or("a case")?;
    for sampling in [SampleMethod::Stratified, SampleMethod::Sobol] {
        let method = Method::from(sampling);
        let run = Run::new(&method, Backend::Variant(Variant::widest()), SAMPLES);
        let found = estimate(case, &run.sized(EDGE, EDGE))?;
        let error = Metrics::of(&found.values, case.reference()).rmse;
        assert!(error < 1e-5, "{} {error}", method.name());
    }
    Ok(())
}

#[test]
fn orders_of_light() -> Result<(), Box<dyn Error>> {
    assert_orders(&light::cases(), &[64, 256, 1024, 4096])
}

#[test]
fn orders_of_textures() -> Result<(), Box<dyn Error>> {
    assert_orders(&textured::cases(), &[64, 256, 1024, 4096])
}

/// 1, 2, 4 and 4. In `f32` the sum of 16 steps of the last two has as much rounding as error, which
/// leaves too few points for a verdict, but not for the order; in `f64` there are more.
#[test]
fn orders_of_rules() -> Result<(), Box<dyn Error>> {
    let case = [quadrature::case()];
    let widest = Backend::Variant(Variant::widest());
    let of_f32: (_, &[u32], f64) = (widest, &[2, 4, 8], 0.15);
    for (backend, knobs, slack) in [of_f32, (Backend::F64, &[4, 8, 16, 32], 0.05)] {
        let report = WorkPrecision::new().backends(&[backend]).knobs(knobs).size(2, 2);
        let report = report.repetitions(1).run(&case)?;
        println!("{}", report.table());
        let curves = &report.cases[0].curves;
        assert_eq!(curves.len(), quadrature::RULES.len());
        for (curve, (name, look_ups, order)) in curves.iter().zip(quadrature::RULES) {
            let what = format!("{name} {}: {:?}", backend.name(), curve.fit);
            let fitted = curve.fit.ok_or(what.as_str())?.order;
            assert!((fitted - order).abs() < slack, "{what}");
            if backend == Backend::F64 {
                assert_eq!(curve.verdict(), Verdict::AsExpected, "{what}");
            }
            // Of four pixels.
            let counted = curve.points[0].repetitions[0].counted;
            let expected = 4 * u64::from(knobs[0]) * look_ups;
            assert_eq!((curve.method.name(), counted), (name, Some(expected)));
        }
    }
    Ok(())
}

/// 2 and 4, of the focus of a beam.
#[test]
fn orders_of_integrators() -> Result<(), Box<dyn Error>> {
    let case = [luneburg::case()];
    let widest = Backend::Variant(Variant::widest());
    // In `f32` steps are longer, since rounding is all that 32 of the order 4 leave.
    let of_f32: (_, &[u32], f64) = (widest, &[4, 8, 16], 0.3);
    for (backend, knobs, slack) in [of_f32, (Backend::F64, &[8, 16, 32, 64], 0.1)] {
        let report = WorkPrecision::new().backends(&[backend]).knobs(knobs).size(3, 3);
        let report = report.repetitions(1).run(&case)?;
        println!("{}", report.table());
        let curves = &report.cases[0].curves;
        assert_eq!(curves.len(), luneburg::INTEGRATORS.len());
        for (curve, (name, gradients, order)) in curves.iter().zip(luneburg::INTEGRATORS) {
            let what = format!("{name} {}: {:?}", backend.name(), curve.fit);
            let fitted = curve.fit.ok_or(what.as_str())?.order;
            assert!((fitted - order).abs() < slack, "{what}");
            if backend == Backend::F64 {
                assert_eq!(curve.verdict(), Verdict::AsExpected, "{what}");
            }
            // Of nine pixels.
            let counted = curve.points[0].repetitions[0].counted;
            let expected = 9 * u64::from(knobs[0]) * gradients;
            assert_eq!((curve.method.name(), counted), (name, Some(expected)));
        }
    }
    Ok(())
}
