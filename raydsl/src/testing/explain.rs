//! Causes of differing results: rounding, a decision that rounding leaves open, or a mistake.

use super::agreement::{differing, ulp};
use crate::kernel::Kernel;
use crate::machine::{Leaf, Outcomes, Rounding, Type, result_leaves};

/// The default number of inputs in a sample.
pub const SAMPLES: usize = 4096;

/// The limit on paths through the decisions of one input.
const WAYS: usize = 64;

/// The cause of a difference from the scalar variant's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cause {
    /// No difference: +0 equals -0 and NaN equals NaN.
    Same,
    /// Rounding: both follow the path of `f64`, and lie within the bounds of the rounding error.
    Rounding,
    /// An open decision: its sides lie within the rounding error of each other, and both results
    /// are within the bounds of one of its outcomes: the mismatch is *explained*.
    Decision,
    /// Unknown: more paths were open than are followed, and those followed do not explain it; or
    /// the bounds are void, since a number that differs may be infinite or NaN. It counts as
    /// unexplained.
    Undecided,
    /// A mistake: rounding does not explain it.
    Unexplained,
}

impl Cause {
    /// Returns why `found` differs from `expected`; `outcomes` follows up to its argument's number
    /// of paths.
    fn of(expected: &[Leaf], found: &[Leaf], outcomes: &dyn Fn(usize) -> Outcomes) -> Self {
        let both = |all: &Outcomes| all.contains_leaves(expected) && all.contains_leaves(found);
        let first = outcomes(1);
        if both(&first) {
            let limited = is_limited(first.reference(), expected, found);
            return if limited { Self::Rounding } else { Self::Undecided };
        }
        if !first.is_uncertain() {
            return Self::Unexplained;
        }
        let all = outcomes(WAYS);
        match (both(&all), all.is_complete()) {
            (true, _) => Self::Decision,
            (false, true) => Self::Unexplained,
            (false, false) => Self::Undecided,
        }
    }
}

/// Returns whether the bounds limit every number that differs: an interval that ends in infinity
/// contains mistakes too, and so does one that may be NaN.
fn is_limited(bounds: &[Leaf], expected: &[Leaf], found: &[Leaf]) -> bool {
    let differs = |a: f64, b: f64| a != b && !(a.is_nan() && b.is_nan());
    bounds
        .iter()
        .zip(expected.iter().zip(found))
        .all(|(bound, (a, b))| bound.width() < f64::INFINITY || !differs(a.value(), b.value()))
}

/// A sample of evenly spread inputs, and the number of uncertain ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// The number of inputs in the sample.
    pub inputs: u64,
    /// The inputs whose path in `f64` has a decision whose sides lie within the rounding error, or
    /// whose bounds contain nearly everything: see [`Outcomes::is_vague`].
    pub uncertain: u64,
    /// The median width of the bounds of all floats, in ulp.
    pub median_width_ulp: f64,
}

impl Sample {
    /// Returns the uncertain share, from 0 to 1.
    pub fn share(&self) -> f64 {
        self.uncertain as f64 / self.inputs.max(1) as f64
    }

    /// Returns whether explanations are meaningful: the sample is not empty, and at most 1 % is
    /// uncertain. Otherwise too much could be explained.
    pub fn is_meaningful(&self) -> bool {
        self.inputs > 0 && self.share() <= 0.01
    }

    /// Summarises the outcomes of a sample's inputs.
    pub fn of(sampled: &[Outcomes]) -> Self {
        let uncertain = sampled.iter().filter(|o| o.is_uncertain() || o.is_vague()).count();
        let floats = sampled.iter().flat_map(|o| o.reference());
        let mut widths: Vec<f64> = floats
            .filter(|leaf| matches!(leaf, Leaf::Float { .. }))
            .map(|leaf| leaf.width() / ulp(leaf.value()))
            .collect();
        widths.sort_by(f64::total_cmp);
        Self {
            inputs: sampled.len() as u64,
            uncertain: uncertain as u64,
            median_width_ulp: widths.get(widths.len() / 2).copied().unwrap_or_default(),
        }
    }
}

/// Returns `count` of the indices below `len`, spread evenly: multiples of the golden ratio.
pub fn spread(len: usize, count: usize) -> Vec<usize> {
    if count >= len {
        return (0..len).collect();
    }
    let golden = 0.618_033_988_749_894_9;
    let mut all: Vec<usize> =
        (0..count).map(|i| ((i as f64 * golden).fract() * len as f64) as usize).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// A function from an input's index and a maximum number of paths to its outcomes. A trait object,
/// so that its callers are compiled once, not for every kernel.
pub type OutcomesOf<'a> = &'a (dyn Fn(usize, usize) -> Outcomes + Sync);

/// Returns the outcomes of these inputs on the path of `f64`.
pub fn sampled(indices: &[usize], outcomes: OutcomesOf<'_>) -> Vec<Outcomes> {
    each(indices, &|i| outcomes(i, 1))
}

/// Applies `f` to every index in `indices`, on all processors with the feature `parallel`.
fn each<T: Send>(indices: &[usize], f: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        indices.par_iter().map(|i| f(*i)).collect()
    }
    #[cfg(not(feature = "parallel"))]
    indices.iter().map(|i| f(*i)).collect()
}

