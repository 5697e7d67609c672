//! Methods of the library beside each other, as the example `report` measures them: estimates agree, and
//! errors fall as theory says.

use std::error::Error;
use std::time::Duration;

use raydsl::prelude::*;
use raydsl_report::work_precision::{
    Backend, Case, Method, Metrics, Report, Run, Verdict, WorkPrecision,
};
use raydsl_tests::gpu::gpu;

// Parts of one example call each other by the names of modules at the crate's root.
#[path = "../../examples/report/arithmetic.rs"]
mod arithmetic;
#[path = "../../examples/report/builders.rs"]
mod builders;
#[expect(dead_code, reason = "another test has its case")]
#[path = "../../examples/report/cloud.rs"]
mod cloud;
#[path = "../../examples/report/filters.rs"]
mod filters;
#[path = "../../examples/report/lamps.rs"]
mod lamps;
#[path = "../../examples/report/lines.rs"]
mod lines;
#[expect(dead_code, reason = "another test has its case")]
#[path = "../../examples/report/open.rs"]
mod open;
#[path = "../../examples/report/strategies.rs"]
mod strategies;
#[path = "../../examples/report/transmittance.rs"]
mod transmittance;
#[expect(dead_code, reason = "another test has its cases")]
#[path = "../../examples/report/visibility.rs"]
mod visibility;
#[expect(dead_code, reason = "another test has its cases")]
#[path = "../../examples/report/volumes.rs"]
mod volumes;

const EDGE: u32 = 16;

fn widest() -> Backend {
    Backend::Variant(Variant::widest())
}

