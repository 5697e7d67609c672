//! Every variant against the scalar one.

use core::fmt;

use super::leaves::{leaves, one_line};
use super::{can_run, try_run, validate};
use crate::kernel::{Kernel, Variant};
use crate::machine::{Rounding, Type};
use crate::report::{Cause, differing, explain};

/// How many results the table shows.
const ROWS: usize = 10;

/// Variants that disagree with the scalar one, and where: a table for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Disagreement {
    /// The kernel, and where it stands in the source.
    kernel: String,
    /// A line for each variant that disagrees.
    summaries: Vec<String>,
    rows: Vec<Row>,
}

/// One result that differs.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    variant: &'static str,
    index: usize,
    /// The first number that differs.
    place: String,
    expected: String,
    found: String,
    input: String,
}

impl core::error::Error for Disagreement {}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "the variants of {} disagree", self.kernel)?;
        for line in &self.summaries {
            writeln!(f, "  {line}")?;
        }
        if self.rows.is_empty() {
            return Ok(());
        }
        let width = |of: fn(&Row) -> usize, least| self.rows.iter().map(of).fold(least, usize::max);
        let (place, expected, found) = (
            width(|r| r.place.chars().count(), 5),
            width(|r| r.expected.len(), 8),
            width(|r| r.found.len(), 5),
        );
        let mut line = |[a, b, c, d, e, g]: [&str; 6]| {
            writeln!(f, "{a:8} {b:>7}  {c:place$}  {d:expected$}  {e:found$}  {g}")
        };
        line(["variant", "index", "where", "expected", "found", "input"])?;
        for r in &self.rows {
            let index = r.index.to_string();
            line([r.variant, &index, &r.place, &r.expected, &r.found, &r.input])?;
        }
        Ok(())
    }
}

/// What one variant gave that it should not have.
struct Wrong<R> {
    variant: Variant,
    summary: String,
    /// The results and which of them are wrong, in order.
    found: Vec<R>,
    indices: Vec<usize>,
}

/// Runs a kernel over `inputs` in every variant; what
/// [`assert_variants_agree!`](crate::assert_variants_agree) does.
///
/// # Errors
///
/// If a variant disagrees, or its WGSL is not valid.
///
/// # Panics
///
/// If there are no inputs, or no device where `RAYDSL_REQUIRE_GPU` is `1`.
pub fn variants_agree<A: Type + Sync, R: Type + Sync>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
) -> Result<(), Disagreement> {
    assert!(!inputs.is_empty(), "without inputs nothing is compared");
    let expected: Vec<R> = inputs.iter().map(|a| kernel.call(*a)).collect();
    let packets = [Variant::Packet4, Variant::Packet8, Variant::Packet16];
    let mut wrong: Vec<Wrong<R>> =
        packets.into_iter().filter_map(|v| packet(kernel, v, inputs, &expected)).collect();
    wrong.extend(wgsl(kernel, inputs));
    if wrong.is_empty() {
        return Ok(());
    }
    let info = kernel.info();
    let each = ROWS / wrong.len();
    let rows = wrong.iter().flat_map(|w| {
        w.indices
            .iter()
            .take(each)
            .map(|i| row(w.variant, *i, &inputs[*i], expected[*i], w.found[*i]))
    });
    Err(Disagreement {
        kernel: format!("`{}` ({}:{})", info.name, info.file, info.line),
        rows: rows.collect(),
        summaries: wrong.iter().map(|w| w.summary.clone()).collect(),
    })
}

/// A packet of what every machine has stands in for a width that this one lacks.
fn packet<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    variant: Variant,
    inputs: &[A],
    expected: &[R],
) -> Option<Wrong<R>> {
    let mut found = expected.to_vec();
    found.fill(R::read(&vec![0; R::SCHEMA.size()]));
    kernel.run(variant, inputs, &mut found);
    let indices = differing(expected, &found);
    let (name, (isa, lanes)) = (variant.name(), variant.isa());
    let summary = format!(
        "{name} ({lanes} lanes of {isa}): {} of {} results have other bits",
        indices.len(),
        inputs.len()
    );
    (!indices.is_empty()).then_some(Wrong { variant, summary, found, indices })
}

fn wgsl<A: Type + Sync, R: Type + Sync>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
) -> Option<Wrong<R>> {
    let variant = Variant::Wgsl;
    let failed = |summary| Wrong { variant, summary, found: Vec::new(), indices: Vec::new() };
    if let Err(e) = validate(kernel) {
        return Some(failed(format!("wgsl: {e}")));
    }
    if !can_run(variant, kernel.info().name) {
        return None;
    }
    let found = match try_run(kernel, variant, inputs) {
        Ok(found) => found,
        Err(e) => return Some(failed(format!("wgsl: {e}"))),
    };
    let why = explain(kernel, inputs, &found, Rounding::IEEE);
    if why.count(Cause::Decision) > 0 && !why.sample.is_meaningful() {
        return Some(failed(format!(
            "wgsl: {} results follow another path, which uncertain decisions would explain; but {} \
             of {} inputs are uncertain, so that means little",
            why.count(Cause::Decision),
            why.sample.uncertain,
            why.sample.inputs,
        )));
    }
    let is_wrong = |cause| matches!(cause, Cause::Unexplained | Cause::Undecided);
    let wrong = why.causes.iter().filter(|(_, cause)| is_wrong(*cause));
    let indices: Vec<usize> = wrong.map(|(i, _)| *i).collect();
    let summary = format!(
        "wgsl: rounding does not account for {} of {} results",
        indices.len(),
        inputs.len()
    );
    (!indices.is_empty()).then_some(Wrong { variant, summary, found, indices })
}

fn row<A: Type, R: Type>(variant: Variant, index: usize, input: &A, expected: R, found: R) -> Row {
    let (expected, found) = (leaves(&expected), leaves(&found));
    let at = expected.iter().zip(&found).position(|(a, b)| !a.number.is_same(b.number));
    let at = at.unwrap_or_default();
    let place = &expected[at].path;
    Row {
        variant: variant.name(),
        index,
        place: if place.is_empty() { "result".to_owned() } else { place.clone() },
        expected: expected[at].number.with_bits(),
        found: found[at].number.with_bits(),
        input: one_line(input),
    }
}
