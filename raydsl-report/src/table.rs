//! The table of a comparison.

use core::fmt::Write;

use super::{Comparison, Missing, Row, Verdict};
use raydsl::machine::Type;

const HEADER: &str = "variant    isa      lanes  ms/frame  Mrays/s  speed-up  max ulp   explained  \
                      undecided  unexplained";

const REFERENCE: &str = "variant    error (ulp): median        mean         max  other paths";

/// The maximum length of a line.
const WIDTH: usize = 100;

pub(super) fn table<R: Type>(c: &Comparison<R>) -> String {
    let mut text = format!("{HEADER}\n");
    for row in &c.rows {
        text += &line(row, c.scalar());
    }
    if c.sample.inputs > 0 {
        text += &reference(c);
    }
    text += &films(c);
    text + verdict(c.verdict()) + "\n"
}

fn verdict(v: Verdict) -> &'static str {
    match v {
        Verdict::Agree => "the variants agree",
        Verdict::MeansAgree => "the variants agree, WGSL in its means: too many decisions are open",
        Verdict::Differ => "the variants differ",
        Verdict::Refused => "the variants that ran agree; one was refused",
        Verdict::NotMeaningful => "not meaningful: more than 1 % is open, or nothing was sampled",
        Verdict::NothingCompared => "nothing was compared",
    }
}

/// Prints the agreement of films, if there are some.
fn films<R: Type>(c: &Comparison<R>) -> String {
    let mut text = String::new();
    for row in c.rows.iter().filter(|r| r.differing_means > 0) {
        let (name, n) = (row.variant.name(), row.differing_means);
        let _ = writeln!(text, "{name}: {n} means of pixels have other bits");
    }
    match &c.means {
        Some(means) => format!("{text}\nmeans of films in WGSL\n{means}"),
        None => text,
    }
}

/// Prints the errors of each variant against the reference, and the uncertain pixels.
fn reference<R: Type>(c: &Comparison<R>) -> String {
    let mut text = format!("\n{REFERENCE}\n");
    for row in c.rows.iter().filter(|r| r.unavailable.is_none()) {
        let (name, a) = (row.variant.name(), &row.accuracy);
        let (median, mean, max) = (a.median_ulp, a.mean_ulp, a.max_ulp);
        let _ = writeln!(
            text,
            "{name:<10} {median:>19.2e} {mean:>11.2e} {max:>11.2e} {:>12}",
            a.other_paths
        );
    }
    let share = 100.0 * c.sample.share();
    let _ = writeln!(
        text,
        "of {} pixels in f64, rounding leaves {share:.2} % open; half of the bounds are within {:.1} ulp",
        c.sample.inputs, c.sample.median_width_ulp
    );
    text
}

/// Wraps `words` behind `start`. A word that is longer than a line is cut.
fn wrapped(start: &str, words: &str) -> String {
    const INDENT: usize = 13;
    let (mut text, mut column) = (start.to_owned(), start.chars().count());
    let mut is_first = true;
    for word in words.split_whitespace() {
        let len = word.chars().count();
        if !is_first && column + 1 + len > WIDTH {
            let _ = write!(text, "\n{:INDENT$}", "");
            (column, is_first) = (INDENT, true);
        }
        let room = WIDTH - column - usize::from(!is_first);
        if !is_first {
            text.push(' ');
            column += 1;
        }
        text.extend(word.chars().take(room));
        column += len.min(room);
        is_first = false;
    }
    text + "\n"
}

fn line<R: Type>(row: &Row<R>, scalar: &Row<R>) -> String {
    let name = row.variant.name();
    if let Some(reason) = &row.unavailable {
        let what = if matches!(reason, Missing::Refused(_)) { "refused" } else { "not run" };
        return wrapped(&format!("{name:<10} {what}: "), &reason.to_string());
    }
    let a = &row.agreement;
    let mut text = String::new();
    let ulp = if a.max_ulp == u32::MAX { "NaN".to_owned() } else { a.max_ulp.to_string() };
    let _ = writeln!(
        text,
        "{name:<10} {:<8} {:>5} {:>9.2} {:>8.2} {:>9} {ulp:>8} {:>11} {:>10} {:>12}",
        row.isa,
        row.lanes,
        row.times.median(),
        row.mrays_per_s(),
        format!("{:.2}x", row.times.speedup_over(&scalar.times)),
        a.explained,
        a.undecided,
        a.unexplained,
    );
    text
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, wrapped};

    #[test]
    fn reasons_are_there_to_the_last_word() {
        let words = "seven letters and more, again and again; ".repeat(9) + "the limit is 63";
        let text = wrapped("WGSL       refused: ", &words);
        assert!(text.lines().count() > 3 && text.lines().all(|l| l.chars().count() <= WIDTH));
        assert!(text.ends_with("is 63\n"));
        let back: Vec<&str> = text.split_whitespace().skip(2).collect();
        assert_eq!(back, words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(wrapped("a ", &"x".repeat(300)).trim_end().chars().count(), WIDTH);
    }
}
