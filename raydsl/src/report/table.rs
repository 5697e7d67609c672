//! The table of a comparison.

use core::fmt::Write;

use super::{Comparison, Row};
use crate::machine::Type;

const HEADER: &str = "variant    isa      lanes  ms/frame  Mrays/s  speed-up  max ulp  mismatches  \
                      unexplained";

/// The longest line of a table.
const WIDTH: usize = 100;

pub(super) fn table<R: Type>(c: &Comparison<R>) -> String {
    let mut text = format!("{HEADER}\n");
    for row in &c.rows {
        text += &line(row, c.scalar());
    }
    text
}

fn line<R: Type>(row: &Row<R>, scalar: &Row<R>) -> String {
    let name = row.variant.name();
    if let Some(reason) = &row.unavailable {
        let reason = reason.lines().next().unwrap_or_default();
        let line: String = format!("{name:<10} not run: {reason}").chars().take(WIDTH).collect();
        return line + "\n";
    }
    let a = &row.agreement;
    let mut text = String::new();
    let ulp = if a.max_ulp == u32::MAX { "NaN".to_owned() } else { a.max_ulp.to_string() };
    let _ = writeln!(
        text,
        "{name:<10} {:<8} {:>5} {:>9.2} {:>8.2} {:>9} {ulp:>8} {:>11} {:>12}",
        row.isa,
        row.lanes,
        row.times.median(),
        row.mrays_per_s(),
        format!("{:.2}x", row.times.speedup_over(&scalar.times)),
        a.hit_mismatches,
        a.unexplained,
    );
    text
}
