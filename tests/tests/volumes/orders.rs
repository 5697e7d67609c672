//! Orders of convergence of rules of steps: those of theory.

use std::time::Duration;

use raydsl::prelude::*;
use raydsl_report::work_precision::{Backend, Method, Metrics, Run, WorkPrecision};

use super::cases::{FIELDS, OTHERS, RULES, case};

const EDGE: u32 = 5;

/// In `f64`, where no rounding hides the error of many steps.
#[test]
fn rules_have_the_orders_of_theory() {
    let cases = FIELDS.map(|name| case(name, EDGE));
    let settings = WorkPrecision::new().backends(&[Backend::F64]).knobs(&[4, 8, 16, 32]);
    let report = settings
        .size(EDGE, EDGE)
        .repetitions(1)
        .time(Duration::from_secs(300))
        .run(&cases)
        .expect("no device is needed");
    println!("{}", report.table());
    assert_eq!(report.cases.len(), FIELDS.len());
    for case in &report.cases {
        assert_eq!(case.curves.len(), RULES.len() + OTHERS.len());
        for (curve, (name, _, order)) in case.curves.iter().zip(RULES) {
            let what = format!("{} {name}: {:?}", case.name, curve.fit);
            let fit = curve.fit.expect("four points");
            // Where samples fall on a peak is an accident, so that few rays make a wide interval.
            let slack = if fit.low <= order && order <= fit.high { 0.4 } else { 0.1 };
            assert!((fit.order - order).abs() < slack, "{what}");
        }
    }
}

/// Every variant has the errors of the rule, not of its own.
#[test]
fn variants_have_the_error_of_the_rule() {
    for case in &FIELDS.map(|name| case(name, EDGE)) {
        for (name, ..) in RULES {
            let method = Method::from(name);
            let error = |backend| {
                let run = Run::new(&method, backend, 8).sized(EDGE, EDGE);
                let run = raydsl_tests::gpu::gpu().map_or(run, |gpu| run.on(gpu));
                let found = case.estimate(&run).expect("a device, if it is asked for one");
                Metrics::of(&found.values, case.reference()).rmse
            };
            let expected = error(Backend::F64);
            for variant in Variant::ALL {
                if raydsl::testing::can_run(variant, "orders") {
                    let found = error(Backend::Variant(variant));
                    let off = (found - expected).abs();
                    let variant = variant.name();
                    assert!(
                        off < 0.01 * expected + 2e-6,
                        "{variant}, {name}: {found}, not {expected}"
                    );
                }
            }
        }
    }
}
