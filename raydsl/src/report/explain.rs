//! Why results differ: rounding, a decision that rounding leaves open, or a mistake.

use super::agreement::differing;
use crate::kernel::Kernel;
use crate::machine::{Outcomes, Rounding, Type};

/// In how many ways the decisions of one input are turned.
const WAYS: usize = 64;

/// Why a result differs from that of the scalar variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cause {
    /// It does not: +0 equals -0 and NaN equals NaN.
    Same,
    /// Both follow the path of `f64`, and lie within the bounds of the rounding error.
    Rounding,
    /// The path met a decision whose sides lie within the rounding error of each other, and both
    /// results are within the bounds of one of its outcomes: the mismatch is *explained*.
    Decision,
    /// More ways were open than are followed, and those that were do not explain it. It counts as
    /// unexplained.
    Undecided,
    /// Rounding does not account for it.
    Unexplained,
}

impl Cause {
    /// Why `found` differs from `expected`; `outcomes` follows up to so many ways.
    fn of<R: Type>(expected: R, found: R, outcomes: impl Fn(usize) -> Outcomes) -> Self {
        let both = |all: &Outcomes| all.contains(expected) && all.contains(found);
        let first = outcomes(1);
        if both(&first) {
            return Self::Rounding;
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

/// Some inputs, spread evenly, and how many of them are uncertain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// How many inputs were looked at.
    pub inputs: u64,
    /// Those whose path in `f64` met a decision whose sides lie within the rounding error.
    pub uncertain: u64,
}

impl Sample {
    /// The part that is uncertain, from 0 to 1.
    pub fn share(&self) -> f64 {
        self.uncertain as f64 / self.inputs.max(1) as f64
    }

    /// Whether explanations mean something: at most 1 % is uncertain. Where much is uncertain, much
    /// could be explained.
    pub fn is_meaningful(&self) -> bool {
        self.share() <= 0.01
    }
}

/// `count` of the indices below `len`, spread evenly: multiples of the golden ratio.
pub(super) fn spread(len: usize, count: usize) -> Vec<usize> {
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

/// `f` of every index in `indices`, on all processors where the feature `parallel` is on.
pub(super) fn each<T: Send>(indices: &[usize], f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        indices.par_iter().map(|i| f(*i)).collect()
    }
    #[cfg(not(feature = "parallel"))]
    indices.iter().map(|i| f(*i)).collect()
}

/// Why results differ at `indices`.
pub(super) fn causes<R: Type + Sync>(
    expected: &[R],
    found: &[R],
    outcomes: impl Fn(usize, usize) -> Outcomes + Sync,
) -> Vec<(usize, Cause)> {
    let indices = differing(expected, found);
    each(&indices, |i| (i, Cause::of(expected[i], found[i], |limit| outcomes(i, limit))))
}

/// How results differ from the scalar variant's, and why.
#[must_use = "an explanation that nobody reads explains nothing"]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// The inputs at which results differ in any bit, in order, and the causes.
    pub causes: Vec<(usize, Cause)>,
    /// How many inputs are uncertain, of at most 4096.
    pub sample: Sample,
}

impl Explanation {
    /// How many results differ for this cause.
    pub fn count(&self, cause: Cause) -> usize {
        self.causes.iter().filter(|(_, c)| *c == cause).count()
    }

    /// How many results rounding does not account for, [`Cause::Undecided`] ones included.
    pub fn unexplained(&self) -> usize {
        self.count(Cause::Unexplained) + self.count(Cause::Undecided)
    }
}

/// Explains the results of a variant of your own: `outputs` are its results for `inputs`, and those
/// of the kernel's scalar variant are what they are compared with.
///
/// The kernel runs in `f64` with a bound of the rounding error; see the chapter "What the numbers
/// promise" of the book. That takes some two hundred times as long as a run, for every differing
/// result and for a sample of 4096 inputs; a differing one whose decisions are open up to 64 times
/// as long again.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::machine::Rounding;
/// use raydsl::report::explain;
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
pub fn explain<A: Type + Sync, R: Type + Sync>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    outputs: &[R],
    rounding: Rounding,
) -> Explanation {
    assert_eq!(inputs.len(), outputs.len(), "one output for each input");
    let expected: Vec<R> = inputs.iter().map(|a| kernel.call(*a)).collect();
    let outcomes = |i: usize, limit| kernel.outcomes(inputs[i], rounding, limit);
    Explanation {
        causes: causes(&expected, outputs, outcomes),
        sample: sample(&spread(inputs.len(), super::SAMPLES), |i| outcomes(i, 1)),
    }
}

/// How many of `indices` are uncertain.
fn sample(indices: &[usize], outcomes: impl Fn(usize) -> Outcomes + Sync) -> Sample {
    let uncertain = each(indices, |i| outcomes(i).is_uncertain());
    Sample {
        inputs: indices.len() as u64,
        uncertain: uncertain.into_iter().filter(|u| *u).count() as u64,
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
        assert!(Sample { inputs: 1000, uncertain: 10 }.is_meaningful());
        assert!(!Sample { inputs: 1000, uncertain: 11 }.is_meaningful());
        assert!(Sample::default().is_meaningful());
    }
}
