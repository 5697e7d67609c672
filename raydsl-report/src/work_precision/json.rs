//! Writer of `report.json`.

use serde_json::{Value, json};

use super::case::Order;
use super::curve::{Curve, Point, Repetition};
use super::fit::Reached;
use super::work::Work;
use super::{FORMULAS, Measured, Report};

/// The errors for which times are reported.
pub(super) const ERRORS: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];

/// The times, in seconds, for which errors are reported.
pub(super) const TIMES: [f64; 3] = [0.1, 1.0, 10.0];

impl Report {
    /// Returns the whole report as JSON. Numbers that are not finite are strings.
    pub fn json(&self) -> Value {
        let e = &self.environment;
        let backend = |(name, isa, lanes): &(&str, &str, usize)| json!([name, isa, lanes]);
        json!({
            "environment": {
                "cpu": e.cpu,
                "os": e.os,
                "gpu": e.gpu,
                "driver": e.driver,
                "backends": e.backends.iter().map(backend).collect::<Vec<_>>(),
                "threads": e.threads,
                "debug_assertions": e.has_debug_assertions,
                "version": e.version,
                "features": e.features,
                "commit": e.commit,
            },
            "formulas": FORMULAS.iter().map(|(n, f)| json!([n, f])).collect::<Vec<_>>(),
            "size": [self.size.0, self.size.1],
            "cases": self.cases.iter().map(case).collect::<Vec<_>>(),
            "omitted": self.omitted.iter().map(|o| json!([o.case, o.why])).collect::<Vec<_>>(),
        })
    }
}

fn number(v: f64) -> Value {
    if v.is_finite() { v.into() } else { v.to_string().into() }
}

fn case(case: &Measured) -> Value {
    json!({
        "case": case.name,
        "family": case.family,
        "family": case.family,
        "knob": case.knob,
        "reference_kind": case.kind.name(),
        "reference_uncertainty": case.uncertainty,
        "rounding_floor": case.rounding_floor,
        "t_build": case.build,
        "curves": case.curves.iter().map(curve).collect::<Vec<_>>(),
        "not_asked_for": case.not_asked_for,
    })
}

fn curve(curve: &Curve) -> Value {
    let to_error = |e: &f64| json!([number(*e), reached(curve.time_to_error(*e))]);
    let at_time = |t: &f64| json!([number(*t), reached(curve.error_at_time(*t))]);
    json!({
        "method": curve.method.name,
        "backend": curve.backend.name(),
        "lanes": curve.backend.lanes(),
        "t_first": curve.first_run,
        "t_compile": curve.compile,
        "code": curve.code.map(|hash| format!("{hash:016x}")),
        "not_run": curve.missing.as_ref().map(ToString::to_string),
        "order": curve.fit.map(|f| f.order),
        "order_low": curve.fit.map(|f| number(f.low)),
        "order_high": curve.fit.map(|f| number(f.high)),
        "order_points": curve.fit.map(|f| f.points),
        "order_expected": curve.expected.map(expected),
        "verdict": curve.verdict().name(),
        "time_to_error": ERRORS.iter().map(to_error).collect::<Vec<_>>(),
        "error_at_time": TIMES.iter().map(at_time).collect::<Vec<_>>(),
        "speedup": curve.speedup.map(|s| json!({
            "ratio": s.ratio, "low": number(s.low), "high": number(s.high),
            "is_claimed": s.is_claimed(),
        })),
        "points": curve.points.iter().map(point).collect::<Vec<_>>(),
    })
}

fn expected(order: Order) -> Value {
    json!([number(order.steepest), number(order.flattest)])
}

fn reached(reached: Reached) -> Value {
    match reached {
        Reached::At(v) => number(v),
        Reached::AtMost(v) => json!({ "at_most": number(v) }),
        Reached::Never => "not reached".into(),
    }
}

fn point(point: &Point) -> Value {
    json!({
        "knob_value": point.knob,
        "status": point.status().name(),
        "rmse": number(point.rmse()),
        "rmse_interval": point.rmse_interval().map(|ends| ends.map(number)),
        "rmse_p10": number(point.rmse_quantile(0.1)),
        "rmse_median": number(point.rmse_quantile(0.5)),
        "rmse_p90": number(point.rmse_quantile(0.9)),
        "bias_z": number(point.bias_z()),
        "t_min": number(point.t_min()),
        "t_p10": number(point.t_quantile(0.1)),
        "t_median": point.t_median(),
        "t_p90": number(point.t_quantile(0.9)),
        "cpu_s": point.cpu_seconds(),
        "samples": point.samples(),
        "work": work(&point.work()),
        "efficiency": point.efficiency().map(|e| json!({
            "value": number(e.value), "low": number(e.low), "high": number(e.high),
        })),
        "rounding": point.rounding.map(number),
        "repetitions": point.repetitions.iter().map(repetition).collect::<Vec<_>>(),
    })
}

/// Returns the work as JSON; units that were not counted are null.
fn work(work: &Work) -> Value {
    json!({
        "rays": work.rays,
        "nodes": work.nodes,
        "primitive_tests": work.primitives,
        "texture_fetches": work.texture_fetches,
    })
}

fn repetition(r: &Repetition) -> Value {
    let m = &r.metrics;
    let found = json!({
        "seed": r.seed,
        "seconds": r.seconds,
        "cpu_s": r.cpu_seconds,
        "counted": r.counted,
        "status": r.status.name(),
        "mse": number(m.mse),
        "rmse": number(m.rmse),
        "mae": number(m.mae),
        "max": number(m.max),
        "p99": number(m.p99),
        "rel_mse": number(m.rel_mse),
        "rel_mse_trimmed": number(m.rel_mse_trimmed),
        "mrse": number(m.mrse),
        "bias": number(m.bias),
        "bias_z": number(m.bias_z()),
        "nan": m.nan,
        "inf": m.inf,
        "negative": m.negative,
    });
    #[cfg(feature = "flip")]
    let found = with_flip(found, r);
    found
}

/// Adds FLIP to a repetition; null if the estimates are not a picture.
#[cfg(feature = "flip")]
fn with_flip(mut found: Value, r: &Repetition) -> Value {
    let numbers = |f: super::Flip| json!({ "mean": f.mean, "median": f.median, "p95": f.p95 });
    found["flip"] = r.flip.map_or(Value::Null, numbers);
    found["hdr_flip"] = r.hdr_flip.map_or(Value::Null, numbers);
    found
}
