//! Single operations, on a million operands each.
//!
//! An operation has no control flow, so unlike [`crate::check`] this does not vary which lanes
//! run: it varies the numbers.

use std::fmt::Debug;

use raydsl::machine::{KernelFn, Lanes, Packet, Scalar, Type};

use crate::check::{Wgsl, wgsl_agrees};
use crate::levels::{LevelTask, natural_levels};
use crate::rng::Rng;
use crate::scaled;
use crate::values::{Numbers, compare, garbage, operands, random};

/// How many operands an operation is given on the scalar machine.
const OPERANDS: usize = 1_000_000;
/// How many of them on every kind of packets. Their operations are calls: with all of them inlined
/// these tests would take ten minutes to compile.
const ON_EACH_LEVEL: usize = 30_000;
/// How many of them in WGSL.
const IN_WGSL: usize = 500;

/// Runs an operation on the scalar machine and on packets of every natural level, and compares
/// with its untouched source.
///
/// # Panics
///
/// If any result differs.
pub fn operation<F: KernelFn>(name: &str, numbers: Numbers, wgsl: Wgsl)
where
    F::Args: Debug,
{
    let mut rng = Rng::of(name);
    let mut start = 0;
    while start < scaled(OPERANDS) {
        let end = (start + ON_EACH_LEVEL).min(scaled(OPERANDS));
        let inputs = (start..end).map(|i| operands(&mut rng, numbers, i)).collect();
        let mut part = Part::<F>::new(name, inputs);
        part.scalar_machine();
        if start == 0 {
            natural_levels(&mut part);
        }
        start = end;
    }
    let inputs = (0..IN_WGSL).map(|_| random(&mut rng, numbers)).collect();
    let part = Part::<F>::new(name, inputs);
    wgsl_agrees::<F>(name, &part.inputs, &part.expected, wgsl);
}

struct Part<'a, F: KernelFn> {
    name: &'a str,
    inputs: Vec<F::Args>,
    expected: Vec<F::Output>,
    found: Vec<F::Output>,
}

impl<'a, F: KernelFn> Part<'a, F>
where
    F::Args: Debug,
{
    fn new(name: &'a str, inputs: Vec<F::Args>) -> Self {
        let expected: Vec<F::Output> = inputs.iter().map(|a| F::scalar(*a)).collect();
        let found = vec![garbage(); inputs.len()];
        Self { name, inputs, expected, found }
    }

    fn assert_same(&self, how: &str) {
        let who = format!("{} on {how}", self.name);
        compare(who, &self.expected, &self.found).assert_same(|i| format!("{:?}", self.inputs[i]));
    }

    fn scalar_machine(&mut self) {
        let m = Scalar::default();
        for (a, out) in self.inputs.iter().zip(&mut self.found) {
            *out = F::Output::lane::<Scalar>(&F::lifted(&m, F::Args::splat(&m, *a)), 0);
        }
        self.assert_same("the scalar machine");
    }
}

impl<F: KernelFn> LevelTask for Part<'_, F>
where
    F::Args: Debug,
{
    fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
        run_packets::<F, L>(lanes, &self.inputs, &mut self.found);
        self.assert_same(name);
    }
}

fn run_packets<F: KernelFn, L: Lanes>(lanes: L, inputs: &[F::Args], found: &mut [F::Output]) {
    // Of 16 lanes that stand for fewer, the lower ones.
    let width = lanes.bits(lanes.mask(true)).count_ones() as usize;
    lanes.vectorize(|| {
        for (inputs, found) in inputs.chunks(width).zip(found.chunks_mut(width)) {
            let m = Packet::with_count(lanes, inputs.len());
            let args = F::Args::from_lanes(&m, &|l| inputs[l.min(inputs.len() - 1)]);
            let result = F::lifted(&m, args);
            for (l, out) in found.iter_mut().enumerate() {
                *out = F::Output::lane::<Packet<L>>(&result, l);
            }
        }
    });
}
