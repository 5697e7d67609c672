//! Writer of `omissions.md`.

use core::fmt::Write;

use super::curve::{Curve, Point, Status, Verdict};
use super::work::Work;
use super::{Measured, Omitted, Report};

/// Data that no file of a report has, and why.
const NOWHERE: &[(&str, &str)] = &[
    #[cfg(not(feature = "flip"))]
    (
        "FLIP",
        "raydsl-report was built without the feature `flip`: `--features flip` adds it, and needs a C++ \
         compiler",
    ),
    ("clamped energy, `clamped`", "nothing clamps: estimates are what the samples gave"),
    ("errors of each channel", "estimates are the red channel"),
    ("time to the first pixel, `t_first_pixel`", "a run gives all its pixels at once"),
    (
        "what a driver compiles at the first dispatch",
        "nothing tells it apart: `t_compile` ends before, `t_first` contains it",
    ),
    #[cfg(not(feature = "cpu_time"))]
    (
        "time of the processors, `cpu_s`",
        "raydsl-report was built without the feature `cpu_time`; `seconds` are those of a clock",
    ),
    ("calls of exp, look-ups of a density", "a kernel that counts them has them in `counted`"),
];

impl Report {
    /// Returns everything omitted from the tables, fits and curves, and data that no report has,
    /// with reasons, as Markdown.
    pub fn omissions(&self) -> String {
        let whole = |o: &Omitted| row(&o.case, "all", "all", "the case", &o.why);
        let mut rows: Vec<String> = self.omitted.iter().map(whole).collect();
        rows.extend(self.cases.iter().flat_map(of_case));
        let mut text = "# What is left out\n\n".to_owned();
        if rows.is_empty() {
            text += "Nothing: every point was run, and counts.\n";
        } else {
            text += "| case | method | backend | what | why |\n|---|---|---|---|---|\n";
            text += &rows.concat();
        }
        text += "\n## What no report has\n\n| what | why |\n|---|---|\n";
        NOWHERE.iter().for_each(|(what, why)| text += &format!("| {what} | {why} |\n"));
        text
    }
}

fn of_case(case: &Measured) -> Vec<String> {
    let not_asked_for = |method: &String| row(&case.name, method, "all", "all", "not asked for");
    let mut rows: Vec<String> = case.not_asked_for.iter().map(not_asked_for).collect();
    rows.extend(case.curves.iter().flat_map(|curve| of_curve(case, curve)));
    rows.extend(uncounted(case));
    #[cfg(feature = "flip")]
    rows.extend(unseen(case));
    rows
}

/// Returns a row for the missing FLIP of estimates that are not a picture.
#[cfg(feature = "flip")]
fn unseen(case: &Measured) -> Option<String> {
    let mut runs = case.curves.iter().flat_map(|c| &c.points).flat_map(|p| &p.repetitions);
    let has_none = runs.all(|r| r.flip.is_none());
    has_none.then(|| row(&case.name, "all", "all", "FLIP", "the estimates are no picture"))
}

/// A function that returns the count of a unit.
type Unit = fn(&Work) -> Option<u64>;

/// Returns a row for the units in which nothing of a case is counted.
fn uncounted(case: &Measured) -> Option<String> {
    let points = || case.curves.iter().flat_map(|c| &c.points).map(Point::work);
    let units: [(&str, Unit); 4] = [
        ("rays", |w| w.rays),
        ("nodes", |w| w.nodes),
        ("primitive tests", |w| w.primitives),
        ("texture fetches", |w| w.texture_fetches),
    ];
    let is_missing = |of: Unit| points().all(|w| of(&w).is_none());
    let missing: Vec<&str> = units.iter().filter(|u| is_missing(u.1)).map(|u| u.0).collect();
    let list = (!missing.is_empty()).then(|| missing.join(", "))?;
    Some(row(&case.name, "all", "all", &list, "the case does not count them"))
}

fn of_curve(case: &Measured, curve: &Curve) -> Vec<String> {
    let row = |what: &str, why: &str| {
        row(&case.name, curve.method.name(), curve.backend.name(), what, why)
    };
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
    let ran = curve.points.iter().filter(|p| !p.repetitions.is_empty());
    let without: Vec<String> =
        ran.filter(|p| p.efficiency().is_none()).map(|p| p.knob.to_string()).collect();
    if !without.is_empty() {
        let what = format!("the efficiency at {} = {}", case.knob, without.join(", "));
        rows.push(row(&what, "fewer than three runs gave finite numbers, or runs do not differ"));
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

fn row(case: &str, method: &str, backend: &str, what: &str, why: &str) -> String {
    let mut text = String::new();
    let cells = [case, method, backend, what, why];
    for cell in cells {
        let cell = cell.replace('|', "\\|").replace(['\n', '\r'], " ");
        let _ = write!(text, "| {cell} ");
    }
    text + "|\n"
}
