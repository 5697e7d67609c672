//! Tables that help to choose: methods and backends of a family of cases side by side.

use core::fmt::Write;

use super::curve::Curve;
use super::fit::Reached;
use super::table::WIDTH;
use super::{Measured, Report};

/// The errors whose times are compared.
const LIMITS: [f64; 2] = [1e-2, 1e-3];
/// The width of a method's name.
const NAME: usize = 16;

impl Report {
    /// Returns the names of the families of its cases, in order; cases without one have none.
    pub fn families(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for case in &self.cases {
            if !case.family.is_empty() && !names.contains(&case.family.as_str()) {
                names.push(&case.family);
            }
        }
        names
    }

    /// Returns a table of a [family](super::Case::family) for each of the errors 1e-2 and 1e-3, with
    /// a row for each method and a column for each backend: how many times as long as the quickest
    /// curve of the case it took until the root of the mean square error was no larger, as the
    /// geometric mean over the cases. Lines have at most 100 columns.
    ///
    /// Where not all cases are in a mean, their number stands behind it: the others were not that
    /// exact within the time budget. `<` stands before a mean with a curve that was exact enough at
    /// its first point, and `-` where there is none.
    pub fn choice(&self, family: &str) -> String {
        let cases: Vec<&Measured> = self.cases.iter().filter(|c| c.family == family).collect();
        let names: Vec<&str> = cases.iter().map(|c| c.name.as_str()).collect();
        let mut text = wrapped(&format!("{family}: {}", names.join(", ")));
        for limit in LIMITS {
            text += &table(&cases, limit);
        }
        if self.environment.has_debug_assertions {
            text += "measured with debug assertions: times mean little\n";
        }
        text
    }
}

/// Returns a text in lines of at most [`WIDTH`], divided at spaces where there are any.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last().map_or(0, |l| l.chars().count());
        if last > 0 && last + 1 + word.chars().count() > WIDTH {
            lines.push("  ".to_owned());
        } else if last > 0 {
            lines.iter_mut().last().into_iter().for_each(|l| l.push(' '));
        }
        let cut: String = word.chars().take(WIDTH - 2).collect();
        lines.iter_mut().last().into_iter().for_each(|l| l.push_str(&cut));
    }
    lines.join("\n") + "\n"
}

/// Returns the time to an error, and whether it is only known to be no longer.
fn time(curve: &Curve, limit: f64) -> Option<(f64, bool)> {
    match curve.time_to_error(limit) {
        Reached::At(seconds) => Some((seconds, false)),
        Reached::AtMost(seconds) => Some((seconds, true)),
        Reached::Never => None,
    }
}

fn table(cases: &[&Measured], limit: f64) -> String {
    // The cases that any curve solves, with the time of the quickest.
    let quickest = |case: &&Measured| {
        let times = case.curves.iter().filter_map(|c| time(c, limit)).map(|t| t.0);
        times.min_by(f64::total_cmp)
    };
    let solved: Vec<(&Measured, f64)> =
        cases.iter().filter_map(|c| quickest(c).map(|t| (*c, t))).collect();
    if solved.is_empty() {
        return format!("\nerror {limit:.0e}: no method was that exact within its time\n");
    }
    let base = geometric_mean(solved.iter().map(|s| s.1));
    let methods = distinct(cases, |c| c.method.name());
    let backends = distinct(cases, |c| c.backend.name());
    let mut text = format!("\nerror {limit:.0e}; 1 is {base:.1e} s");
    if solved.len() < cases.len() {
        let _ = write!(text, ", in {} of {} cases", solved.len(), cases.len());
    }
    let _ = write!(text, "\n{:<NAME$}", "method");
    backends.iter().for_each(|b| text += &format!(" {b:>11}"));
    text.push('\n');
    for method in methods {
        let name: String = method.chars().take(NAME).collect();
        let _ = write!(text, "{name:<NAME$}");
        for backend in &backends {
            let _ = write!(text, " {:>11}", cell(&solved, method, backend, limit));
        }
        text.push('\n');
    }
    text
}

/// Returns the different names of curves, in order.
fn distinct<'c>(cases: &[&'c Measured], name: impl Fn(&'c Curve) -> &'c str) -> Vec<&'c str> {
    let mut names = Vec::new();
    for curve in cases.iter().flat_map(|c| &c.curves) {
        if !names.contains(&name(curve)) {
            names.push(name(curve));
        }
    }
    names
}

/// Returns the mean ratio of a method on a backend to the quickest of each case.
fn cell(solved: &[(&Measured, f64)], method: &str, backend: &str, limit: f64) -> String {
    let is_it = |c: &&Curve| c.method.name() == method && c.backend.name() == backend;
    let found: Vec<(f64, bool)> = solved
        .iter()
        .filter_map(|(case, base)| {
            let (seconds, is_bound) = time(case.curves.iter().find(is_it)?, limit)?;
            Some((seconds / base, is_bound))
        })
        .collect();
    if found.is_empty() {
        return "-".to_owned();
    }
    let mean = rounded(geometric_mean(found.iter().map(|f| f.0)));
    let bound = if found.iter().any(|f| f.1) { "<" } else { "" };
    let count =
        if found.len() < solved.len() { format!(" ({})", found.len()) } else { String::new() };
    format!("{bound}{mean}{count}")
}

/// Prints a ratio with two digits, or more before the point.
fn rounded(ratio: f64) -> String {
    if ratio < 9.95 { format!("{ratio:.1}") } else { format!("{ratio:.0}") }
}

fn geometric_mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let logs: Vec<f64> = numbers.map(f64::ln).collect();
    (logs.iter().sum::<f64>() / logs.len() as f64).exp()
}
