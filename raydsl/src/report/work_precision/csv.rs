//! `points.csv`.

use core::fmt::Write;

use super::curve::{Curve, Point, Repetition};
use super::{Measured, Report};

/// The columns of [`Report::csv`].
const COLUMNS: &str = "case,reference_kind,reference_uncertainty,rounding_floor,backend,lanes,\
                       method,knob,knob_value,seed,repetitions,seconds,t_min,t_median,samples,\
                       rays,counted,rmse,mae,max,p99,rel_mse,rel_mse_trimmed,bias,bias_z,nan,inf,\
                       negative,rounding,order,order_low,order_high,status";

impl Report {
    /// A header and a row for each run; and one for each point that was not run, whose status says
    /// why. Times are seconds, `rounding` the difference to the same samples in `f64`. What is not
    /// known is empty.
    pub fn csv(&self) -> String {
        let mut text = format!("{COLUMNS}\n");
        for case in &self.cases {
            for curve in &case.curves {
                rows(&mut text, case, curve);
            }
        }
        text
    }
}

fn rows(text: &mut String, case: &Measured, curve: &Curve) {
    if let Some(missing) = &curve.missing {
        let why = quoted(&format!("omitted: {}", first_line(&missing.to_string())));
        let _ = writeln!(text, "{}{}{why}", head(case, curve), ",".repeat(25));
        return;
    }
    for point in &curve.points {
        if point.repetitions.is_empty() {
            let (knob, status) = (point.knob, point.status().name());
            let head = head(case, curve);
            let _ = writeln!(text, "{head},{knob},,0{}{status}", ",".repeat(22));
        }
        for repetition in &point.repetitions {
            row(text, case, curve, point, repetition);
        }
    }
}

/// Up to the knob's name.
fn head(case: &Measured, curve: &Curve) -> String {
    let (kind, unsure, floor) = (case.kind.name(), case.uncertainty, case.rounding_floor);
    let (name, method, knob) = (quoted(&case.name), quoted(&curve.method.name), quoted(&case.knob));
    let (backend, lanes) = (curve.backend.name(), curve.backend.lanes());
    format!("{name},{kind},{unsure:e},{floor:e},{backend},{lanes},{method},{knob}")
}

fn row(text: &mut String, case: &Measured, curve: &Curve, point: &Point, run: &Repetition) {
    let m = &run.metrics;
    let whole = |n: Option<u64>| n.map_or_else(String::new, |n| n.to_string());
    let number = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:e}"));
    let _ = write!(text, "{},{},{},", head(case, curve), point.knob, run.seed);
    let _ = write!(
        text,
        "{},{:e},{:e},{:e},",
        point.repetitions.len(),
        run.seconds,
        point.t_min(),
        point.t_median()
    );
    let _ = write!(text, "{},{},{},", run.samples, whole(run.rays), whole(run.counted));
    let _ = write!(text, "{:e},{:e},{:e},{:e},", m.rmse, m.mae, m.max, m.p99);
    let _ = write!(text, "{:e},{:e},{:e},", m.rel_mse, m.rel_mse_trimmed, m.bias);
    let _ = write!(text, "{:e},{},{},{},", m.bias_z(), m.nan, m.inf, m.negative);
    let fit = curve.fit;
    let (order, low, high) = (fit.map(|f| f.order), fit.map(|f| f.low), fit.map(|f| f.high));
    let _ = write!(text, "{},{},{},", number(point.rounding), number(order), number(low));
    let _ = writeln!(text, "{},{}", number(high), run.status.name());
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// As RFC 4180 asks for it.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
