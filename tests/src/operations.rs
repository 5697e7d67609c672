//! Single operations, on a million numbers each.
//!
//! An operation has no control flow, so unlike [`crate::check`] this does not vary which lanes
//! run: it varies the numbers. All but the operation itself is compiled once for its types, not
//! once an operation.

use std::fmt::Debug;

use raydsl::kernel::Kernel;
use raydsl::machine::{KernelFn, Lanes, Packet, Scalar, Type};

use crate::check::{Wgsl, recorded, wgsl_agrees};
use crate::levels::natural_levels;
use crate::rng::Rng;
use crate::run_time::Numbered;
use crate::scaled;
use crate::values::{Numbers, compare, garbage, operands, random};

/// How many numbers an operation is given on the scalar machine, all its operands together.
const NUMBERS: usize = 1_000_000;
/// How many operands of them on every kind of packets. Their operations are calls: with all of them
/// inlined these tests would take ten minutes to compile.
const ON_EACH_LEVEL: usize = 8_192;
/// How many operands in WGSL.
const IN_WGSL: usize = 500;

/// Runs an operation on the scalar machine and on packets of every natural level, and compares
/// with its untouched source.
///
/// # Panics
///
/// If any result differs.
pub fn operation<F: KernelFn>(name: &str, numbers: Numbers, wgsl: Wgsl)
where
    F::Args: Debug + Sync,
    F::Output: Sync,
{
    let operation = Operation::<F::Args, F::Output> {
        name,
        scalar: F::scalar,
        scalar_machine: F::lifted,
        packets: F::lifted,
        wgsl: recorded::<F>(),
    };
    operation.check(numbers, wgsl);
}

/// Many lanes of any level.
type Wide = Packet<Numbered>;

struct Operation<'a, A: Type, R: Type> {
    name: &'a str,
    scalar: fn(A) -> R,
    scalar_machine: fn(&Scalar, A::On<Scalar>) -> R::On<Scalar>,
    packets: fn(&Wide, A::On<Wide>) -> R::On<Wide>,
    wgsl: Kernel<'static, A, R>,
}

impl<A: Type + Debug + Sync, R: Type> Operation<'_, A, R> {
    fn check(&self, numbers: Numbers, wgsl: Wgsl) {
        let mut rng = Rng::of(self.name);
        let count = (scaled(NUMBERS) / A::SCHEMA.leaves()).max(ON_EACH_LEVEL);
        for start in (0..count).step_by(ON_EACH_LEVEL) {
            let end = (start + ON_EACH_LEVEL).min(count);
            let inputs: Vec<A> = (start..end).map(|i| operands(&mut rng, numbers, i)).collect();
            let expected: Vec<R> = inputs.iter().map(|a| (self.scalar)(*a)).collect();
            self.assert_same("the scalar machine", &inputs, &expected, &self.on_scalars(&inputs));
            if start == 0 {
                natural_levels(&mut |name, lanes| {
                    self.assert_same(name, &inputs, &expected, &self.on_packets(lanes, &inputs));
                });
            }
        }
        let inputs: Vec<A> = (0..IN_WGSL).map(|_| random(&mut rng, numbers)).collect();
        let expected: Vec<R> = inputs.iter().map(|a| (self.scalar)(*a)).collect();
        wgsl_agrees(self.name, &self.wgsl, &inputs, &expected, wgsl);
    }

    fn assert_same(&self, how: &str, inputs: &[A], expected: &[R], found: &[R]) {
        let who = format!("{} on {how}", self.name);
        compare(who, expected, found).assert_same(|i| format!("{:?}", inputs[i]));
    }

    fn on_scalars(&self, inputs: &[A]) -> Vec<R> {
        let m = Scalar::default();
        let run = |a: &A| R::lane::<Scalar>(&(self.scalar_machine)(&m, A::splat(&m, *a)), 0);
        inputs.iter().map(run).collect()
    }

    fn on_packets(&self, lanes: Numbered, inputs: &[A]) -> Vec<R> {
        // Of 16 lanes that stand for fewer, the lower ones.
        let width = lanes.bits(lanes.mask(true)).count_ones() as usize;
        let mut found = vec![garbage(); inputs.len()];
        for (inputs, found) in inputs.chunks(width).zip(found.chunks_mut(width)) {
            Numbered::forget();
            let m = Packet::with_count(lanes, inputs.len());
            let args = load(&m, &|l| inputs[l.min(inputs.len() - 1)]);
            let result = (self.packets)(&m, args);
            found.iter_mut().enumerate().for_each(|(l, out)| *out = R::lane::<Wide>(&result, l));
        }
        found
    }
}

/// One function for all operations of the same operands.
#[inline(never)]
fn load<A: Type>(m: &Wide, f: &dyn Fn(usize) -> A) -> A::On<Wide> {
    A::from_lanes(m, f)
}