/// Returns the causes of differing results. At most `most` of them are explained, spread evenly; the
/// others are undecided.
pub fn causes<R: Type>(
    expected: &[R],
    found: &[R],
    outcomes: OutcomesOf<'_>,
    most: usize,
) -> Vec<(usize, Cause)> {
    let results = |i: usize| [result_leaves(expected[i]), result_leaves(found[i])];
    let all = differing(expected, found);
    let explained: Vec<usize> = spread(all.len(), most).into_iter().map(|i| all[i]).collect();
    let causes = causes_at(&explained, &results, outcomes);
    let cause = |i: &usize| causes.binary_search_by_key(i, |(at, _)| *at).map(|at| causes[at].1);
    all.iter().map(|i| (*i, cause(i).unwrap_or(Cause::Undecided))).collect()
}

/// Returns the [`causes`] of the inputs that differ, from the leaves of both results.
fn causes_at(
    indices: &[usize],
    results: &(dyn Fn(usize) -> [Vec<Leaf>; 2] + Sync),
    outcomes: OutcomesOf<'_>,
) -> Vec<(usize, Cause)> {
    each(indices, &|i| {
        let [expected, found] = results(i);
        (i, Cause::of(&expected, &found, &|limit| outcomes(i, limit)))
    })
}

/// The differences from the scalar variant's results, and their causes.
#[must_use = "an explanation that nobody reads explains nothing"]
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The inputs at which results differ in any bit, in order, and the causes.
    pub causes: Vec<(usize, Cause)>,
    /// A sample of at most 4096 inputs for the share of uncertain ones. Explanations mean little if
    /// many are.
    pub sample: Sample,
}

impl Explanation {
    /// Returns the number of results that differ for this cause.
    pub fn count(&self, cause: Cause) -> usize {
        self.causes.iter().filter(|(_, c)| *c == cause).count()
    }

    /// Returns the number of results that rounding does not explain, including [`Cause::Undecided`]
    /// ones.
    pub fn unexplained(&self) -> usize {
        self.count(Cause::Unexplained) + self.count(Cause::Undecided)
    }
}

/// Explains the results of a variant of your own: compares `outputs`, its results for `inputs`,
/// with those of the kernel's scalar variant.
///
/// The kernel runs in `f64` with a bound on the rounding error; see the chapter "Numerical
/// guarantees" of the book. That takes some two hundred times as long as a run, for every differing
/// result and for a sample of 4096 inputs; a differing one whose decisions are open up to 64 times
/// as long again.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::machine::Rounding;
/// use raydsl::testing::explain;
///
/// let kernel = kernel!(|x: f32, y: f32| if x * x + y * y < 0.5 { 1.0 } else { x / y });
/// let inputs: Vec<(f32, f32)> = (1..999).map(|i| (i as f32 * 0.001, 0.5)).collect();
/// let mut outputs = vec![0.0; inputs.len()];
/// kernel.run(Variant::Packet8, &inputs, &mut outputs);
/// assert_eq!(explain(&kernel, &inputs, &outputs, Rounding::IEEE).causes.len(), 0);
/// outputs[900] *= 1.001;
/// assert_eq!(explain(&kernel, &inputs, &outputs, Rounding::IEEE).unexplained(), 1);
/// ```
///
/// # Panics
///
/// If there is not one output for each input.
pub fn explain<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    outputs: &[R],
    rounding: Rounding,
) -> Explanation {
    explain_some(kernel, inputs, outputs, rounding, usize::MAX)
}

/// Explains at most `most` differences, as [`explain`] does; the others are undecided.
pub(super) fn explain_some<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    outputs: &[R],
    rounding: Rounding,
    most: usize,
) -> Explanation {
    assert_eq!(inputs.len(), outputs.len(), "one output for each input");
    let expected: Vec<R> = inputs.iter().map(|a| kernel.call(*a)).collect();
    let outcomes = |i: usize, limit| kernel.outcomes(inputs[i], rounding, limit);
    Explanation {
        causes: causes(&expected, outputs, &outcomes, most),
        sample: Sample::of(&sampled(&spread(inputs.len(), SAMPLES), &outcomes)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_spread_over_all() {
        assert_eq!(spread(5, 9), [0, 1, 2, 3, 4]);
        let found = spread(1_000_000, 4096);
        assert!(found.len() > 4000 && found.windows(2).all(|w| w[1] - w[0] < 600));
    }

    #[test]
    fn one_per_cent_is_the_limit() {
        let sample = |inputs, uncertain| Sample { inputs, uncertain, ..Sample::default() };
        assert!(sample(1000, 10).is_meaningful());
        assert!(!sample(1000, 11).is_meaningful());
        // The sample is empty.
        assert!(!Sample::default().is_meaningful());
    }
}
