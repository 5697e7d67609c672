//! Text table of a report.

use core::fmt::Write;

use super::case::Order;
use super::curve::{Curve, Speedup};
use super::fit::Reached;
use super::{Measured, Report};

/// The maximum length of a line.
pub(super) const WIDTH: usize = 100;

impl Report {
    /// Returns a table for each case, no line longer than 100 columns.
    ///
    /// Times are medians, in seconds, after which the root of the mean square error, over all runs,
    /// is no larger than 1e-2 and 1e-3; `<` stands before those of a curve's first point, `-` where
    /// the curve does not reach the error. The fitted order with its 95 % interval follows, then
    /// theory's, the speed-up over the first backend if it is significant, and the verdict on the
    /// order.
    pub fn table(&self) -> String {
        let mut text = self.cases.iter().map(table).collect::<Vec<_>>().join("\n");
        if self.environment.has_debug_assertions {
            text += "\nmeasured with debug assertions: times mean little\n";
        }
        text
    }
}

fn table(case: &Measured) -> String {
    let Measured { kind, uncertainty, rounding_floor, .. } = case;
    let title = format!(
        "{}: reference {} ({}) +- {uncertainty:.1e}, rounding {rounding_floor:.1e}",
        case.name,
        kind.name(),
        kind.meaning()
    );
    let mut text = cut(&title);
    text += "method     backend   s to 1e-2  s to 1e-3  order (95 %)            theory        \
             speed-up  verdict\n";
    for curve in &case.curves {
        text += &cut(&line(curve));
    }
    text
}

/// Returns a line, cut if it is too long, with its end.
pub(super) fn cut(line: &str) -> String {
    line.chars().take(WIDTH).collect::<String>().trim_end().to_owned() + "\n"
}

fn line(curve: &Curve) -> String {
    let name: String = curve.method.name.chars().take(10).collect();
    let backend = curve.backend.name();
    if let Some(missing) = &curve.missing {
        let why = missing.to_string();
        return format!("{name:<10} {backend:<9} {}", why.lines().next().unwrap_or_default());
    }
    let (early, late) = (seconds(curve.time_to_error(1e-2)), seconds(curve.time_to_error(1e-3)));
    let mut text = format!("{name:<10} {backend:<9} {early:>9}  {late:>9}  ");
    let fit = curve.fit.map_or_else(
        || "-".to_owned(),
        |f| format!("{:.2} ({:.2} .. {:.2})", f.order, f.low, f.high),
    );
    let theory = curve.expected.map_or_else(|| "-".to_owned(), range);
    let speedup = curve.speedup.map_or_else(|| "-".to_owned(), claim);
    let verdict = curve.verdict().name();
    let _ = write!(text, "{fit:<23} {theory:<13} {speedup:>8}  {verdict}");
    text
}

fn seconds(reached: Reached) -> String {
    match reached {
        Reached::At(s) => format!("{s:.2e}"),
        Reached::AtMost(s) => format!("<{s:.2e}"),
        Reached::Never => "-".to_owned(),
    }
}

/// Prints an order as `-0.55..-0.45`, or `<= -0.70`.
pub(super) fn range(order: Order) -> String {
    if order.steepest.is_finite() {
        format!("{:.2}..{:.2}", order.steepest, order.flattest)
    } else {
        format!("<= {:.2}", order.flattest)
    }
}

/// Prints a speed-up, or no claim if its interval contains 1.
fn claim(speedup: Speedup) -> String {
    if speedup.is_claimed() { format!("{:.2}x", speedup.ratio) } else { "no claim".to_owned() }
}
