//! Comparison of every variant with the scalar one.

use core::fmt;

use super::agreement::differing;
use super::explain::{Cause, explain_some};
use super::film_test::Inputs;
use super::leaves::{leaves, one_line};
use super::panics::caught;
use super::{MeansAgreement, MeansVerdict, can_run, try_run, unwritten, validate};
use crate::kernel::{Kernel, Variant};
use crate::machine::{KernelInfo, Leaf, Rounding, Type, result_leaves};

/// The limit on paths through the decisions of a printed result.
const WAYS: usize = 64;

/// The limit on differences that are explained where the means decide too: those of long paths take
/// long.
const EXPLAINED: usize = 16;

/// The number of results in the table.
const ROWS: usize = 10;

/// A table of the variants that disagree with the scalar one, and their differing results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Disagreement {
    /// The kernel and its source location.
    kernel: String,
    /// A line for each variant that disagrees.
    summaries: Vec<String>,
    rows: Vec<Row>,
}

/// A differing result.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    variant: &'static str,
    index: usize,
    /// The path of the first wrong number.
    place: String,
    expected: String,
    found: String,
    /// The values that rounding allows there, if known.
    allowed: String,
    input: String,
}

impl Disagreement {
    /// Returns whether no result is known to be wrong: rounding leaves too many decisions open.
    pub(super) fn is_undecided(&self) -> bool {
        self.rows.is_empty() && self.summaries.iter().all(|s| s.starts_with("wgsl: rounding would"))
    }
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
        let (place, expected, found, allowed) = (
            width(|r| r.place.chars().count(), 5),
            width(|r| r.expected.len(), 8),
            width(|r| r.found.len(), 5),
            width(|r| r.allowed.len(), 0),
        );
        let mut line = |[a, b, c, d, e, g, h]: [&str; 7]| {
            write!(f, "{a:8} {b:>7}  {c:place$}  {d:expected$}  {e:found$}  ")?;
            // Packets have no bounds.
            if allowed > 0 {
                write!(f, "{g:allowed$}  ")?;
            }
            writeln!(f, "{h}")
        };
        line(["variant", "index", "where", "expected", "found", "allowed", "input"])?;
        for r in &self.rows {
            let index = r.index.to_string();
            line([r.variant, &index, &r.place, &r.expected, &r.found, &r.allowed, &r.input])?;
        }
        Ok(())
    }
}

/// The wrong results of one variant.
struct Wrong<R> {
    variant: Variant,
    summary: String,
    /// The results, and the indices of the wrong ones, in order.
    found: Vec<R>,
    indices: Vec<usize>,
}

/// Compares a kernel's pictures in the device's variant and on the CPU.
pub(super) type Means<'a> = &'a dyn Fn() -> Result<MeansAgreement, String>;

/// Runs a kernel over `inputs` in every variant, for
/// [`assert_variants_agree!`](crate::assert_variants_agree): a slice of parameters, or a
/// [`FilmTest`](super::FilmTest). The device may round according to `rounding`.
///
/// # Errors
///
/// If a variant disagrees, or its WGSL is not valid.
///
/// # Panics
///
/// If there are no inputs, or no device and `RAYDSL_REQUIRE_GPU` is `1`.
pub fn variants_agree<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    inputs: &(impl Inputs<A, R> + ?Sized),
    rounding: Rounding,
) -> Result<(), Disagreement> {
    match inputs.means(kernel) {
        Some(means) => agree(kernel, &inputs.inputs(), rounding, Some(&*means)),
        None => agree(kernel, &inputs.inputs(), rounding, None),
    }
}

fn agree<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    rounding: Rounding,
    means: Option<Means<'_>>,
) -> Result<(), Disagreement> {
    assert!(!inputs.is_empty(), "without inputs nothing is compared");
    let expected: Vec<R> = match scalar(kernel, inputs) {
        Ok(expected) => expected,
        Err(summary) => {
            let kernel = described(kernel.info());
            return Err(Disagreement { kernel, rows: Vec::new(), summaries: vec![summary] });
        }
    };
    let packets = [Variant::Packet4, Variant::Packet8, Variant::Packet16];
    let mut wrong: Vec<Wrong<R>> =
        packets.into_iter().filter_map(|v| packet(kernel, v, inputs, &expected)).collect();
    wrong.extend(wgsl(kernel, inputs, rounding, means));
    if wrong.is_empty() {
        return Ok(());
    }
    let each = ROWS / wrong.len();
    let rows = wrong.iter().flat_map(|w| {
        w.indices.iter().take(each).map(|i| {
            let results = [expected[*i], w.found[*i]];
            let outside = (w.variant == Variant::Wgsl)
                .then(|| kernel.outcomes(inputs[*i], rounding, WAYS))
                .and_then(|all| all.outside(&result_leaves(results[1])));
            row(w.variant, *i, &inputs[*i], results, outside)
        })
    });
    Err(Disagreement {
        kernel: described(kernel.info()),
        rows: rows.collect(),
        summaries: wrong.iter().map(|w| w.summary.clone()).collect(),
    })
}

