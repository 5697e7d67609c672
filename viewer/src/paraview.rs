//! Presets of ParaView as knots of a transfer function.
//!
//! A preset has colours and opacities at different values, and mixes colours as they are displayed; a
//! knot has both, and linear colours are mixed. So there are as many knots as it takes to follow the
//! preset.

use raydsl::prelude::*;
use raydsl_io::paraview::Preset;

use crate::look::{Knot, MOST_KNOTS};

/// How far a knot's colours may be from the preset's, as they are displayed, and opacities: a level of a
/// byte.
const NEAR: f32 = 1.0 / 255.0;
/// Parts of a piece of a preset that are looked at: colours are curved in between.
const PARTS: u16 = 8;
/// The most pieces of a preset.
const MOST_PIECES: usize = 1 << 12;
/// Opacities of a preset that has none, over its range.
const RAMP: [(f32, f32); 2] = [(0.1, 0.0), (1.0, 0.9)];

/// A point of a preset: its place in the range of the data, the displayed colour, and the opacity.
type Point = (f32, Vec3, f32);

/// Returns the knots that show values of a range as a preset does. Its values are those of the data, or
/// shares of the range if they are from 0 to 1.
///
/// # Errors
///
/// If the preset has values of the data and these have no range, if it has more pieces than can be
/// followed, or if it needs more knots than a function has.
pub(crate) fn knots(preset: &Preset, range: Vec2) -> Result<Vec<Knot>, String> {
    let (first, last) = match (preset.colors.first(), preset.colors.last()) {
        (Some(first), Some(last)) => (first.0, last.0),
        _ => return Err(format!("{}: has no colours", preset.name)),
    };
    let is_of_shares = (first, last) == (0.0, 1.0);
    let width = range.y - range.x;
    let place = |value: f32| if is_of_shares { value } else { (value - range.x) / width };
    let ramp = RAMP.map(|(at, opacity)| (first + (last - first) * at, opacity));
    let opacities = if preset.opacities.is_empty() { &ramp[..] } else { &preset.opacities };
    let colors: Vec<(f32, Vec3)> = preset.colors.iter().map(|(v, c)| (place(*v), *c)).collect();
    let opacities: Vec<(f32, f32)> = opacities.iter().map(|(v, o)| (place(*v), *o)).collect();
    // Data of one value, or of an infinite range, have no shares.
    let places = || colors.iter().map(|c| c.0).chain(opacities.iter().map(|o| o.0));
    if !(is_of_shares || (width.is_finite() && places().all(f32::is_finite))) {
        return Err(format!(
            "{}: its values from {first} to {last} have no place among data from {} to {}: export it \
             with values from 0 to 1",
            preset.name, range.x, range.y
        ));
    }
    let points = points(&colors, &opacities)
        .ok_or_else(|| format!("{}: has more than {MOST_PIECES} points", preset.name))?;
    let knots = fewest(&points);
    if knots.len() > MOST_KNOTS {
        let count = knots.len();
        return Err(format!("{}: needs {count} knots, and {MOST_KNOTS} is the most", preset.name));
    }
    Ok(knots)
}

/// The value of a piecewise linear list: from the left, or from the right of a step.
fn at<T: Copy>(list: &[(f32, T)], place: f32, is_right: bool, mix: impl Fn(T, T, f32) -> T) -> T {
    let after = list.partition_point(|(p, _)| if is_right { *p <= place } else { *p < place });
    match (after.checked_sub(1).map(|i| list[i]), list.get(after)) {
        (None, _) => list[0].1,
        (Some((_, value)), None) => value,
        (Some((from, a)), Some((to, b))) => mix(a, *b, (place - from) / (to - from)),
    }
}

/// The points of both lists within 0 and 1, and some between them. A step is two points of one place.
fn points(colors: &[(f32, Vec3)], opacities: &[(f32, f32)]) -> Option<Vec<Point>> {
    let inner = colors.iter().map(|c| c.0).chain(opacities.iter().map(|o| o.0));
    let mut places: Vec<f32> = inner.filter(|p| *p > 0.0 && *p < 1.0).chain([0.0, 1.0]).collect();
    places.sort_by(f32::total_cmp);
    places.dedup();
    if places.len() > MOST_PIECES {
        return None;
    }
    let point = |place: f32, is_right: bool| {
        let color = at(colors, place, is_right, |a, b, share| a.lerp(b, share));
        let opacity = at(opacities, place, is_right, |a, b, share| a + (b - a) * share);
        (place, color, opacity)
    };
    let mut all = vec![point(0.0, true)];
    for pair in places.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        for i in 1..PARTS {
            let place = from + (to - from) * (f32::from(i) / f32::from(PARTS));
            if place > from && place < to {
                all.push(point(place, true));
            }
        }
        let (left, right) = (point(to, false), point(to, true));
        all.push(left);
        if to < 1.0 && right != left {
            all.push(right);
        }
    }
    Some(all)
}

/// The knots of points of which as many as possible are left out.
fn fewest(points: &[Point]) -> Vec<Knot> {
    let knot = |&(at, color, opacity): &Point| Knot {
        at,
        opacity,
        color: Vec3::from_array(color.to_array().map(srgb_to_linear)),
    };
    let mut knots = vec![knot(&points[0])];
    let mut from = 0;
    while from + 1 < points.len() {
        // The farthest point that a straight piece reaches, by steps that grow and shrink.
        let (mut to, mut step) = (from + 1, 1);
        let reaches = |to: usize| to < points.len() && is_near(&points[from..=to]);
        while reaches(to + step) {
            to += step;
            step *= 2;
        }
        while step > 0 {
            to += if reaches(to + step) { step } else { 0 };
            step /= 2;
        }
        knots.push(knot(&points[to]));
        from = to;
    }
    knots
}

