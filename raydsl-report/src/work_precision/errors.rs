//! Text table of errors, with their formulas.

use core::fmt::Write;

use super::curve::{Curve, Point};
use super::efficiency::Efficiency;
#[cfg(feature = "flip")]
use super::flip::Flip;
use super::table::{WIDTH, cut};
use super::{FORMULAS, Measured, Report};

const HEADER: &str = "method     backend      knob    rmse rel_mse trimmed    mrse bias_z  \
                      efficiency (95 %)";

impl Report {
    /// Returns a table for each case, and the formula of each column; no line is longer than 100
    /// columns.
    ///
    /// Errors are the mean over the runs at the largest value of the knob that was run, except the
    /// root of the mean square error, which is over all runs. `trimmed` is `rel_mse` without the
    /// worst 0.1 %. The [`Efficiency`] is of the same runs, `-` if it has none. With the feature
    /// `flip`, FLIP of pictures follows below.
    pub fn errors(&self) -> String {
        let mut text = self.cases.iter().map(table).collect::<Vec<_>>().join("\n");
        text += "\nn finite estimates x of references r, d = x - r\n";
        for (name, formula) in FORMULAS {
            text += &wrapped(name, formula);
        }
        text
    }
}

fn table(case: &Measured) -> String {
    let mut text = cut(&format!("{}: at the largest {} that was run", case.name, case.knob));
    text += HEADER;
    text += "\n";
    for curve in &case.curves {
        text += &cut(&line(curve));
    }
    #[cfg(feature = "flip")]
    flips(case, &mut text);
    text
}

/// Prints the FLIP differences, averaged over the same runs.
#[cfg(feature = "flip")]
fn flips(case: &Measured, text: &mut String) {
    let of_curve = |curve: &Curve| {
        let point = curve.points.iter().rev().find(|p| !p.repetitions.is_empty())?;
        let runs = || point.repetitions.iter().filter_map(|r| r.flip.zip(r.hdr_flip));
        let n = runs().count() as f64;
        let mean = |of: &dyn Fn((Flip, Flip)) -> f64| runs().map(of).sum::<f64>() / n;
        let numbers = |of: fn((Flip, Flip)) -> Flip| {
            [mean(&|f| of(f).mean), mean(&|f| of(f).median), mean(&|f| of(f).p95)]
        };
        let all = [numbers(|f| f.0), numbers(|f| f.1)].concat();
        let all: String = all.iter().map(|v| format!(" {v:>8.1e}")).collect();
        let name: String = curve.method.name.chars().take(10).collect();
        let line = format!("{name:<10} {:<8} {:>8}{all}", curve.backend.name(), point.knob);
        (n > 0.0).then(|| cut(&line))
    };
    let lines: Vec<String> = case.curves.iter().filter_map(of_curve).collect();
    if !lines.is_empty() {
        *text +=
            "method     backend      knob     flip   median      p95 hdr_flip   median      p95\n";
        *text += &lines.concat();
    }
}

fn line(curve: &Curve) -> String {
    let name: String = curve.method.name.chars().take(10).collect();
    let mut text = format!("{name:<10} {:<8}", curve.backend.name());
    if let Some(missing) = &curve.missing {
        let why = missing.to_string();
        return text + "  " + why.lines().next().unwrap_or_default();
    }
    let Some(point) = curve.points.iter().rev().find(|p| !p.repetitions.is_empty()) else {
        return text + "  not run";
    };
    let mean = |of: fn(&super::Metrics) -> f64| mean(point, of);
    let (rel_mse, trimmed) = (mean(|m| m.rel_mse), mean(|m| m.rel_mse_trimmed));
    let _ = write!(text, " {:>8} {:>7.1e} {rel_mse:>7.1e}", point.knob, point.rmse());
    let _ = write!(text, " {trimmed:>7.1e} {:>7.1e}", mean(|m| m.mrse));
    let efficiency = point.efficiency().map_or_else(|| "-".to_owned(), interval);
    let _ = write!(text, " {:>6.1}  {efficiency}", point.bias_z());
    text
}

fn mean(point: &Point, of: fn(&super::Metrics) -> f64) -> f64 {
    let sum: f64 = point.repetitions.iter().map(|r| of(&r.metrics)).sum();
    sum / point.repetitions.len() as f64
}

fn interval(found: Efficiency) -> String {
    format!("{:.1e} ({:.1e} .. {:.1e})", found.value, found.low, found.high)
}

/// Prints a name and its formula, wrapped below itself if it is long.
fn wrapped(name: &str, formula: &str) -> String {
    let mut text = format!("{name:<16}");
    let mut column = text.len();
    for word in formula.split(' ') {
        if column + 1 + word.len() > WIDTH {
            text += &format!("\n{:<16}", "");
            column = 16;
        }
        text += " ";
        text += word;
        column += 1 + word.len();
    }
    text + "\n"
}
