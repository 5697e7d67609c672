//! Writer of `points.csv`.

use super::curve::{Curve, Point, Repetition};
#[cfg(feature = "flip")]
use super::flip::Flip;
use super::{Environment, Measured, Omitted, Report};

/// The columns of [`Report::csv`]: those common to a curve, those of a run, and those of the
/// machine.
const OF_CURVE: &[&str] = &[
    "case",
    "reference_kind",
    "reference_uncertainty",
    "rounding_floor",
    "backend",
    "lanes",
    "method",
    "knob",
    "t_build",
    "t_first",
    "t_compile",
    "order",
    "order_low",
    "order_high",
    "expected_low",
    "expected_high",
    "code",
    "knob_value",
    "repetitions",
];
const OF_RUN: &[&str] = &[
    "seed",
    "seconds",
    "cpu_s",
    "t_min",
    "t_p10",
    "t_median",
    "t_p90",
    "samples",
    "rays",
    "nodes",
    "primitive_tests",
    "texture_fetches",
    "counted",
    "error",
    "error_low",
    "error_high",
    "mse",
    "rmse",
    "rmse_p10",
    "rmse_p90",
    "mae",
    "max",
    "p99",
    "rel_mse",
    "rel_mse_trimmed",
    "mrse",
    "bias",
    "bias_z",
    "efficiency",
    "efficiency_low",
    "efficiency_high",
    "nan",
    "inf",
    "negative",
    "rounding",
    #[cfg(feature = "flip")]
    "flip_mean",
    #[cfg(feature = "flip")]
    "flip_median",
    #[cfg(feature = "flip")]
    "flip_p95",
    #[cfg(feature = "flip")]
    "hdr_flip_mean",
    #[cfg(feature = "flip")]
    "hdr_flip_median",
    #[cfg(feature = "flip")]
    "hdr_flip_p95",
];
const OF_MACHINE: &[&str] = &["features", "version", "commit", "cpu", "gpu", "driver", "status"];

impl Report {
    /// Returns a header and a row for each run; and one for each point that was not run, with the
    /// reason in its status, and for each omitted case. Times are seconds; those that begin with
    /// `t_`, `error` (the root of the mean square error) with its 95 % interval, `rmse_p10`,
    /// `rmse_p90` and the efficiency are of all runs of the point. `rounding` is the difference to
    /// the same samples in `f64`, `code` the hash of the kernel's WGSL. Unknown values are empty.
    pub fn csv(&self) -> String {
        let header = [OF_CURVE, OF_RUN, OF_MACHINE].concat().join(",");
        let mut lines = vec![header];
        for case in &self.cases {
            for curve in &case.curves {
                lines.extend(rows(&self.environment, case, curve));
            }
        }
        lines.extend(self.omitted.iter().map(|o| left_out(&self.environment, o)));
        lines.join("\n") + "\n"
    }
}

/// Returns the row of an omitted case.
fn left_out(environment: &Environment, omitted: &Omitted) -> String {
    let mut cells = vec![String::new(); OF_CURVE.len() + OF_RUN.len()];
    cells[0] = quoted(&omitted.case);
    let why = format!("omitted: {}", first_line(&omitted.why));
    [cells, of_machine(environment, &why)].concat().join(",")
}

fn rows(environment: &Environment, case: &Measured, curve: &Curve) -> Vec<String> {
    let line = |point: [String; 2], run: Vec<String>, status: &str| {
        let all = [of_curve(case, curve), point.to_vec(), run, of_machine(environment, status)];
        all.concat().join(",")
    };
    let nothing = || vec![String::new(); OF_RUN.len()];
    if let Some(missing) = &curve.missing {
        let why = format!("omitted: {}", first_line(&missing.to_string()));
        return vec![line(Default::default(), nothing(), &why)];
    }
    let of_point = |point: &Point| {
        let head = || [point.knob.to_string(), point.repetitions.len().to_string()];
        if point.repetitions.is_empty() {
            return vec![line(head(), nothing(), point.status().name())];
        }
        let row = |run: &Repetition| line(head(), of_run(point, run), run.status.name());
        point.repetitions.iter().map(row).collect::<Vec<_>>()
    };
    curve.points.iter().flat_map(of_point).collect()
}