/// Whether a piece from the first to the last point is near those between.
fn is_near(points: &[Point]) -> bool {
    let [first, inner @ .., last] = points else { return true };
    let linear = |c: Vec3| Vec3::from_array(c.to_array().map(srgb_to_linear));
    let (a, b) = (linear(first.1), linear(last.1));
    inner.iter().all(|(place, color, opacity)| {
        // Points of one place are a step, which no piece passes.
        let share = (place - first.0) / (last.0 - first.0);
        let mixed = Vec3::from_array(a.lerp(b, share).to_array().map(linear_to_srgb));
        let apart = (mixed - *color).abs().max_element();
        apart <= NEAR && (first.2 + (last.2 - first.2) * share - opacity).abs() <= NEAR
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn preset(colors: &[(f32, Vec3)], opacities: &[(f32, f32)]) -> Preset {
        let (colors, opacities) = (colors.to_vec(), opacities.to_vec());
        Preset { name: "a".to_owned(), colors, opacities }
    }

    /// What knots show at a place: the displayed colour, and the opacity.
    fn shown(knots: &[Knot], place: f32) -> (Vec3, f32) {
        let colors: Vec<_> = knots.iter().map(|k| (k.at, k.color)).collect();
        let opacities: Vec<_> = knots.iter().map(|k| (k.at, k.opacity)).collect();
        let color = at(&colors, place, true, |a, b, share| a.lerp(b, share));
        let color = Vec3::from_array(color.to_array().map(linear_to_srgb));
        (color, at(&opacities, place, true, |a, b, share| a + (b - a) * share))
    }

    #[test]
    fn knots_follow_both_lists() {
        let colors =
            [(-10.0, vec3(0.1, 0.2, 0.9)), (5.0, vec3(0.9, 0.9, 0.8)), (30.0, vec3(0.7, 0.0, 0.1))];
        let opacities = [(-10.0, 0.0), (0.0, 0.0), (0.0, 0.5), (20.0, 1.0)];
        let (preset, range) = (preset(&colors, &opacities), vec2(-5.0, 25.0));
        let knots = knots(&preset, range).expect("few knots");
        assert!(knots.len() < 40, "{}", knots.len());
        assert!(knots.is_sorted_by(|a, b| a.at <= b.at));
        assert_eq!((knots[0].at, knots[knots.len() - 1].at), (0.0, 1.0));
        for i in 0..=1000u16 {
            let place = f32::from(i) / 1000.0;
            let value = range.x + (range.y - range.x) * place;
            if value.abs() < 0.1 {
                continue;
            }
            let (color, opacity) = shown(&knots, place);
            let expected = at(&colors, value, true, |a, b, share| a.lerp(b, share));
            let dense = at(&opacities, value, true, |a, b, share| a + (b - a) * share);
            assert!(
                (color - expected).abs().max_element() < 1.5 * NEAR,
                "{value}: {color} {expected}"
            );
            assert!((opacity - dense).abs() < 1.5 * NEAR, "{value}: {opacity} {dense}");
        }
        let (_, before) = shown(&knots, 1.0 / 6.0 - 1e-4);
        let (_, behind) = shown(&knots, 1.0 / 6.0 + 1e-4);
        assert!(before < 0.01 && behind > 0.49, "a step stays one: {before} {behind}");
    }

    #[test]
    fn shares_are_spread_and_opacities_made() {
        let grey = preset(&[(0.0, Vec3::ZERO), (1.0, Vec3::ONE)], &[]);
        let knots = knots(&grey, vec2(100.0, 300.0)).expect("few knots");
        assert_eq!(shown(&knots, 0.05).1, 0.0);
        assert!((shown(&knots, 1.0).1 - 0.9).abs() < 1e-6);
        assert!((shown(&knots, 0.5).0 - 0.5).abs().max_element() < 1.5 * NEAR);
    }

    #[test]
    fn data_without_a_range_have_no_place_for_values() {
        let colors = [(-10.0, Vec3::ZERO), (7.0, Vec3::ONE)];
        let own = preset(&colors, &[]);
        let infinite = [vec2(0.0, f32::INFINITY), vec2(-3e38, 3e38)];
        for range in [vec2(7.0, 7.0), vec2(0.0, 1e-40)].into_iter().chain(infinite) {
            let error = knots(&own, range).expect_err("there is no range");
            assert!(
                error.starts_with("a: its values from -10 to 7 have no place among"),
                "{error}"
            );
        }
        let shares = preset(&[(0.0, Vec3::ZERO), (1.0, Vec3::ONE)], &[]);
        assert!(knots(&shares, vec2(7.0, 7.0)).is_ok(), "shares need none");
    }

    #[test]
    fn what_cannot_be_followed_is_said() {
        let noise = |count: u32| {
            let color = |i: u32| (i as f32 / (count - 1) as f32, Vec3::splat((i % 2) as f32));
            let colors: Vec<_> = (0..count).map(color).collect();
            knots(&preset(&colors, &[]), Vec2::Y)
        };
        assert!(noise(20).is_ok());
        assert!(noise(2000).is_err_and(|e| e.contains("knots, and 256 is the most")));
        assert!(noise(5000).is_err_and(|e| e.contains("more than 4096 points")));
    }
}