fn described(info: &KernelInfo) -> String {
    format!("`{}` ({}:{})", info.name, info.file, info.line)
}

/// Runs the source for all inputs. Where it panics, as for an index out of range, the other variants
/// may go on without a word.
fn scalar<A: Type, R: Type>(kernel: &Kernel<'_, A, R>, inputs: &[A]) -> Result<Vec<R>, String> {
    let mut expected = Vec::with_capacity(inputs.len());
    for (i, input) in inputs.iter().enumerate() {
        let result = caught(|| kernel.call(*input)).map_err(|panic| {
            format!("scalar: the source panics for input {i}, {}\n  {panic}", one_line(input))
        })?;
        expected.push(result);
    }
    Ok(expected)
}

/// Compares a packet variant. A narrower packet, or the scalar function, replaces a width that this
/// machine lacks.
fn packet<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    variant: Variant,
    inputs: &[A],
    expected: &[R],
) -> Option<Wrong<R>> {
    let mut found = vec![unwritten(); inputs.len()];
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

fn wgsl<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    rounding: Rounding,
    means: Option<Means<'_>>,
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
    let means = match means.map(|means| means()).transpose() {
        Ok(means) => means,
        Err(e) => return Some(failed(format!("wgsl: {e}"))),
    };
    let most = if means.is_some() { EXPLAINED } else { usize::MAX };
    let why = explain_some(kernel, inputs, &found, rounding, most);
    let verdict = means.as_ref().map(MeansAgreement::verdict);
    // Where rounding decides too much for single results, the means of a picture say more.
    let by_means = verdict == Some(MeansVerdict::Agree);
    let is_wrong = |cause| match cause {
        Cause::Unexplained => true,
        Cause::Undecided => !by_means,
        _ => false,
    };
    let wrong = why.causes.iter().filter(|(_, cause)| is_wrong(*cause));
    let indices: Vec<usize> = wrong.map(|(i, _)| *i).collect();
    let mut found_out = Vec::new();
    if !indices.is_empty() {
        let (wrong, all) = (indices.len(), inputs.len());
        found_out.push(format!("wgsl: rounding does not account for {wrong} of {all} results"));
    }
    let forgiven = why.causes.len() - indices.len();
    if forgiven > 0 && !why.sample.is_meaningful() && !by_means {
        let (uncertain, all) = (why.sample.uncertain, why.sample.inputs);
        found_out.push(format!(
            "wgsl: rounding would account for {forgiven} results that differ; but {uncertain} of \
             {all} inputs are uncertain, so that means little"
        ));
    }
    let of_means = means.filter(|_| verdict == Some(MeansVerdict::Differ) || !found_out.is_empty());
    found_out.extend(of_means.iter().flat_map(|m| {
        let lines: Vec<String> = m.to_string().lines().map(str::to_owned).collect();
        lines
    }));
    let summary = found_out.join("\n  ");
    (!summary.is_empty()).then_some(Wrong { variant, summary, found, indices })
}

/// Returns the row of a result. `outside` is the leaf beyond the rounding error, and its bounds.
fn row<A: Type, R: Type>(
    variant: Variant,
    index: usize,
    input: &A,
    results: [R; 2],
    outside: Option<(usize, Leaf)>,
) -> Row {
    let [expected, found] = results.map(|r| leaves(&r));
    let differs = expected.iter().zip(&found).position(|(a, b)| !a.number.is_same(b.number));
    let outside = outside.filter(|(at, _)| *at < expected.len());
    let at = outside.map(|(at, _)| at).or(differs).unwrap_or_default();
    let place = &expected[at].path;
    Row {
        variant: variant.name(),
        index,
        place: if place.is_empty() { "result".to_owned() } else { place.clone() },
        expected: expected[at].number.with_bits(),
        found: found[at].number.with_bits(),
        allowed: outside.map(|(_, leaf)| allowed(leaf)).unwrap_or_default(),
        input: one_line(input),
    }
}

/// Prints the values that rounding allows for a number.
fn allowed(leaf: Leaf) -> String {
    match leaf {
        Leaf::Whole(v) => v.to_string(),
        Leaf::Float { low, high, .. } if low > high => "NaN".to_owned(),
        Leaf::Float { low, high, may_be_nan, .. } => {
            let or_nan = if may_be_nan { " or NaN" } else { "" };
            format!("[{low:.9e}, {high:.9e}]{or_nan}")
        }
    }
}
