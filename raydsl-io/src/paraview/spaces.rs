//! How colours are mixed, by the rules of VTK's `vtkColorTransferFunction` and `vtkMath`.

use std::f64::consts::{PI, TAU};

use super::curve::Way;

/// Where the way between two colours is straight.
#[derive(Clone, Copy)]
pub(super) enum Space {
    Rgb,
    Hsv {
        /// Whether hues take the shorter way around.
        wraps: bool,
    },
    Lab,
    /// Polar Lab, with white between two saturated colours: Kenneth Moreland, *Diverging Color Maps
    /// for Scientific Visualization*, 2009.
    Diverging,
    /// All of the way has the colour of its end.
    Step,
}

impl Space {
    /// The way from one point to another, each a value and a colour.
    pub(super) fn between(
        self,
        [_, from @ ..]: &[f64; 4],
        [_, to @ ..]: &[f64; 4],
    ) -> Way<impl Fn(f64) -> [f64; 3] + use<>> {
        let (from, to) = (*from, *to);
        match self {
            Self::Rgb => Way::Linear,
            _ if from == to => Way::Linear,
            Self::Step => Way::Jump(0.0),
            _ => Way::Curve { corner: 0.5, at: move |share| self.mix(from, to, share) },
        }
    }

    fn mix(self, from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
        match self {
            Self::Rgb => lerp(from, to, share),
            Self::Hsv { wraps } => {
                let (mut from, mut to) = (to_hsv(from), to_hsv(to));
                if wraps && (from[0] - to[0]).abs() > 0.5 {
                    let greater = if from[0] > to[0] { &mut from } else { &mut to };
                    greater[0] -= 1.0;
                }
                from_hsv(lerp(from, to, share))
            }
            Self::Lab => from_lab(lerp(to_lab(from), to_lab(to), share)),
            Self::Diverging => diverging(from, to, share),
            Self::Step => to,
        }
    }
}

fn lerp(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|i| from[i] * (1.0 - share) + to[i] * share)
}

/// Hue, saturation and value, each from 0 to 1. Grey has hue 0.
fn to_hsv([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = most - least;
    if chroma <= 0.0 {
        return [0.0, 0.0, most];
    }
    let sixths = if r == most {
        (g - b) / chroma
    } else if g == most {
        2.0 + (b - r) / chroma
    } else {
        4.0 + (r - g) / chroma
    };
    [(sixths / 6.0).rem_euclid(1.0), chroma / most, most]
}

fn from_hsv([h, s, v]: [f64; 3]) -> [f64; 3] {
    // Each channel is 1 within a sixth of its own hue and 0 beyond two.
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|hue| {
        let away = ((h - hue + 0.5).rem_euclid(1.0) - 0.5).abs();
        let pure = (2.0 - 6.0 * away).clamp(0.0, 1.0);
        v * (1.0 - s + s * pure)
    })
}

/// White of D65, as VTK has it.
const WHITE: [f64; 3] = [0.9505, 1.0, 1.089];

