//! WGSL with the device's own functions and numbers: close to the others, and shorter.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;

#[kernel]
fn waves(x: f32, y: f32) -> Vec4 {
    let turn = sincos_2pi(x * 0.25);
    vec4(sin(x) + cos(y), tan(x * 0.4), turn.sin - turn.cos, asin(y * 0.2) + acos(x * 0.2))
}

#[kernel]
fn growth(x: f32, y: f32) -> Vec4 {
    let z = x.abs() + 0.5;
    vec4(exp(x) + exp2(y), log(z) + log2(z), pow(z, y), atan(x) + atan2(y, z) + expm1(x) + log1p(z))
}

fn inputs() -> Vec<(f32, f32)> {
    (0..4000).map(|i| ((i % 63) as f32 * 0.1 - 3.1, (i / 63) as f32 * 0.1 - 3.1)).collect()
}

/// WGSL bounds the error of these functions in this range by less than 2^-10, relative to results
/// above 1.
fn assert_close(kernel: &Kernel<'_, (f32, f32), Vec4>) {
    let Some(gpu) = gpu() else { return };
    let inputs = inputs();
    let mut found = vec![Vec4::NAN; inputs.len()];
    if let Err(e) = gpu.batch(kernel, &inputs, &mut found) {
        panic!("{e}\n{}", kernel.wgsl());
    }
    for (input, found) in inputs.iter().zip(&found) {
        let expected = kernel.call(*input);
        let error = (*found - expected).abs();
        let allowed = expected.abs().max(Vec4::ONE) * (4.0 / 1024.0);
        assert!(error.cmple(allowed).all(), "{input:?}: {found} for {expected}");
    }
}

#[test]
fn functions_of_the_device() {
    for kernel in [Kernel::of::<waves>(), Kernel::of::<growth>()] {
        let strict = kernel.wgsl();
        let fast = kernel.arithmetic(Arithmetic::Fast);
        let text = fast.wgsl();
        assert!(text.lines().count() < strict.lines().count(), "{text}");
        assert!(strict.contains("params.lit_") && !text.contains("params.lit_"), "{text}");
        assert_close(&fast);
    }
    let text = Kernel::of::<waves>().arithmetic(Arithmetic::Fast).wgsl();
    for name in ["sin(x)", "cos(y)", "tan(", "asin(", "acos("] {
        assert!(text.contains(name), "{name}\n{text}");
    }
    for name in ["fn sin", "fn cos", "fn tan", "fn sincos_2pi"] {
        assert!(!text.contains(name), "{name}\n{text}");
    }
}

/// A kernel of the user's that has the name of an elementary function is not one.
mod own {
    use super::*;

    #[kernel]
    pub(crate) fn sin(x: f32) -> f32 {
        x * 0.5
    }
}

#[test]
fn functions_of_the_user_stay() {
    let kernel = kernel!(|x: f32| own::sin(x)).arithmetic(Arithmetic::Fast);
    let text = kernel.wgsl();
    assert!(text.contains("x * 0.5f"), "{text}");
}
