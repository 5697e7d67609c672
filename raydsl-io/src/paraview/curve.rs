//! Linear pieces that follow curves between points.

/// Half a level of a byte is 1/510; what is between the places that are looked at has room.
const ERROR: f64 = 1.0 / 1024.0;
/// Pieces are halved so often at most.
const DEPTH: u32 = 16;

/// How numbers go from one point to the next, by shares of the way from 0 to 1.
pub(super) enum Way<C> {
    Linear,
    /// A jump at a share.
    Jump(f64),
    /// A curve that has a corner at a share.
    Curve {
        corner: f64,
        at: C,
    },
}

/// Knots of linear pieces through points, a value and three numbers each; of these the first `N`
/// are followed. None if there is no room for them.
pub(super) fn follow<const N: usize, C: Fn(f64) -> [f64; N]>(
    points: &[[f64; 4]],
    between: impl Fn(&[f64; 4], &[f64; 4]) -> Way<C>,
    room: &mut usize,
) -> Option<Vec<(f32, [f32; N])>> {
    let numbers = |point: &[f64; 4]| -> [f64; N] { std::array::from_fn(|i| point[i + 1]) };
    let mut knots: Vec<(f32, [f32; N])> = Vec::new();
    for (i, point) in points.iter().enumerate() {
        let begin = knots.len();
        // The first point has none before it.
        let from = &points[i.saturating_sub(1)];
        let mut add = |share: f64, numbers: [f64; N]| {
            let value = from[0] + (point[0] - from[0]) * share;
            let knot = (value as f32, numbers.map(|x| x as f32));
            if knots.last() != Some(&knot) {
                knots.push(knot);
            }
        };
        // Points of one value are a step.
        if (from[0] as f32) < point[0] as f32 {
            match between(from, point) {
                Way::Linear => {}
                Way::Jump(share) => {
                    add(share, numbers(from));
                    add(share, numbers(point));
                }
                Way::Curve { corner, at } => {
                    // A curve may miss its ends: there are steps then.
                    let end = |share, own| {
                        let curve = at(share);
                        (share, if is_near(own, curve) { own } else { curve })
                    };
                    let (begin, end) = (end(0.0, numbers(from)), end(1.0, numbers(point)));
                    let middle = (corner, at(corner));
                    add(begin.0, begin.1);
                    refine([begin, middle], &at, DEPTH, &mut add);
                    add(corner, middle.1);
                    refine([middle, end], &at, DEPTH, &mut add);
                    add(end.0, end.1);
                }
            }
        }
        add(1.0, numbers(point));
        *room = room.checked_sub(knots.len() - begin)?;
    }
    Some(knots)
}

fn is_near<const N: usize>(a: [f64; N], b: [f64; N]) -> bool {
    (0..N).all(|i| (a[i] - b[i]).abs() <= ERROR)
}

/// Adds what is between two places of a curve, until pieces are near enough.
fn refine<const N: usize>(
    [from, to]: [(f64, [f64; N]); 2],
    at: &impl Fn(f64) -> [f64; N],
    depth: u32,
    add: &mut impl FnMut(f64, [f64; N]),
) {
    let is_followed = |eighth: u32| {
        let share = f64::from(eighth) / 8.0;
        let piece = std::array::from_fn(|i| from.1[i] + (to.1[i] - from.1[i]) * share);
        is_near(piece, at(from.0 + (to.0 - from.0) * share))
    };
    if depth == 0 || (1..8).all(is_followed) {
        return;
    }
    let share = (from.0 + to.0) * 0.5;
    let middle = (share, at(share));
    refine([from, middle], at, depth - 1, add);
    add(middle.0, middle.1);
    refine([middle, to], at, depth - 1, add);
}

/// The way of `vtkPiecewiseFunction` between two points of opacity.
pub(super) fn opacity(
    [_, from, midpoint, sharpness]: &[f64; 4],
    [_, to, ..]: &[f64; 4],
) -> Way<impl Fn(f64) -> [f64; 1] + use<>> {
    let (from, to, sharpness) = (*from, *to, *sharpness);
    let middle = midpoint.clamp(0.00001, 0.99999);
    if sharpness > 0.99 {
        return Way::Jump(middle);
    }
    if from == to || (middle == 0.5 && sharpness < 0.01) {
        return Way::Linear;
    }
    let at = move |share: f64| [from + (to - from) * rise(share, middle, sharpness)];
    Way::Curve { corner: middle, at }
}

