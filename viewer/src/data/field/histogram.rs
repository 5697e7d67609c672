//! How often values occur.

use raydsl::prelude::*;

/// Returns the least and the greatest finite value.
pub(in crate::data) fn bounds_of(values: impl Iterator<Item = f32>) -> Vec2 {
    let none = vec2(f32::INFINITY, f32::NEG_INFINITY);
    values.filter(|v| v.is_finite()).fold(none, |r, v| vec2(r.x.min(v), r.y.max(v)))
}

/// Parts of the histogram.
const PARTS: usize = 128;

/// Counts values in equal parts of a range.
pub(in crate::data) fn histogram(values: &[f32], range: Vec2) -> Vec<u32> {
    let mut counts = vec![0u32; PARTS];
    let scale = PARTS as f32 / (range.y - range.x).max(f32::MIN_POSITIVE);
    for v in values.iter().filter(|v| v.is_finite()) {
        let part = ((v - range.x) * scale) as usize;
        counts[part.min(PARTS - 1)] += 1;
    }
    counts
}
