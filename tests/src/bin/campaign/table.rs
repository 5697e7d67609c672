//! Tables: of a terminal, 100 columns wide, and of the book.

use std::fmt::Write as _;

use crate::Measured;
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Group, Miss, Row, Unit};

/// The head of a group's table.
pub(crate) fn head(group: &Group) -> String {
    let mut text = format!("{} ({})\n", group.title, group.name);
    for (i, clause) in group.clauses.iter().enumerate() {
        let lines = wrapped(clause, WIDTH - 5);
        let _ = writeln!(text, "  {}. {lines}", i + 1);
    }
    let _ = writeln!(
        text,
        "  {:<35}{:>6} {:<6}{:>8}{:>8}{:>8}{:>9} {:>9}  ",
        "row", "count", "unit", "CPU", "WGSL", "f64", "textbook", "bound",
    );
    text
}

/// Columns of a terminal.
const WIDTH: usize = 100;

/// A text in lines of at most `width` characters, indented by 5 but for the first.
fn wrapped(text: &str, width: usize) -> String {
    let (mut out, mut column) = (String::new(), 0);
    for word in text.split(' ') {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > width {
            out += "\n     ";
            column = 0;
        }
        if column > 0 {
            out.push(' ');
            column += 1;
        }
        out += word;
        column += length;
    }
    out
}

/// A row of it.
pub(crate) fn line(row: &Row, outcome: &Outcome) -> String {
    let [cpu, wgsl, f64] = cells(outcome);
    format!(
        "  {:<35}{:>6} {:<6}{:>8}{:>8}{:>8}{:>9} {:>9}  {}",
        row.name,
        short_count(most(outcome)),
        row.unit.name(),
        cpu,
        wgsl,
        f64,
        textbook(row, outcome),
        bound(row),
        verdict(row, outcome),
    )
}

/// Why a bound is missed, or the inputs of what broke it, below its row.
pub(crate) fn note(text: &str) -> String {
    format!("     {}", wrapped(text, WIDTH - 5))
}

/// All tables in Markdown, with an anchor for each group.
pub(crate) fn markdown(all: &[Measured]) -> String {
    let mut text = String::new();
    for Measured { group, rows } in all {
        let _ = writeln!(text, "<!-- ANCHOR: {} -->", group.name);
        for (i, clause) in group.clauses.iter().enumerate() {
            let _ = writeln!(text, "{}. {clause}", i + 1);
        }
        text.push('\n');
        text += &in_markdown(rows);
        let misses = rows.iter().filter(|(row, outcome)| row.is_known_miss(outcome));
        let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
        for (row, _) in misses {
            let Some(Miss { why, .. }) = row.miss else { continue };
            match reasons.iter_mut().find(|reason| reason.0 == why) {
                Some(reason) => reason.1.push(&row.name),
                None => reasons.push((why, vec![&row.name])),
            }
        }
        for (why, names) in reasons {
            let _ = writeln!(text, "\n*{}*: {why}", names.join("*, *"));
        }
        let _ = writeln!(text, "<!-- ANCHOR_END: {} -->\n", group.name);
    }
    text
}

/// A group's table in Markdown, without the columns that are empty in it.
fn in_markdown(rows: &[(Row, Outcome)]) -> String {
    const HEADS: [[&str; 2]; 10] = [
        ["row", "---"],
        ["inputs", "--:"],
        ["unit", "---"],
        ["CPU", "--:"],
        ["WGSL", "--:"],
        ["f64", "--:"],
        ["textbook", "--:"],
        ["bound", "--:"],
        ["clause", "--:"],
        ["", "---"],
    ];
    let cells = |(row, outcome): &(Row, Outcome)| {
        let [cpu, wgsl, f64] = marked(row, outcome);
        let bounds = bounds(row, !f64.is_empty());
        [
            row.name.to_string(),
            short_count(most(outcome)),
            row.unit.name().to_owned(),
            cpu,
            wgsl,
            f64,
            textbook(row, outcome),
            bounds,
            row.clause.to_string(),
            verdict(row, outcome).to_owned(),
        ]
    };
    let all: Vec<_> = rows.iter().map(cells).collect();
    let is_kept: [bool; 10] = core::array::from_fn(|i| all.iter().any(|row| !row[i].is_empty()));
    let joined = |cells: [&str; 10], by: &str| {
        let kept = cells.into_iter().zip(is_kept).filter_map(|(cell, kept)| kept.then_some(cell));
        kept.collect::<Vec<_>>().join(by)
    };
    let mut text = format!("| {} |\n", joined(HEADS.map(|head| head[0]), " | "));
    let _ = writeln!(text, "|{}|", joined(HEADS.map(|head| head[1]), "|"));
    for row in &all {
        let _ = writeln!(text, "| {} |", joined(row.each_ref().map(String::as_str), " | "));
    }
    text
}

