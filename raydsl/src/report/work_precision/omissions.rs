//! `omissions.md`.

use core::fmt::Write;

use super::curve::{Curve, Status, Verdict};
use super::{Measured, Report};

impl Report {
    /// Everything that was left out of the tables, fits and curves, and why, as Markdown.
    pub fn omissions(&self) -> String {
        let rows: Vec<String> = self.cases.iter().flat_map(of_case).collect();
        let mut text = "# What is left out\n\n".to_owned();
        if rows.is_empty() {
            return text + "Nothing: every point was run, and counts.\n";
        }
        text += "| case | method | backend | what | why |\n|---|---|---|---|---|\n";
        text + &rows.concat()
    }
}

fn of_case(case: &Measured) -> Vec<String> {
    let not_asked_for = |method: &String| row(case, method, "all", "all", "not asked for");
    let mut rows: Vec<String> = case.not_asked_for.iter().map(not_asked_for).collect();
    rows.extend(case.curves.iter().flat_map(|curve| of_curve(case, curve)));
    rows
}

fn of_curve(case: &Measured, curve: &Curve) -> Vec<String> {
    let row =
        |what: &str, why: &str| row(case, curve.method.name(), curve.backend.name(), what, why);
    if let Some(missing) = &curve.missing {
        return vec![row("all", &missing.to_string())];
    }
    let mut rows = Vec::new();
    for status in [Status::Budget, Status::Diverged, Status::Floor] {
        let points = curve.points.iter().filter(|p| p.status() == status);
        let knobs: Vec<String> = points.map(|p| p.knob.to_string()).collect();
        if !knobs.is_empty() {
            rows.push(row(&format!("{} = {}", case.knob, knobs.join(", ")), why(status)));
        }
    }
    let most = curve.points.iter().map(|p| p.repetitions.len()).max().unwrap_or(0);
    let has_fewer = |n: usize| 0 < n && n < most;
    for p in curve.points.iter().filter(|p| has_fewer(p.repetitions.len())) {
        let what =
            format!("{} of {most} runs at {} = {}", most - p.repetitions.len(), case.knob, p.knob);
        rows.push(row(&what, why(Status::Budget)));
    }
    if curve.verdict() == Verdict::Unclear {
        let why = "too few points above the floor, or an interval wider than 0.5";
        rows.push(row("the verdict on the order", why));
    }
    if curve.speedup.is_some_and(|s| !s.is_claimed()) {
        rows.push(row("the speed-up", "its 95 % interval contains 1"));
    }
    rows
}

fn why(status: Status) -> &'static str {
    match status {
        Status::Budget => "the time was up",
        Status::Diverged => "estimates were no finite numbers",
        Status::Floor => "not above the reference's uncertainty or rounding: not fitted",
        Status::Ok => "it counts",
    }
}

fn row(case: &Measured, method: &str, backend: &str, what: &str, why: &str) -> String {
    let mut text = String::new();
    let cells = [&case.name, method, backend, what, why];
    for cell in cells {
        let cell = cell.replace('|', "\\|").replace(['\n', '\r'], " ");
        let _ = write!(text, "| {cell} ");
    }
    text + "|\n"
}