/// Returns the cells up to the knob's value.
fn of_curve(case: &Measured, curve: &Curve) -> Vec<String> {
    let (fit, expected) = (curve.fit, curve.expected);
    vec![
        quoted(&case.name),
        case.kind.name().to_owned(),
        number(case.uncertainty),
        number(case.rounding_floor),
        curve.backend.name().to_owned(),
        curve.backend.lanes().to_string(),
        quoted(&curve.method.name),
        quoted(&case.knob),
        perhaps(case.build),
        perhaps(curve.first_run),
        perhaps(curve.compile),
        perhaps(fit.map(|f| f.order)),
        perhaps(fit.map(|f| f.low)),
        perhaps(fit.map(|f| f.high)),
        perhaps(expected.map(|o| o.steepest)),
        perhaps(expected.map(|o| o.flattest)),
        curve.code.map_or_else(String::new, |hash| format!("{hash:016x}")),
    ]
}

fn of_run(point: &Point, run: &Repetition) -> Vec<String> {
    let (m, work, efficiency) = (&run.metrics, point.work(), point.efficiency());
    let error = point.rmse_interval();
    let whole = |n: Option<u64>| n.map_or_else(String::new, |n| n.to_string());
    let cells = vec![
        run.seed.to_string(),
        number(run.seconds),
        perhaps(run.cpu_seconds),
        number(point.t_min()),
        number(point.t_quantile(0.1)),
        number(point.t_median()),
        number(point.t_quantile(0.9)),
        run.samples.to_string(),
        whole(work.rays),
        whole(work.nodes),
        whole(work.primitives),
        whole(work.texture_fetches),
        whole(run.counted),
        number(point.rmse()),
        perhaps(error.map(|ends| ends[0])),
        perhaps(error.map(|ends| ends[1])),
        number(m.mse),
        number(m.rmse),
        number(point.rmse_quantile(0.1)),
        number(point.rmse_quantile(0.9)),
        number(m.mae),
        number(m.max),
        number(m.p99),
        number(m.rel_mse),
        number(m.rel_mse_trimmed),
        number(m.mrse),
        number(m.bias),
        number(m.bias_z()),
        perhaps(efficiency.map(|e| e.value)),
        perhaps(efficiency.map(|e| e.low)),
        perhaps(efficiency.map(|e| e.high)),
        m.nan.to_string(),
        m.inf.to_string(),
        m.negative.to_string(),
        perhaps(point.rounding),
    ];
    #[cfg(feature = "flip")]
    let cells = [cells, of_flip(run)].concat();
    cells
}

#[cfg(feature = "flip")]
fn of_flip(run: &Repetition) -> Vec<String> {
    let numbers = |flip: Option<Flip>| {
        let of = |number: fn(Flip) -> f64| perhaps(flip.map(number));
        [of(|f| f.mean), of(|f| f.median), of(|f| f.p95)]
    };
    [numbers(run.flip), numbers(run.hdr_flip)].concat()
}

fn of_machine(environment: &Environment, status: &str) -> Vec<String> {
    vec![
        environment.features.join(" "),
        environment.version.to_owned(),
        quoted(&environment.commit),
        quoted(&environment.cpu),
        quoted(environment.gpu.as_deref().unwrap_or_default()),
        quoted(environment.driver.as_deref().unwrap_or_default()),
        quoted(status),
    ]
}

fn number(v: f64) -> String {
    format!("{v:e}")
}

fn perhaps(v: Option<f64>) -> String {
    v.map_or_else(String::new, number)
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// Quotes a cell according to RFC 4180.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