/// The figures of the CPU's variants or of the host together, of WGSL, and of `f64`.
fn cells(outcome: &Outcome) -> [String; 3] {
    let is_of_cpu = |found: &&Found| !matches!(found.variant, "wgsl" | "f64");
    let worst = outcome.found.iter().filter(is_of_cpu).map(|found| found.worst);
    let cpu = worst.fold(None, |a: Option<f64>, b| Some(a.map_or(b, |a| a.max(b))));
    let of = |variant| outcome.of(variant).map(|found| found.worst);
    [cpu, of("wgsl"), of("f64")].map(|worst| worst.map_or_else(String::new, figure))
}

/// The same for Markdown: what misses its bound is bold.
fn marked(row: &Row, outcome: &Outcome) -> [String; 3] {
    let misses = |is_of_column: fn(&str) -> bool| {
        outcome.found.iter().any(|found| is_of_column(found.variant) && !row.keeps(found))
    };
    let marks =
        [misses(|v| !matches!(v, "wgsl" | "f64")), misses(|v| v == "wgsl"), misses(|v| v == "f64")];
    let mut cells = cells(outcome);
    for (cell, _) in cells.iter_mut().zip(marks).filter(|(_, is_missed)| *is_missed) {
        *cell = format!("**{cell}**");
    }
    cells
}

/// Faults as a share of the inputs, errors as they are.
fn textbook(row: &Row, outcome: &Outcome) -> String {
    match (outcome.textbook, row.unit) {
        (None, _) => String::new(),
        (Some(share), Unit::Faults) => format!("{:.2} %", 100.0 * share),
        (Some(worst), _) => figure(worst),
    }
}

/// The bounds of the CPU, of WGSL and of `f64`, if that has a figure and a bound of its own.
fn bounds(row: &Row, has_f64: bool) -> String {
    let Bound { cpu, wgsl, f64 } = row.bound;
    if has_f64 && f64 != wgsl {
        return [cpu, wgsl, f64].map(figure).join("/");
    }
    bound(row)
}

fn bound(row: &Row) -> String {
    let bound = row.bound;
    if bound.cpu == bound.wgsl {
        return figure(bound.cpu);
    }
    format!("{}/{}", figure(bound.cpu), figure(bound.wgsl))
}

/// `miss` of a bound that is known not to hold, `BITS` if packets have other bits than the scalar variant.
pub(crate) fn verdict(row: &Row, outcome: &Outcome) -> &'static str {
    if row.holds(outcome) {
        "holds"
    } else if outcome.other_bits > 0 {
        "BITS"
    } else if row.is_known_miss(outcome) {
        "miss"
    } else {
        "FAILS"
    }
}

fn most(outcome: &Outcome) -> u64 {
    outcome.found.iter().map(|found| found.count).max().unwrap_or(0)
}

/// `123456` as `1.2e5`.
fn short_count(count: u64) -> String {
    if count < 10_000 {
        return count.to_string();
    }
    format!("{:.1e}", count as f64).replace(".0e", "e")
}

/// Two digits.
fn figure(worst: f64) -> String {
    if worst == 0.0 {
        "0".to_owned()
    } else if worst.is_infinite() {
        "inf".to_owned()
    } else if (0.01..1000.0).contains(&worst) {
        let text = format!("{worst:.*}", if worst < 1.0 { 3 } else { 1 });
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{worst:.1e}").replace(".0e", "e")
    }
}
