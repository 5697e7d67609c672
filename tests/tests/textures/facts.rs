//! What the formulas give, in numbers that were known before.

use raydsl::prelude::*;
use raydsl::texture::{Address, ColorSpace, Filter, TextureError, TextureRef1};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::{ADDRESSES, FILTERS};

/// The texels 0, 16, 32, 64, 96, 128, 255, 255 of 8 bits.
const CODES: [u8; 8] = [0, 16, 32, 64, 96, 128, 255, 255];

fn config(filter: Filter, address: Address) -> TextureConfig {
    TextureConfig::new().filter(filter).address(address)
}

/// Reads texels at places counted in texels: a sample lies at a whole number and a half.
fn read<T: raydsl::texture::Texel<Value = f32>>(
    texels: &[T],
    config: TextureConfig,
    at: f32,
) -> Result<f32, TextureError> {
    let texture = TextureRef1::new(texels, [texels.len() as u32], config)?;
    Ok(tex1(&texture, at / texels.len() as f32))
}

#[test]
fn nearest_at_the_borders_of_texels() -> Result<(), TextureError> {
    let texels = CODES.map(Unorm8::from_bits);
    let places = [-3.0, -2.0, -1.0, 0.0, 0.5, 1.0, 7.0, 8.0, 9.0, 10.0];
    let expected = [
        (Address::Clamp, [0, 0, 0, 0, 0, 16, 255, 255, 255, 255]),
        (Address::Wrap, [128, 255, 255, 0, 0, 16, 255, 0, 16, 32]),
        (Address::Mirror, [32, 16, 0, 0, 0, 16, 255, 255, 255, 128]),
    ];
    for (address, codes) in expected {
        for (at, code) in places.into_iter().zip(codes) {
            let found = read(&texels, config(Filter::Nearest, address), at)?;
            assert_eq!(found, code as f32 / 255.0, "{address:?} at {at}");
        }
    }
    Ok(())
}

#[test]
fn clamped_at_1_is_the_last_of_three() -> Result<(), TextureError> {
    assert_eq!(read(&[1.0, 2.0, 3.0], config(Filter::Nearest, Address::Clamp), 3.0)?, 3.0);
    Ok(())
}

/// Filtered as floats: between codes there are values.
#[test]
fn linear_between_codes() -> Result<(), TextureError> {
    let texels = CODES.map(Unorm8::from_bits);
    for (at, code) in [(1.0, 8.0), (1.25, 12.0), (6.0, 191.5), (6.25, 223.25)] {
        let found = read(&texels, config(Filter::Linear, Address::Clamp), at)?;
        assert!((found * 255.0 - code).abs() < 1e-4, "{found} at {at}");
    }
    Ok(())
}

#[test]
fn catmull_rom_of_an_impulse() -> Result<(), TextureError> {
    let texels = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    for (at, expected) in [(3.0, 0.5625), (3.25, 0.8671875), (3.5, 1.0), (3.75, 0.8671875)] {
        let found = read(&texels, config(Filter::CatmullRom, Address::Clamp), at)?;
        assert_eq!(found, expected, "at {at}");
    }
    Ok(())
}

#[test]
fn srgb() -> Result<(), TextureError> {
    let near = |a: f32, b: f64, bound: f64| assert!((f64::from(a) - b).abs() < bound, "{a} {b}");
    near(srgb_to_linear(0.5), 0.214_041_140_482_232_44, 3e-8);
    near(srgb_to_linear(0.04), 0.0030960, 5e-8);
    near(linear_to_srgb(0.5), 0.735_356_983_052_347_4, 1.2e-7);
    near(linear_to_srgb(0.002), 0.02584, 1e-7);
    let exact = |x: f64| {
        if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    };
    for code in 0..=u8::MAX {
        let x = Unorm8::from_bits(code).to_f32();
        let found = srgb_to_linear(x);
        assert!((f64::from(found) - exact(f64::from(x))).abs() <= 5e-7 * f64::from(found), "{x}");
        assert_eq!(Unorm8::new(linear_to_srgb(found)).to_bits(), code);
    }
    let inverse = |x: f64| {
        if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
    };
    let ulps = |found: f32, exact: f64| {
        (f64::from(found) - exact).abs() / f64::from(found.abs().next_up() - found.abs())
    };
    let (mut worst, mut worst_inverse) = (0.0, 0.0);
    for i in 0..=200_000 {
        let x = i as f32 / 200_000.0;
        worst = ulps(srgb_to_linear(x), exact(f64::from(x))).max(worst);
        worst_inverse = ulps(linear_to_srgb(x), inverse(f64::from(x))).max(worst_inverse);
    }
    println!("{worst:.2} and {worst_inverse:.2} ulp at most");
    assert!(worst <= 7.0 && worst_inverse <= 4.0, "{worst} {worst_inverse}");
    // Decoded before it is filtered, and opacity not at all.
    let encoded = config(Filter::Linear, Address::Clamp).color_space(ColorSpace::Srgb);
    near(read(&[0.0, 1.0], encoded, 1.0)?, 0.5, 1e-7);
    let texels = [[0.5_f32; 4]];
    let found = tex1(&TextureRef1::new(&texels, [1], encoded)?, 0.5);
    assert_eq!(found, vec4(found.x, found.x, found.x, 0.5));
    near(found.x, 0.21404114, 3e-8);
    Ok(())
}