/// CIELAB of sRGB.
fn to_lab(rgb: [f64; 3]) -> [f64; 3] {
    let [r, g, b] =
        rgb.map(|c| if c > 0.04045 { ((c + 0.055) / 1.055).powf(2.4) } else { c / 12.92 });
    let xyz = [
        0.4124 * r + 0.3576 * g + 0.1805 * b,
        0.2126 * r + 0.7152 * g + 0.0722 * b,
        0.0193 * r + 0.1192 * g + 0.9505 * b,
    ];
    let [x, y, z] = std::array::from_fn(|i| {
        let t: f64 = xyz[i] / WHITE[i];
        if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// sRGB of CIELAB; what a display cannot show is scaled down to what it can.
fn from_lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let y = (l + 16.0) / 116.0;
    let cubes = [y + a / 500.0, y, y - b / 200.0];
    let [x, y, z] = std::array::from_fn(|i| {
        let cube: f64 = cubes[i].powi(3);
        WHITE[i] * if cube > 0.008856 { cube } else { (cubes[i] - 16.0 / 116.0) / 7.787 }
    });
    let rgb = [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ];
    let rgb =
        rgb.map(|c| if c > 0.0031308 { 1.055 * c.powf(1.0 / 2.4) - 0.055 } else { 12.92 * c });
    let most = rgb.into_iter().fold(1.0, f64::max);
    rgb.map(|c| (c / most).max(0.0))
}

/// Polar Lab: magnitude, saturation as the angle from grey, and hue as an angle.
fn to_msh(rgb: [f64; 3]) -> [f64; 3] {
    let [l, a, b] = to_lab(rgb);
    let m = (l * l + a * a + b * b).sqrt();
    // By rounding grey may be lighter than its magnitude.
    let s = if m > 0.001 { (l / m).clamp(-1.0, 1.0).acos() } else { 0.0 };
    [m, s, if s > 0.001 { b.atan2(a) } else { 0.0 }]
}

fn from_msh([m, s, h]: [f64; 3]) -> [f64; 3] {
    from_lab([m * s.cos(), m * s.sin() * h.cos(), m * s.sin() * h.sin()])
}

/// Below this angle a colour is as good as grey, and its hue means nothing.
const GREY: f64 = 0.05;

fn diverging(from: [f64; 3], to: [f64; 3], mut share: f64) -> [f64; 3] {
    let (mut from, mut to) = (to_msh(from), to_msh(to));
    let is_saturated = |c: [f64; 3]| c[1] > GREY;
    let turn = (from[2] - to[2]).abs() % TAU;
    if is_saturated(from) && is_saturated(to) && turn.min(TAU - turn) > 0.33 * PI {
        let white = [from[0].max(to[0]).max(88.0), 0.0, 0.0];
        if share < 0.5 {
            to = white;
            share *= 2.0;
        } else {
            from = white;
            share = 2.0 * share - 1.0;
        }
    }
    if from[1] < GREY && is_saturated(to) {
        from[2] = hue_beside(to, from[0]);
    } else if to[1] < GREY && is_saturated(from) {
        to[2] = hue_beside(from, to[0]);
    }
    from_msh(lerp(from, to, share))
}

/// The hue for grey of magnitude `grey`, such that the way to it looks even.
fn hue_beside([m, s, h]: [f64; 3], grey: f64) -> f64 {
    if m >= grey - 0.1 {
        return h;
    }
    let spin = s * (grey * grey - m * m).sqrt() / (m * s.sin());
    // Away from purple.
    if h > -0.3 * PI { h + spin } else { h - spin }
}

#[cfg(test)]
mod tests {
    use super::super::curve::{follow, linear};
    use super::*;

    const BLUE: [f64; 3] = [59.0 / 255.0, 76.0 / 255.0, 192.0 / 255.0];
    const RED: [f64; 3] = [180.0 / 255.0, 4.0 / 255.0, 38.0 / 255.0];

    #[track_caller]
    fn assert_close(found: [f64; 3], expected: [f64; 3], bound: f64) {
        let is_close = (0..3).all(|i| (found[i] - expected[i]).abs() <= bound);
        assert!(is_close, "{found:?} is not {expected:?}");
    }

    /// Lab of sRGB's primaries, as tables have it.
    #[test]
    fn lab_of_primaries() {
        for (rgb, lab) in [
            ([1.0, 0.0, 0.0], [53.24, 80.09, 67.20]),
            ([0.0, 1.0, 0.0], [87.73, -86.18, 83.18]),
            ([0.0, 0.0, 1.0], [32.30, 79.19, -107.86]),
            ([1.0, 1.0, 1.0], [100.0, 0.0, 0.0]),
            ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        ] {
            assert_close(to_lab(rgb), lab, 0.03);
        }
    }

    #[test]
    fn spaces_have_ways_back() {
        for i in 0..1000 {
            let rgb = [i % 10, i / 10 % 10, i / 100].map(|n| f64::from(n) / 9.0);
            assert_close(from_hsv(to_hsv(rgb)), rgb, 1e-12);
            // The two matrices have four digits.
            assert_close(from_lab(to_lab(rgb)), rgb, 1e-3);
            assert_close(from_msh(to_msh(rgb)), rgb, 1e-3);
        }
    }

    #[test]
    fn hues_take_their_way() {
        let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
        let mix = |wraps, share| Space::Hsv { wraps }.mix(red, blue, share);
        assert_close(mix(false, 0.5), [0.0, 1.0, 0.0], 1e-12);
        assert_close(mix(true, 0.5), [1.0, 0.0, 1.0], 1e-12);
        assert_close(mix(true, 0.25), [1.0, 0.0, 0.5], 1e-12);
        assert_close(Space::Hsv { wraps: true }.mix(blue, red, 0.75), [1.0, 0.0, 0.5], 1e-12);
    }

    /// The table that Moreland published with his paper, in bytes.
    #[test]
    fn diverging_is_moreland_s() {
        let table = [
            (0.0, [59, 76, 192]),
            (0.125, [98, 130, 234]),
            (0.25, [141, 176, 254]),
            (0.375, [184, 208, 249]),
            (0.5, [221, 221, 221]),
            (0.625, [245, 196, 173]),
            (0.75, [244, 154, 123]),
            (0.875, [222, 96, 77]),
            (1.0, [180, 4, 38]),
        ];
        for (share, bytes) in table {
            let found = diverging(BLUE, RED, share);
            assert_close(found, bytes.map(|b| f64::from(b) / 255.0), 1.0 / 255.0);
        }
    }

    /// Linear pieces are within the error that is promised, everywhere on the way.
    #[test]
    fn pieces_follow_every_space() {
        let spaces = [
            Space::Rgb,
            Space::Hsv { wraps: false },
            Space::Hsv { wraps: true },
            Space::Lab,
            Space::Diverging,
        ];
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            // Channels at their ends are where clipping is.
            ((state >> 33) % 600) as f64 / 400.0 - 0.25
        };
        let mut most = 0;
        for round in 0..2000 {
            let [mut from, to] = [(); 2].map(|()| [(); 3].map(|()| random().clamp(0.0, 1.0)));
            let is_dark = round % 50 == 0;
            if is_dark {
                // From there to white a hue may turn a hundred times.
                from = from.map(|c| (c * 4.0).round() / 255.0);
            }
            for space in spaces {
                let points = [(0.0, from), (1.0, to)].map(|(v, [r, g, b])| [v, r, g, b]);
                let mut room = 100_000;
                let knots = follow(&points, |a, b| space.between(a, b), &mut room).expect("room");
                if !is_dark {
                    most = most.max(knots.len());
                }
                for i in 0..500 {
                    let share = (f64::from(i) + 0.5) / 500.0;
                    let found = linear(&knots, share);
                    let expected = space.mix(from, to, share);
                    let is_close = (0..3).all(|i| (found[i] - expected[i]).abs() < 1.0 / 510.0);
                    assert!(is_close, "round {round} at {share}: {found:?} for {expected:?}");
                }
            }
        }
        assert!(most < 2000, "{most} knots between two points");
    }
}