fn measured(cases: &[Case<'_>], knobs: &[u32]) -> Result<Report, Box<dyn Error>> {
    let settings = WorkPrecision::new().backends(&[widest()]).knobs(knobs).size(EDGE, EDGE);
    let report = settings.repetitions(2).time(Duration::from_secs(3600)).run(cases)?;
    println!("{}", report.table());
    Ok(report)
}

/// The fitted order of each method is that of theory, to within `slack`.
#[track_caller]
fn assert_orders(report: &Report, orders: &[(&str, f64)], slack: f64) {
    for case in &report.cases {
        assert_eq!(case.curves.len(), orders.len());
        for (curve, (name, order)) in case.curves.iter().zip(orders) {
            let what = format!("{} {name}: {:?}", case.name, curve.fit);
            assert_eq!(curve.method.name(), *name, "{what}");
            let fit = curve.fit.expect("three points above the floor");
            assert!((fit.order - order).abs() < slack, "{what}");
        }
    }
}

/// More texels, less error: as fast as the polynomials that a filter reproduces.
#[test]
fn filters_have_the_orders_of_theory() -> Result<(), Box<dyn Error>> {
    // More of them leave rounding alone to the fourth order, and fewer are not yet on the line.
    let report = measured(&[filters::case(EDGE)], &[16, 32, 64])?;
    assert_orders(&report, &filters::FILTERS, 0.35);
    Ok(())
}

/// Delta and ratio tracking have no bias, the jackknife a small one; errors fall as those of random
/// samples. Where extinction has a peak, few samples have most of the error, and so few pixels and seeds
/// say nothing of its order.
#[test]
fn estimates_of_transmittance_fall_as_random_ones() -> Result<(), Box<dyn Error>> {
    let edge = 8;
    for names in transmittance::NAMES {
        let settings = WorkPrecision::new().backends(&[widest()]).knobs(&[4, 16, 64, 256]);
        let settings = settings.size(edge, edge).repetitions(2).time(Duration::from_secs(3600));
        let report = settings.run(&[transmittance::case(names, edge)])?;
        println!("{}", report.table());
        for curve in &report.cases[0].curves {
            let what = format!("{} {}: {:?}", names.0, curve.method.name(), curve.fit);
            let fit = curve.fit.expect("four points above the floor");
            let is_random = fit.low - 0.1 < -0.5 && -0.5 < fit.high + 0.1;
            assert!(is_random || names.1 == "volume-spike", "{what}");
            let last = &curve.points[3];
            let is_biased = curve.method.name() == "jackknife";
            let bias = last.repetitions[0].metrics.bias.abs();
            assert!(
                if is_biased { bias < 5e-3 } else { last.bias_z().abs() < 5.0 },
                "{what} {bias}"
            );
        }
    }
    Ok(())
}

#[test]
fn lines_end_where_the_vortex_carries_them() -> Result<(), Box<dyn Error>> {
    let report = measured(&[lines::case(EDGE)], &[10, 100, 1000, 10_000])?;
    let curve = &report.cases[0].curves[0];
    let errors: Vec<f64> = curve.points.iter().map(|p| p.rmse()).collect();
    assert!(errors.is_sorted_by(|a, b| *a > 3.0 * b), "{errors:?}");
    assert!(errors[3] < 1e-4, "{errors:?}");
    Ok(())
}

/// Strict and fast arithmetic have the same error of sampling; a device's own functions are as good as
/// they need be for it.
#[test]
fn fast_arithmetic_is_good_enough_for_sampling() -> Result<(), Box<dyn Error>> {
    let case = arithmetic::case();
    let report = measured(core::slice::from_ref(&case), &[64, 256, 1024])?;
    for curve in &report.cases[0].curves {
        assert_eq!(curve.verdict(), Verdict::AsExpected, "{:?}", curve.fit);
    }
    let Some(gpu) = gpu() else { return Ok(()) };
    for method in case.methods() {
        let run = Run::new(method, Backend::Variant(Variant::Wgsl), 256).sized(EDGE, EDGE).on(gpu);
        let found = case.estimate(&run).map_err(|missing| missing.to_string())?;
        let error = Metrics::of(&found.values, case.reference()).rmse;
        assert!(error < 1e-3, "{}: {error}", method.name());
    }
    Ok(())
}

/// All ways of sampling have the same mean; and two of them at once are never much worse than the
/// better one.
#[test]
fn strategies_agree() -> Result<(), Box<dyn Error>> {
    for (name, ..) in strategies::SCENES {
        let case = strategies::case(name, 1024)?;
        let error = |method: &str| {
            let method = Method::from(method);
            let run = Run::new(&method, widest(), 256).sized(EDGE, EDGE).seeded(3);
            let found = case.estimate(&run).map_err(|missing| missing.to_string())?;
            Ok::<Metrics, String>(Metrics::of(&found.values, case.reference()))
        };
        let [bsdf, light, balance, power] = strategies::METHODS.map(error);
        let (bsdf, light) = (bsdf?, light?);
        for (found, method) in [&bsdf, &light].into_iter().zip(strategies::METHODS) {
            let bias = found.bias.abs();
            assert!(bias < 5.0 * found.bias_error + 1e-4, "{name} {method}: {found:?}");
        }
        let better = bsdf.rmse.min(light.rmse);
        for found in [balance?, power?] {
            assert!(found.bias.abs() < 5.0 * found.bias_error + 1e-4, "{name}: {found:?}");
            // An extreme lamp makes the balance heuristic many times as bad as the right choice, but
            // nowhere near as bad as the wrong one.
            let worse = bsdf.rmse.max(light.rmse);
            let most = (3.0 * better).max((better * worse).sqrt());
            assert!(found.rmse <= most + 1e-4, "{name}: {} of {better} {worse}", found.rmse);
        }
    }
    Ok(())
}

/// A tree of lamps is better than a choice by power, which is better than any lamp; the sum of all has
/// no error.
#[test]
fn lamps_that_matter_are_chosen() -> Result<(), Box<dyn Error>> {
    for (name, count) in lamps::NAMES {
        let report = measured(&[lamps::case(name, EDGE)?], &[64, 256])?;
        let errors: Vec<f64> =
            report.cases[0].curves.iter().map(|curve| curve.points[1].rmse()).collect();
        let [uniform, power, tree, each] = errors[..] else { panic!("four methods") };
        assert!(each < 1e-5 && tree < power, "{name}: {errors:?}");
        // Of a few lamps Sobol points take each as often.
        assert!(count < 100 || (power < uniform && tree < 0.3 * power), "{name}: {errors:?}");
        for curve in &report.cases[0].curves[..3] {
            let z = curve.points[1].bias_z();
            assert!(z.abs() < 6.0, "{name} {}: {z}", curve.method.name());
        }
    }
    Ok(())
}

/// Hits do not depend on the tree, so that every builder has the same picture.
#[test]
fn builders_have_the_same_picture() -> Result<(), Box<dyn Error>> {
    let at = |i: u32, k: u32| {
        let mut rng = Rng::new(uvec2(i, k), 0, 5);
        rng.next_3d() * vec3(20.0, 5.0, 6.0) - vec3(10.0, 0.0, 3.0)
    };
    let triangle = |i: u32| {
        let v0 = at(i, 0);
        // Some are long.
        let size = if i.is_multiple_of(9) { 0.5 } else { 0.08 };
        Triangle { v0, v1: v0.lerp(at(i, 1), size), v2: v0.lerp(at(i, 2), 0.08) }
    };
    let scene = builders::hall((0..900).map(triangle).collect());
    let case = builders::case("triangles", scene, 4)?;
    let of = |method: &str| {
        let method = Method::from(method);
        let run = Run::new(&method, widest(), 8).sized(EDGE, EDGE);
        case.estimate(&run).map(|e| e.values).map_err(|missing| missing.to_string())
    };
    let first = of(builders::METHODS[0])?;
    assert!(first.iter().any(|v| *v > 0.0) && first.iter().any(|v| *v < 1.0), "{first:?}");
    for method in &builders::METHODS[1..] {
        assert_eq!(of(method)?, first, "{method}");
    }
    Ok(())
}
