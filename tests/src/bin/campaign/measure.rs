//! Runs a kernel in every variant over many inputs, and judges every result.

use std::error::Error;
use std::fmt::Debug;
use std::sync::{Mutex, PoisonError};

use raydsl::machine::Type;
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;
use raydsl_tests::in_parallel;
use raydsl_tests::rng::Rng;

use crate::outcome::{Found, Outcome};
use crate::row::Unit;

/// Inputs that a thread makes at a time.
pub(crate) const PART: usize = 1 << 13;
/// Inputs of one dispatch.
pub(crate) const BATCH: usize = 1 << 18;
/// The largest number of inputs in `f64`, in which kernels are interpreted.
const MOST_IN_F64: u64 = 100_000;

/// The name of a variant, and what it gave.
type OfVariant<R> = (&'static str, Vec<R>);

/// How a row is measured.
pub(crate) struct Run {
    /// Of the row's inputs.
    pub(crate) seed: u64,
    /// How the errors of inputs become one.
    pub(crate) unit: Unit,
    /// How many inputs.
    pub(crate) count: u64,
    /// Whether the scalar variant is asked for. It always runs: packets are compared with it.
    pub(crate) scalar: bool,
    /// The packets that are asked for.
    pub(crate) packets: Vec<Variant>,
    /// Whether WGSL is asked for.
    pub(crate) wgsl: bool,
    /// The largest number of inputs in WGSL.
    pub(crate) most_in_wgsl: u64,
    /// Whether the kernel in `f64` is asked for.
    pub(crate) f64: bool,
}

impl Run {
    /// A share of the same, with inputs of its own: for a row of several scenes, numbered by `part`.
    pub(crate) fn part(&self, share: f64, part: u64) -> Self {
        let count = ((self.count as f64 * share) as u64).max(1);
        let seed = self.seed.wrapping_add((part + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        Self { seed, count, packets: self.packets.clone(), ..*self }
    }

    /// How many inputs in WGSL.
    pub(crate) fn count_in_wgsl(&self) -> u64 {
        self.count.min(self.most_in_wgsl)
    }

    /// The same without WGSL.
    pub(crate) fn without_wgsl(&self) -> Self {
        Self { wgsl: false, packets: self.packets.clone(), ..*self }
    }

    /// How many inputs of `count` break a textbook's way, as a share.
    pub(crate) fn broken_by(&self, count: u64, mut is_broken: impl FnMut(&mut Rng) -> bool) -> f64 {
        let mut rng = Rng::new(self.seed);
        let count = count.clamp(100, 1_000_000);
        (0..count).filter(|_| is_broken(&mut rng)).count() as f64 / count as f64
    }

    /// The variants of the CPU that are asked for.
    pub(crate) fn of_cpu(&self) -> Vec<Variant> {
        let scalar = self.scalar.then_some(Variant::Scalar);
        scalar.into_iter().chain(self.packets.iter().copied()).collect()
    }

    /// What a kernel gives in every variant but `f64`, for figures of all inputs together.
    pub(crate) fn results<A: Type, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
    ) -> Result<Vec<OfVariant<R>>, Box<dyn Error>> {
        let run = |variant: Variant| {
            let mut found: Vec<R> = vec![kernel.call(inputs[0]); inputs.len()];
            kernel.run(variant, inputs, &mut found);
            (variant.name(), found)
        };
        let mut all: Vec<OfVariant<R>> = self.of_cpu().into_iter().map(run).collect();
        if let Some(gpu) = gpu().filter(|_| self.wgsl) {
            let mut found: Vec<R> = vec![kernel.call(inputs[0]); inputs.len()];
            gpu.batch(kernel, inputs, &mut found)?;
            all.push(("wgsl", found));
        }
        Ok(all)
    }

    /// Runs kernels, which take turns, in every variant but `f64`.
    ///
    /// `make` makes the tuple of a kernel's arguments. `judge` returns the error of a result: in the row's unit, or 1 for a fault; `None` where
    /// nothing is promised of the input, which is then not counted.
    pub(crate) fn measure<A: Type + Debug, R: Type + Debug>(
        &self,
        kernels: &[Kernel<'_, A, R>],
        make: impl Fn(&mut Rng) -> A + Sync,
        judge: impl Fn(&A, &R) -> Option<f64> + Sync,
    ) -> Result<Outcome, Box<dyn Error>> {
        let mut outcome = self.on_cpu(kernels, &make, &judge);
        if self.wgsl {
            outcome.found.extend(self.on_device(kernels, &make, &judge)?);
        }
        Ok(outcome)
    }

    /// Runs the scalar variant and packets, on all processors.
    fn on_cpu<A: Type + Debug, R: Type + Debug>(
        &self,
        kernels: &[Kernel<'_, A, R>],
        make: &(impl Fn(&mut Rng) -> A + Sync),
        judge: &(impl Fn(&A, &R) -> Option<f64> + Sync),
    ) -> Outcome {
        let all = Mutex::new(Outcome::default());
        in_parallel(self.count as usize, PART, |range| {
            let mut rng = Rng::new(self.seed ^ range.start as u64);
            let kernel = &kernels[range.start / PART % kernels.len()];
            let inputs: Vec<A> = range.map(|_| make(&mut rng)).collect();
            let expected: Vec<R> = inputs.iter().map(|input| kernel.call(*input)).collect();
            let scalar = self.judged("scalar", &inputs, &expected, judge);
            let mut part = Outcome::default();
            let mut found = expected.clone();
            for &packets in &self.packets {
                kernel.run(packets, &inputs, &mut found);
                let others = other_bits(&expected, &found);
                let figure = match others.first() {
                    // The same results have the same errors.
                    None => Found { variant: packets.name(), example: None, ..scalar.clone() },
                    Some(&i) => {
                        part.other_bits += others.len() as u64;
                        part.first_other_bits.get_or_insert_with(|| {
                            let (input, expected, found) = (inputs[i], expected[i], found[i]);
                            let name = packets.name();
                            format!("{name}: {found:?} and not {expected:?}, of {input:?}")
                        });
                        self.judged(packets.name(), &inputs, &found, judge)
                    }
                };
                part.found.push(figure);
            }
            if self.scalar {
                part.found.insert(0, scalar);
            }
            all.lock().unwrap_or_else(PoisonError::into_inner).merge(self.unit, part);
        });
        all.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// Runs WGSL, if there is a device.
    fn on_device<A: Type + Debug, R: Type + Debug>(
        &self,
        kernels: &[Kernel<'_, A, R>],
        make: &impl Fn(&mut Rng) -> A,
        judge: &impl Fn(&A, &R) -> Option<f64>,
    ) -> Result<Option<Found>, Box<dyn Error>> {
        let Some(gpu) = gpu() else { return Ok(None) };
        let count = self.count_in_wgsl() as usize;
        let mut all = Found::new("wgsl");
        for start in (0..count).step_by(BATCH) {
            let mut rng = Rng::new(!self.seed ^ start as u64);
            let inputs: Vec<A> =
                (start..count.min(start + BATCH)).map(|_| make(&mut rng)).collect();
            let share = inputs.len().div_ceil(kernels.len());
            for (kernel, inputs) in kernels.iter().zip(inputs.chunks(share)) {
                let mut found: Vec<R> = vec![kernel.call(inputs[0]); inputs.len()];
                gpu.batch(kernel, inputs, &mut found)?;
                all.merge(self.unit, self.judged("wgsl", inputs, &found, judge));
            }
        }
        Ok(Some(all))
    }

    /// Runs a kernel in `f64`: `judge` is given every scalar of the result, in order of declaration.
    pub(crate) fn in_f64<A: Type + Debug, R: Type>(
        &self,
        kernel: &Kernel<'_, A, R>,
        make: impl Fn(&mut Rng) -> A + Sync,
        judge: impl Fn(&A, &[f64]) -> Option<f64> + Sync,
    ) -> Option<Found> {
        if !self.f64 {
            return None;
        }
        let all = Mutex::new(Found::new("f64"));
        in_parallel(self.count.min(MOST_IN_F64) as usize, PART / 64, |range| {
            let mut rng = Rng::new(self.seed ^ range.start as u64);
            let mut part = Found::new("f64");
            for _ in range {
                let input = make(&mut rng);
                let result = kernel.reference(input);
                if let Some(error) = judge(&input, &result) {
                    part.add(self.unit, error, || format!("{result:?} of {input:?}"));
                }
            }
            all.lock().unwrap_or_else(PoisonError::into_inner).merge(self.unit, part);
        });
        Some(all.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// Judges what has no variants, on all processors: `judge` makes an input and returns the error,
    /// and the input in words.
    pub(crate) fn on_host(&self, judge: impl Fn(&mut Rng) -> (f64, String) + Sync) -> Outcome {
        let all = Mutex::new(Found::new("host"));
        in_parallel(self.count as usize, PART, |range| {
            let mut rng = Rng::new(self.seed ^ range.start as u64);
            let mut part = Found::new("host");
            for _ in range {
                let (error, input) = judge(&mut rng);
                part.add(self.unit, error, || input);
            }
            all.lock().unwrap_or_else(PoisonError::into_inner).merge(self.unit, part);
        });
        Outcome::host(all.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    fn judged<A: Debug, R: Debug>(
        &self,
        variant: &'static str,
        inputs: &[A],
        results: &[R],
        judge: &impl Fn(&A, &R) -> Option<f64>,
    ) -> Found {
        let mut all = Found::new(variant);
        for (input, result) in inputs.iter().zip(results) {
            if let Some(error) = judge(input, result) {
                all.add(self.unit, error, || format!("{result:?} of {input:?}"));
            }
        }
        all
    }
}

/// Which results are not the same. A NaN is the same as another.
pub(crate) fn other_bits<R: Type + Debug>(expected: &[R], found: &[R]) -> Vec<usize> {
    let size = R::SCHEMA.size();
    let (mut a, mut b) = (vec![0; size], vec![0; size]);
    let mut differs = |(expected, found): (&R, &R)| {
        expected.write(&mut a);
        found.write(&mut b);
        // Printed, all NaNs are alike.
        a != b && format!("{expected:?}") != format!("{found:?}")
    };
    let pairs = expected.iter().zip(found).enumerate();
    pairs.filter_map(|(i, pair)| differs(pair).then_some(i)).collect()
}
