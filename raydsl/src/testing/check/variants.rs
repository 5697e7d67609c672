//! Comparison of the variants, where rounding may leave decisions open.

use crate::kernel::{Kernel, Variant};
use crate::machine::{Rounding, Type};
use crate::testing::agreement::differing;
use crate::testing::leaves::{Number, leaves, one_line};
use crate::testing::{can_run, explain, try_run, variants_agree};

/// Greatest relative difference of a number on a device that counts as rounding alone.
const CLOSE: f32 = 1e-3;

/// Share of results that must be as close.
const SHARE: f64 = 0.98;

/// Greatest share of inputs with decisions that rounding leaves open, where explanations of
/// differences still mean something.
const OPEN: f64 = 0.02;

/// Returns how the variants of a kernel disagree, if they do. Packets must have the scalar bits; on
/// a device rounding must account for differences, or, where it leaves too many decisions open to say
/// so and an explanation is not asked for, nearly all results be close.
pub(super) fn disagreement<A: Type, R: Type>(
    kernel: &Kernel<'_, A, R>,
    inputs: &[A],
    must_be_explained: bool,
) -> Option<String> {
    let error = variants_agree(kernel, inputs, Rounding::WGSL).err()?;
    if !error.is_undecided() || !can_run(Variant::Wgsl, kernel.info().name) {
        return Some(error.to_string());
    }
    let found = match try_run(kernel, Variant::Wgsl, inputs) {
        Ok(found) => found,
        Err(e) => return Some(e),
    };
    let why = explain(kernel, inputs, &found, Rounding::WGSL);
    if why.unexplained() == 0 && why.sample.share() <= OPEN {
        return None;
    }
    if must_be_explained {
        return Some(error.to_string());
    }
    let expected: Vec<R> = inputs.iter().map(|input| kernel.call(*input)).collect();
    far_apart(inputs, &expected, &found).map(|text| format!("{error}  {text}"))
}

/// Returns how far results are apart, if too many are not close.
fn far_apart<A: Type, R: Type>(inputs: &[A], expected: &[R], found: &[R]) -> Option<String> {
    let is_far = |i: &usize| !is_close(&expected[*i], &found[*i]);
    let far: Vec<usize> = differing(expected, found).into_iter().filter(is_far).collect();
    let share = 1.0 - far.len() as f64 / inputs.len() as f64;
    let first = *far.first()?;
    (share < SHARE).then(|| {
        format!(
            "wgsl: {} of {} results are off by more than {CLOSE}, the first for {}: {} for {}",
            far.len(),
            inputs.len(),
            one_line(&inputs[first]),
            one_line(&found[first]),
            one_line(&expected[first])
        )
    })
}

/// Returns whether all numbers of two results are close.
fn is_close<R: Type>(a: &R, b: &R) -> bool {
    leaves(a).iter().zip(&leaves(b)).all(|(a, b)| match (a.number, b.number) {
        (Number::F32(x), Number::F32(y)) => {
            a.number.is_same(b.number) || (x - y).abs() <= CLOSE * (x.abs().max(y.abs()) + 1e-3)
        }
        (a, b) => a.is_same(b),
    })
}
