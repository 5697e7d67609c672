//! Unsigned normalised numbers.

use raydsl::prelude::*;
use raydsl_tests::values::SPECIAL_F32;

#[test]
fn every_code_survives() {
    for code in 0..=u8::MAX {
        assert_eq!(Unorm8::new(Unorm8::from_bits(code).to_f32()).to_bits(), code);
    }
    for code in 0..=u16::MAX {
        assert_eq!(Unorm16::new(Unorm16::from_bits(code).to_f32()).to_bits(), code);
    }
}

#[test]
fn codes_are_the_quotients() {
    for code in 0..=u8::MAX {
        assert_eq!(Unorm8::from_bits(code).to_f32(), f32::from(code) / 255.0);
    }
    for code in 0..=u16::MAX {
        assert_eq!(Unorm16::from_bits(code).to_f32(), f32::from(code) / 65535.0);
    }
}

/// WGSL, section "pack4x8unorm": `floor(0.5 + 255 * clamp(x, 0, 1))`, in exact arithmetic.
fn pack_unorm(x: f32, codes: f64) -> f64 {
    if x.is_nan() { 0.0 } else { (0.5 + codes * f64::from(x).clamp(0.0, 1.0)).floor() }
}

/// A dense set: numbers around every border between two codes, and evenly spaced ones.
fn dense(codes: u32) -> impl Iterator<Item = f32> {
    let borders = (0..codes).flat_map(move |code| {
        let border = ((f64::from(code) + 0.5) / f64::from(codes)) as f32;
        let below = (0..4).scan(border, |x, _| Some(std::mem::replace(x, x.next_down())));
        let above = (0..4).scan(border, |x, _| Some(std::mem::replace(x, x.next_up())));
        below.chain(above)
    });
    let even = (0..=1_000_000).map(|i| i as f32 / 1e6);
    borders.chain(even).chain(SPECIAL_F32.iter().copied())
}

#[test]
fn rounding_is_that_of_wgsl() {
    for x in dense(255) {
        assert_eq!(f64::from(Unorm8::new(x).to_bits()), pack_unorm(x, 255.0), "{x:?}");
    }
    for x in dense(65_535) {
        assert_eq!(f64::from(Unorm16::new(x).to_bits()), pack_unorm(x, 65_535.0), "{x:?}");
    }
}

#[test]
fn thirty_two_bits_do_not_overflow() {
    assert_eq!(Unorm32::new(1.0), Unorm32::ONE);
    assert_eq!(Unorm32::new(2.0), Unorm32::ONE);
    assert_eq!(Unorm32::new(f32::INFINITY), Unorm32::ONE);
    assert_eq!(Unorm32::new(-0.5), Unorm32::ZERO);
    assert_eq!(Unorm32::ONE.to_f32(), 1.0);
    let mut last = 0;
    for x in dense(4095) {
        let code = Unorm32::new(x).to_bits();
        assert_eq!(f64::from(code), pack_unorm(x, f64::from(u32::MAX)), "{x:?}");
        assert!((0.0..=1.0).contains(&Unorm32::from_bits(code).to_f32()));
        last = last.max(code);
    }
    assert_eq!(last, u32::MAX);
    for code in [0, 1, 255, 0x7fff_ffff, 0x8000_0000, 0xffff_ff7f, 0xffff_ff80, u32::MAX] {
        assert!((0.0..=1.0).contains(&Unorm32::from_bits(code).to_f32()), "{code:x}");
    }
}

#[test]
fn nan_is_zero() {
    assert_eq!(Unorm8::new(f32::NAN), Unorm8::ZERO);
    assert_eq!(Unorm16::new(f32::NAN), Unorm16::ZERO);
    assert_eq!(Unorm32::new(f32::NAN), Unorm32::ZERO);
}
