//! Figures that many results have together: a mean, a histogram, a share.

use std::error::Error;
use std::fmt::Debug;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use raydsl::machine::Type;
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;
use raydsl_tests::in_parallel;
use raydsl_tests::rng::Rng;

use crate::measure::{BATCH, PART, Run, other_bits};
use crate::outcome::{Found, Outcome};

/// What is known of results as they come.
pub(crate) trait Gathered<A, R>: Clone + Send + Sync {
    /// Adds a result.
    fn add(&mut self, input: &A, result: &R);

    /// Adds the results that another one was given.
    fn join(&mut self, other: Self);

    /// Returns the error of them all, and what it is made of in words.
    fn judge(&self) -> (f64, String);
}

impl Run {
    /// Runs a kernel in every variant but `f64`, and judges all results of a variant at once.
    ///
    /// `none` is what is known of no results.
    pub(crate) fn gather<A: Type + Debug, R: Type + Debug, S: Gathered<A, R>>(
        &self,
        kernel: &Kernel<'_, A, R>,
        none: &S,
        make: impl Fn(&mut Rng) -> A + Sync,
    ) -> Result<Outcome, Box<dyn Error>> {
        let all = Mutex::new((none.clone(), Outcome::default()));
        in_parallel(self.count as usize, PART, |range| {
            let mut rng = Rng::new(self.seed ^ range.start as u64);
            let inputs: Vec<A> = range.map(|_| make(&mut rng)).collect();
            let expected: Vec<R> = inputs.iter().map(|input| kernel.call(*input)).collect();
            let mut outcome = Outcome::default();
            let mut found = expected.clone();
            for &packets in &self.packets {
                kernel.run(packets, &inputs, &mut found);
                let others = other_bits(&expected, &found);
                outcome.other_bits += others.len() as u64;
                outcome.first_other_bits = outcome.first_other_bits.take().or_else(|| {
                    let i = *others.first()?;
                    let (name, input) = (packets.name(), inputs[i]);
                    Some(format!("{name}: {:?} and not {:?}, of {input:?}", found[i], expected[i]))
                });
            }
            let mut part = none.clone();
            inputs.iter().zip(&expected).for_each(|(input, result)| part.add(input, result));
            let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
            all.0.join(part);
            all.1.merge(self.unit, outcome);
        });
        let (gathered, mut outcome) = all.into_inner().unwrap_or_else(PoisonError::into_inner);
        let scalar = Variant::Scalar.name();
        // Packets have the same results, or other bits are counted above.
        let names = self.scalar.then_some(scalar).into_iter();
        for name in names.chain(self.packets.iter().map(|packets| packets.name())) {
            outcome.found.push(found_of(name, self.count, &gathered));
        }
        if self.wgsl {
            outcome.found.extend(self.gather_on_device(kernel, none.clone(), &make)?);
        }
        Ok(outcome)
    }

    fn gather_on_device<A: Type + Debug, R: Type + Debug, S: Gathered<A, R>>(
        &self,
        kernel: &Kernel<'_, A, R>,
        mut gathered: S,
        make: &impl Fn(&mut Rng) -> A,
    ) -> Result<Option<Found>, Box<dyn Error>> {
        let Some(gpu) = gpu() else { return Ok(None) };
        let count = self.count_in_wgsl() as usize;
        for start in (0..count).step_by(BATCH) {
            let mut rng = Rng::new(!self.seed ^ start as u64);
            let batch = start..count.min(start + BATCH);
            let inputs: Vec<A> = batch.map(|_| make(&mut rng)).collect();
            let mut found: Vec<R> = vec![kernel.call(inputs[0]); inputs.len()];
            gpu.batch(kernel, &inputs, &mut found)?;
            inputs.iter().zip(&found).for_each(|(input, result)| gathered.add(input, result));
        }
        Ok(Some(found_of("wgsl", count as u64, &gathered)))
    }

    /// Runs a kernel like [`Run::measure`] on each of these inputs, at most 1e6, whatever the count.
    pub(crate) fn measure_each<A: Type + Debug + Sync, R: Type + Debug>(
        &self,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        judge: impl Fn(&A, &R) -> Option<f64> + Sync,
    ) -> Result<Outcome, Box<dyn Error>> {
        let next = AtomicUsize::new(0);
        let run = Self { count: inputs.len() as u64, packets: self.packets.clone(), ..*self };
        let make = |_: &mut Rng| inputs[next.fetch_add(1, Ordering::Relaxed) % inputs.len()];
        run.measure(std::slice::from_ref(kernel), make, judge)
    }
}

fn found_of<A, R>(variant: &'static str, count: u64, gathered: &impl Gathered<A, R>) -> Found {
    let (error, text) = gathered.judge();
    let worst = if error.is_nan() { f64::INFINITY } else { error };
    Found { variant, count, worst, example: Some(format!("{variant}: {text}")) }
}