#[test]
fn a_mirror_is_that_of_gl() -> Result<(), TextureError> {
    let ramp: Vec<f32> = (0..1000).map(|i| (i as f32 + 0.5) / 1000.0).collect();
    let mirrored = config(Filter::Linear, Address::Mirror);
    for (x, expected) in [(1.99, 0.01), (-0.3, 0.3), (1.2, 0.8), (2.4, 0.4), (-1.75, 0.25)] {
        let found = read(&ramp, mirrored, x * 1000.0)?;
        assert!((found - expected).abs() < 1e-6, "{found} at {x}");
    }
    Ok(())
}

/// Two tents, a quarter of the texture apart. Neighbours differ by 1 at most, the last texel and
/// the first too, so no value is further off than its place; and where one tent has its foot or its
/// top the other is steep.
fn tents(i: u32, n: u32) -> Vec2 {
    let tent = |i: u32| (i + 1).min(n - i) as f32;
    vec2(tent(i), tent((i + n / 4) % n))
}

/// A border that goes on where the tents end.
fn beside_tents(n: u32) -> Vec2 {
    vec2(0.0, tents(0, n).y)
}

/// What a linear filter gives of [`tents`], in `f64`.
fn exact_tents(n: u32, address: Address, x: f64) -> [f64; 2] {
    let value = |i: Option<i64>| i.map_or(beside_tents(n), |i| tents(i as u32, n));
    [0, 1].map(|channel| super::reference::linear(n, address, x, |i| f64::from(value(i)[channel])))
}

/// The larger difference of two.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

/// The place that a linear filter reads is at most `2^-20 n` texels off, in every mode.
#[test]
fn places_are_exact_for_every_size() -> Result<(), TextureError> {
    let powers = (0..=16).flat_map(|e| [(1 << e) - 1, 1 << e, (1 << e) + 1]);
    let sizes = (1..=300).chain((301..=1 << 16).step_by(251)).chain(powers.skip(1));
    let mut rng = Rng::new(2);
    let mut worst: f64 = 0.0;
    for n in sizes {
        let texels: Vec<Vec2> = (0..n).map(|i| tents(i, n)).collect();
        for address in ADDRESSES {
            let border = beside_tents(n).extend(0.0).extend(0.0);
            let config = TextureConfig { border, ..config(Filter::Linear, address) };
            let texture = TextureRef1::new(&texels, [n], config)?;
            for _ in 0..scaled(100) {
                // Where two texels meet, and where one has its centre.
                let on = (rng.below(n as usize) as f32 + rng.pick(&[0.0, 0.5])) / n as f32;
                let close = [on.next_down(), on, on.next_up(), on - 1.0, on + 1.0];
                for x in close.into_iter().chain([rng.range(-1.0, 2.0)]) {
                    let found = tex1(&texture, x).to_array().map(f64::from);
                    let exact = exact_tents(n, address, f64::from(x));
                    // As a share of the texture.
                    let off = apart(found, exact) / f64::from(n);
                    worst = worst.max(off);
                    assert!(off <= 0.5f64.powi(20), "{n} {address:?} {x}: {found:?} {exact:?}");
                }
            }
        }
    }
    println!("{worst:.3e} of the texture off at most; 2^-20 is {:.3e}", 0.5f64.powi(20));
    Ok(())
}

/// Places further off than that would be seen: the two tents together are steep everywhere.
#[test]
fn tents_show_places_that_are_off() {
    let mut rng = Rng::new(6);
    for n in [8, 9, 100, 4097, 50_001, 65_535] {
        for _ in 0..scaled(1000) {
            let x = f64::from(rng.range(-1.0, 2.0));
            let [a, b] = [x, x + 1.01 * 0.5f64.powi(20)].map(|x| exact_tents(n, Address::Wrap, x));
            assert!(apart(a, b) > f64::from(n) * 0.5f64.powi(20), "{n} {x}");
        }
    }
}

/// `c - floor(c)` is 1 for small negative `c`; every size, mode and filter survives.
#[test]
fn every_coordinate_has_a_value() -> Result<(), TextureError> {
    let odd = [-1e-9, -1e-30, 1.0 - 6e-8, 1e9, -1e9, 8388608.5, 3e38, -3e38, f32::MIN_POSITIVE];
    let none = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for n in [1_u32, 2, 3, 7, 64, 1000] {
        let texels: Vec<f32> = (0..n).map(|i| 1.0 + i as f32).collect();
        for (filter, address) in FILTERS.into_iter().flat_map(|f| ADDRESSES.map(|a| (f, a))) {
            let texture = TextureRef1::new(&texels, [n], config(filter, address))?;
            for x in odd.into_iter().chain(none) {
                assert!(tex1(&texture, x).is_finite(), "{n} {filter:?} {address:?} {x}");
            }
            let found = none.map(|x| tex1(&texture, x));
            let expected = match address {
                Address::Wrap | Address::Mirror => [tex1(&texture, 0.0); 3],
                Address::Clamp => [1.0, n as f32, 1.0],
                Address::Border => [0.0; 3],
            };
            assert_eq!(found, expected, "{n} {filter:?} {address:?}");
        }
    }
    let last = TextureRef1::new(&[1.0, 2.0, 3.0], [3], config(Filter::Nearest, Address::Wrap))?;
    assert_eq!(tex1(&last, -1e-9), 3.0, "the last texel of the period before");
    assert_eq!(tex1(&last, 8388609.0), 1.0, "whole: its fraction is 0");
    Ok(())
}

