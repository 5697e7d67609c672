//! Patterns of every form against what the source does with them.

use raydsl::prelude::*;
use raydsl::{Type, assert_variants_agree, kernel};

#[kernel]
fn ends_of(list: &[f32], x: f32) -> f32 {
    let whole = match list {
        [] => -1.0,
        [one] => *one * 10.0,
        [1.0, b] => *b * 100.0,
        [a, b] => *a + *b,
        [a, _, ..] => *a - x,
    };
    let first = if let [a, ..] = list { *a } else { -2.0 };
    let third = if let [_, _, c, ..] = list
        && *c > x
    {
        *c
    } else {
        -3.0
    };
    let [a, b] = [x, x + 1.0];
    whole + first * 1000.0 + third * 0.001 + a * b
}

/// Lists shorter and longer than the patterns.
#[test]
fn lists_are_as_long_as_their_patterns() {
    let all = [1.0, 5.0, 0.25, 7.0];
    for from in 0..all.len() {
        for to in from..=all.len() {
            let list = &all[from..to];
            let kernel = kernel!(|x: f32| ends_of(list, x));
            assert_variants_agree!(&kernel, &[0.0f32, 0.5, 2.0, -3.0, 9.0, 1.0, 4.0, 0.125, 3.0]);
        }
    }
    let list = &all[..0];
    let kernel = kernel!(|x: f32| ends_of(list, x));
    assert_eq!(kernel.call((0.0,)), -1.0 - 2000.0 - 0.003);
}

/// An array has a length of its own: there is nothing to test.
#[kernel]
fn corner(at: [f32; 3]) -> f32 {
    match at {
        [0.0, y, _] => y,
        [x, _, 1.0] => x,
        [x, y, z] => x + y + z,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[allow(clippy::upper_case_acronyms, reason = "names as users have them")]
enum Lobe {
    GGX { alpha: f32 },
    HG(f32),
    A1(f32, u32),
    OFF,
    Lambert(Vec3),
}

#[kernel]
fn of_lobe(lobe: Lobe) -> f32 {
    match lobe {
        Lobe::GGX { alpha } if alpha > 4.0 => 7.0,
        Lobe::GGX { .. } => 1.0,
        Lobe::HG(g) => g + 2.0,
        Lobe::A1(a, n) => a * n as f32,
        Lobe::Lambert(color) => color.x,
        _ => 5.0,
    }
}

#[kernel]
fn other_lobe(lobe: Lobe, x: f32) -> Lobe {
    match lobe {
        Lobe::GGX { alpha } => Lobe::HG(alpha),
        Lobe::HG(g) => Lobe::A1(g, 3),
        Lobe::A1(a, _) => Lobe::GGX { alpha: a * x },
        Lobe::Lambert(_) => Lobe::OFF,
        _ => Lobe::Lambert(vec3(x, 1.0, 2.0)),
    }
}

/// Kinds are named in capitals too.
#[test]
fn kinds_in_capitals() {
    let lobes: Vec<(Lobe,)> = (0..40)
        .map(|i| {
            let x = i as f32 * 0.25;
            (match i % 5 {
                0 => Lobe::GGX { alpha: x },
                1 => Lobe::HG(x),
                2 => Lobe::A1(x, i),
                3 => Lobe::OFF,
                _ => Lobe::Lambert(vec3(x, 0.0, 1.0)),
            },)
        })
        .collect();
    assert_variants_agree!(of_lobe, &lobes);
    let with_x: Vec<(Lobe, f32)> = lobes.iter().map(|(l,)| (*l, 1.5)).collect();
    assert_variants_agree!(other_lobe, &with_x);
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Filter {
    None,
    Linear,
    Cubic,
}

#[kernel]
fn filter_of(x: f32) -> Filter {
    let best = if x > 1.0 { Filter::Cubic } else { Filter::None };
    match best {
        Filter::None if x > 0.0 => Filter::Linear,
        Filter::None => Filter::None,
        other => other,
    }
}

/// A kind may be called as that of `Option`.
#[test]
fn a_kind_may_be_called_none() {
    assert_variants_agree!(filter_of, &[-1.0f32, 0.0, 0.5, 1.0, 2.0, 3.0, -0.5, 0.25, 9.0]);
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Side {
    Front,
    Back,
}

#[kernel]
impl Side {
    fn flip(&mut self) {
        *self = match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        };
    }
}

#[kernel]
fn keep(best: &mut Option<f32>, t: f32) {
    if let Some(b) = best {
        if *b > t {
            *best = Some(t);
        }
    } else {
        *best = Some(t);
    }
}

#[kernel]
fn flips(x: f32, count: u32) -> (Side, f32) {
    let mut side = Side::Front;
    let mut best = None;
    for i in 0..count {
        if x > i as f32 {
            side.flip();
        }
        keep(&mut best, (i as f32 - x).abs());
    }
    (side, best.unwrap_or(-1.0))
}

/// What a `&mut` is behind is matched where it is.
#[test]
fn what_is_changed_is_matched() {
    let inputs: Vec<(f32, u32)> = (0..40).map(|i| (i as f32 * 0.3, i % 9)).collect();
    assert_variants_agree!(flips, &inputs);
}

/// A kind without equality.
#[derive(Clone, Copy, Debug, Type)]
enum Sky {
    Clear,
    Overcast,
}

const SKY: Sky = Sky::Overcast;

#[kernel]
fn under_the_sky(x: f32) -> f32 {
    match SKY {
        Sky::Clear => x,
        Sky::Overcast => x * 0.5,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Lens {
    size: f32,
}

#[kernel]
impl Lens {
    fn r#type(&self) -> f32 {
        self.size * 3.0
    }

    fn __half(x: f32) -> f32 {
        x * 0.5
    }
}

#[kernel]
fn of_lens(lens: Lens) -> f32 {
    Lens::r#type(&lens) + Lens::__half(lens.size)
}

/// Names as Rust allows them.
#[test]
fn words_and_underscores_in_names() {
    let lenses: Vec<(Lens,)> = (0..20).map(|i| (Lens { size: i as f32 },)).collect();
    assert_variants_agree!(of_lens, &lenses);
    assert_variants_agree!(under_the_sky, &[0.0f32, 1.0, 2.0, -3.0, 5.0]);
    let corners: Vec<([f32; 3],)> =
        (0..30).map(|i| ([(i % 2) as f32, i as f32, (i % 3) as f32],)).collect();
    assert_variants_agree!(corner, &corners);
    assert!(!Kernel::of::<corner>().wgsl().contains("true"));
}
