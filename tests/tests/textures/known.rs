//! Numbers that were known before, in every variant.

use raydsl::prelude::*;
use raydsl::testing::run;
use raydsl::texture::{Address, Filter, TextureError, TextureRef1};
use raydsl::variant_test;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

/// What a variant reads from clamped texels.
fn read(
    variant: Variant,
    filter: Filter,
    texels: &[f32],
    at: &[(f32,)],
) -> Result<Vec<f32>, TextureError> {
    let config = TextureConfig::new().filter(filter).address(Address::Clamp);
    let texture = TextureRef1::new(texels, [texels.len() as u32], config)?;
    let read = kernel!(|u: f32| tex1(&texture, u));
    Ok(run(&read, variant, at))
}

/// How far off a number of size 1 may be: WGSL may round more often, and its divisions further.
fn bound(variant: Variant) -> f64 {
    if variant == Variant::Wgsl { 1e-6 } else { 3e-7 }
}

#[variant_test]
fn cubic_filters_of_four_texels(variant: Variant) -> Result<(), TextureError> {
    // Places between the second and the third texel.
    let at = [0.0, 0.25, 0.625].map(|share| ((1.5 + share) / 4.0,));
    let spline = [3.1666666666666667, 3.1692708333333333, 3.0315755208333333];
    let catmull_rom = [4.0, 3.6640625, 2.3837890625];
    for (filter, expected) in [(Filter::BSpline, spline), (Filter::CatmullRom, catmull_rom)] {
        let found = read(variant, filter, &[1.0, 4.0, 2.0, 8.0], &at)?;
        for (found, expected) in found.into_iter().zip(expected) {
            let off = (f64::from(found) - expected).abs();
            assert!(off <= bound(variant) * expected, "{filter:?}: {found}, not {expected}");
        }
    }
    Ok(())
}

/// A ramp shows where a linear filter reads: the place is off by rounding alone.
#[variant_test]
fn a_clamped_ramp_is_exact(variant: Variant) -> Result<(), TextureError> {
    let mut rng = Rng::new(1);
    let at: Vec<_> = (0..scaled(2_000_000)).map(|_| (rng.range(-0.1, 1.1),)).collect();
    for n in [7, 100, 1000, 12345] {
        let ramp: Vec<f32> = (0..n).map(|i| i as f32).collect();
        let found = read(variant, Filter::Linear, &ramp, &at)?;
        let n = f64::from(n);
        for ((u,), found) in at.iter().zip(found) {
            let exact = (n * f64::from(*u) - 0.5).clamp(0.0, n - 1.0);
            let off = (f64::from(found) - exact).abs();
            assert!(off <= 1e-6 * n, "{n} texels at {u}: {found}, not {exact}");
        }
    }
    Ok(())
}

#[variant_test]
fn half_of_srgb(variant: Variant) {
    let found = run(&kernel!(|x: f32| srgb_to_linear(x)), variant, &[(0.5,)])[0];
    let expected = 0.214_041_140_482_232_44;
    let off = (f64::from(found) - expected).abs();
    assert!(off <= bound(variant) * expected, "{found}, not {expected}");
}