/// What part of the rise from one point to the next there is at a share of the way.
fn rise(share: f64, middle: f64, sharpness: f64) -> f64 {
    // The half of the way is where the midpoint is.
    let s = match share < middle {
        true => 0.5 * share / middle,
        false => 0.5 + 0.5 * (share - middle) / (1.0 - middle),
    };
    if sharpness < 0.01 {
        return s;
    }
    let power = 1.0 + 10.0 * sharpness;
    let s = match s < 0.5 {
        true => 0.5 * (2.0 * s).powf(power),
        false => 1.0 - 0.5 * (2.0 * (1.0 - s)).powf(power),
    };
    // Hermite's cubic, with one slope at both ends.
    let slope = 1.0 - sharpness;
    let (s2, s3) = (s * s, s * s * s);
    let rise = 3.0 * s2 - 2.0 * s3 + slope * (2.0 * s3 - 3.0 * s2 + s);
    rise.clamp(0.0, 1.0)
}

/// The value of linear pieces at a place that they reach.
#[cfg(test)]
pub(super) fn linear<const N: usize>(knots: &[(f32, [f32; N])], value: f64) -> [f64; N] {
    let wide = |i: usize| (f64::from(knots[i].0), knots[i].1.map(f64::from));
    let behind = knots.partition_point(|k| f64::from(k.0) < value).clamp(1, knots.len() - 1);
    let ((v0, from), (v1, to)) = (wide(behind - 1), wide(behind));
    let share = if v1 > v0 { (value - v0) / (v1 - v0) } else { 0.0 };
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_followed() {
        let points = [[-3.0, 0.2, 0.0, 0.0], [5.0, 0.9, 0.5, 0.0]];
        for middle in [0.0, 0.001, 0.2, 0.5, 0.77, 1.0] {
            for sharpness in [0.0, 0.01, 0.1, 0.3, 0.6, 0.9, 0.99] {
                let from = [-3.0, 0.2, middle, sharpness];
                let mut room = 1000;
                let knots = follow(&[from, points[1]], opacity, &mut room);
                let knots: Vec<(f32, [f32; 1])> = knots.expect("room");
                assert_eq!(knots.len() + room, 1000);
                assert!(knots.len() < 60, "{} knots", knots.len());
                assert!(knots.is_sorted_by(|a, b| a.0 <= b.0));
                let middle = middle.clamp(0.00001, 0.99999);
                for i in 0..=10_000 {
                    let share = f64::from(i) / 10_000.0;
                    let expected = 0.2 + 0.7 * rise(share, middle, sharpness);
                    let found = linear(&knots, -3.0 + 8.0 * share)[0];
                    assert!(
                        (found - expected).abs() < 1.0 / 510.0,
                        "{middle}, {sharpness} at {share}: {found} for {expected}"
                    );
                }
            }
        }
    }

    /// Half of the rise is at the midpoint, whatever the sharpness; it never turns back.
    #[test]
    fn rises() {
        for middle in [0.1, 0.5, 0.8] {
            for sharpness in [0.0, 0.2, 0.5, 0.9] {
                assert!((rise(middle, middle, sharpness) - 0.5).abs() < 1e-12);
                assert_eq!(
                    (rise(0.0, middle, sharpness), rise(1.0, middle, sharpness)),
                    (0.0, 1.0)
                );
                let all: Vec<f64> =
                    (0..=100).map(|i| rise(f64::from(i) / 100.0, middle, sharpness)).collect();
                assert!(all.is_sorted());
            }
        }
        // By hand: s = 1/4 becomes 1/2 * 2^-3, and the cubic with slope 0.8 follows.
        let s: f64 = 0.0625;
        let expected = 3.0 * s * s - 2.0 * s.powi(3) + 0.8 * (2.0 * s.powi(3) - 3.0 * s * s + s);
        assert_eq!(rise(0.25, 0.5, 0.2), expected);
        assert_eq!(rise(0.05, 0.2, 0.0), 0.125);
    }

    #[test]
    fn room_ends() {
        let points = [[0.0, 0.0, 0.3, 0.5], [1.0, 1.0, 0.5, 0.0]];
        let mut room = 3;
        assert!(follow(&points, opacity, &mut room).is_none());
    }
}