/// Constant textures come back with the same bits, whatever the weights round to.
#[test]
fn constants_come_back() -> Result<(), TextureError> {
    let mut rng = Rng::new(3);
    for filter in FILTERS {
        for c in [0.1, 1.0 / 3.0, 1e30, -7.3e-20, rng.unit()] {
            let texels = [c; 60];
            let config = config(filter, Address::Mirror);
            let image = Texture2::new(&texels, [10, 6], config)?;
            let volume = Texture3::new(&texels, [3, 4, 5], config)?;
            for _ in 0..scaled(20_000) {
                let at = rng.point(3.0);
                assert_eq!(tex2(&image, vec2(at.x, at.y)), c);
                assert_eq!(tex3(&volume, at), c);
            }
        }
    }
    Ok(())
}

/// Ramps come back as ramps, to 4 ulp; squares from the B-spline as squares and a third.
#[test]
fn polynomials_come_back() -> Result<(), TextureError> {
    let ramp: Vec<f32> = (0..64).map(|i| i as f32).collect();
    let squares: Vec<f32> = (0..64).map(|i| (i * i) as f32).collect();
    let mut rng = Rng::new(4);
    for _ in 0..scaled(200_000) {
        // What the place is, is said by the same sum.
        let u = rng.range(0.05, 0.95);
        let place = u * 64.0 - 0.5;
        for filter in [Filter::Linear, Filter::BSpline, Filter::CatmullRom] {
            let found = read(&ramp, config(filter, Address::Clamp), u * 64.0)?;
            let ulp = place.abs().next_up() - place.abs();
            assert!((found - place).abs() <= 4.0 * ulp, "{filter:?} {place}: {found}");
        }
        let found = read(&squares, config(Filter::BSpline, Address::Clamp), u * 64.0)?;
        let exact = f64::from(place) * f64::from(place) + 1.0 / 3.0;
        assert!((f64::from(found) - exact).abs() <= 1e-6 * exact, "{place}: {found}");
    }
    Ok(())
}

/// Weights by impulses: of the B-spline none is negative, and all together are 1.
#[test]
fn weights_sum_to_1() -> Result<(), TextureError> {
    let mut rng = Rng::new(5);
    for filter in [Filter::BSpline, Filter::CatmullRom] {
        for i in 0..scaled(300_000) {
            let share = if i % 3 == 0 { 1.0 - rng.unit() * 1e-4 } else { rng.unit() };
            let mut sum = 0.0;
            for tap in 0..4 {
                let mut texels = [0.0; 4];
                texels[tap] = 1.0;
                let w = read(&texels, config(filter, Address::Clamp), 1.5 + share)?;
                assert!(filter != Filter::BSpline || w >= 0.0, "{share} {tap}: {w}");
                sum += f64::from(w);
            }
            assert!((sum - 1.0).abs() <= 2.4e-7, "{filter:?} {share}: {sum}");
        }
    }
    Ok(())
}

/// All codes, against the definition of `binary16`.
#[test]
fn halves() {
    for code in 0..=u16::MAX {
        let (sign, e, m) = (code >> 15, i32::from(code >> 10 & 31), f64::from(code & 0x3ff));
        let size = match e {
            0 => m / 1024.0 * 2f64.powi(-14),
            31 if m == 0.0 => f64::INFINITY,
            31 => f64::NAN,
            e => (1.0 + m / 1024.0) * 2f64.powi(e - 15),
        };
        let exact = if sign == 1 { -size } else { size };
        let found = F16::from_bits(code).to_f32();
        assert!(f64::from(found) == exact || found.is_nan() && exact.is_nan(), "{code:x}: {found}");
        assert_eq!(found.is_sign_negative(), sign == 1, "{code:x}");
        if !found.is_nan() {
            assert_eq!(F16::new(found).to_bits(), code);
            // Halfway to the next the even code is taken.
            if size < 65504.0 {
                let next = F16::from_bits(code + 1).to_f32();
                let even = code + (code & 1);
                assert_eq!(F16::new((found + next) * 0.5).to_bits(), even, "{code:x}");
            }
        }
    }
    assert!(F16::new(f32::NAN).to_f32().is_nan());
    assert_eq!(F16::new(65519.99).to_f32(), 65504.0);
    assert_eq!(F16::new(-65520.0).to_f32(), f32::NEG_INFINITY);
}
