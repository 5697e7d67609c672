//! Conditions with several patterns.

use raydsl::{Type, assert_variants_agree, kernel};

use super::pairs;

#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Step {
    Down { to: f32, left: u32 },
    Stop(f32),
    Nothing,
}

#[kernel]
fn root(x: f32) -> Option<f32> {
    if x < 0.0 { None } else { Some(x.sqrt() - 0.3) }
}

/// Changes what it counts, so it must be called as often as in the source.
#[kernel]
fn counted(x: f32, calls: &mut u32) -> Option<f32> {
    *calls += 1;
    root(x)
}

#[kernel]
fn step(x: f32, left: u32) -> Step {
    if left == 0 {
        return Step::Nothing;
    }
    if x > 0.2 { Step::Down { to: x * 0.7 - 0.1, left: left - 1 } } else { Step::Stop(x) }
}

#[kernel]
fn chained(x: f32, y: f32) -> [f32; 4] {
    let mut calls = 0;
    let mut found = [0.0, 0.0, 0.0, 0.0];
    if let Some(a) = counted(x, &mut calls)
        && let Some(b) = counted(a, &mut calls)
        && b > y * 0.1
        && let Some(c) = counted(b * y, &mut calls)
    {
        found[0] = a + b * c;
    } else if y > 0.0
        && let Step::Down { to, left } = step(x, 3)
        && let Step::Down { to: further, .. } = step(to, left)
    {
        found[1] = to * further;
    } else {
        found[1] = -1.0;
    }
    let mut now = step(x, 5);
    while let Step::Down { to, left } = now
        && let Some(mut height) = root(to)
    {
        height += y;
        found[2] += height;
        now = step(to, left);
    }
    if let Step::Stop(x) = now
        && let Some(x) = root(-x)
    {
        found[2] *= x;
    }
    found[3] = calls as f32;
    found
}

#[test]
fn chains_of_patterns() {
    let inputs: Vec<(f32, f32)> =
        pairs().into_iter().map(|(x, y)| (x * 1.013 + 0.0021, y * 0.987 - 0.0047)).collect();
    assert_variants_agree!(chained, &inputs);
}
