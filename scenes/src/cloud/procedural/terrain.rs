//! The lie of the land: heights, the river, the road and the fields.
//!
//! The landscape is laid out in view coordinates: `s` grows to the right and `t` into
//! the distance for a camera that looks along (1, 1). This keeps the composition in one
//! place: fields in front, a river, the village behind it, hills at the back.

use super::noise::{fractal, hash, mix, noise2, smoothstep, unit};

/// Half the side of the square of land, in metres.
pub(super) const HALF: f64 = 100.0;
/// Height of the river's surface.
pub(super) const WATER: f64 = 0.0;
/// Height at which the land is cut off below.
pub(super) const CUT: f64 = -7.0;
/// The middle of the village, as (`s`, `t`).
pub(super) const VILLAGE: (f64, f64) = (0.0, 12.0);
/// The castle's hilltop, as (`s`, `t`).
pub(super) const CASTLE: (f64, f64) = (-44.0, 68.0);

const RIVER_HALF_WIDTH: f64 = 6.0;
const ROAD_HALF_WIDTH: f64 = 1.9;
/// Width and depth of a field, in metres, and how far the rows are turned.
const FIELD: (f64, f64) = (36.0, 27.0);
const FIELD_TURN: (f64, f64) = (0.956, 0.292);

/// World (`x`, `y`) to view (`s`, `t`).
pub(super) fn to_view(x: f64, y: f64) -> (f64, f64) {
    let k = std::f64::consts::FRAC_1_SQRT_2;
    ((x - y) * k, (x + y) * k)
}

/// View (`s`, `t`) to world (`x`, `y`).
pub(super) fn to_world(s: f64, t: f64) -> (f64, f64) {
    let k = std::f64::consts::FRAC_1_SQRT_2;
    ((s + t) * k, (t - s) * k)
}

/// What grows on a field.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Crop {
    Wheat,
    Ploughed,
    Cabbage,
    Meadow,
    Lavender,
    Orchard,
}

/// A place on a field.
pub(super) struct Field {
    pub(super) crop: Crop,
    /// Metres to the nearest border of the field.
    pub(super) border: f64,
    /// Metres across the rows.
    pub(super) across: f64,
    /// Metres along the rows.
    pub(super) along: f64,
}

/// The ground as functions of the place.
#[derive(Clone, Copy)]
pub(super) struct Terrain {
    pub(super) seed: u64,
}

impl Terrain {
    /// The river's middle line.
    pub(super) fn river(s: f64) -> f64 {
        -30.0 - 0.34 * s + 13.0 * (s * 0.042 + 0.4).sin() + 4.0 * (s * 0.11).sin()
    }

    /// Signed metres from the river's middle line, roughly perpendicular to it; positive
    /// on the village's side.
    pub(super) fn river_distance(s: f64, t: f64) -> f64 {
        let slope = Self::river(s + 0.5) - Self::river(s - 0.5);
        (t - Self::river(s)) / slope.hypot(1.0)
    }

    /// The road's middle line.
    pub(super) fn road(t: f64) -> f64 {
        -8.0 + 11.0 * (t * 0.036 + 0.5).sin() + 0.10 * t
    }

    /// Metres from the road's middle line.
    pub(super) fn road_distance(s: f64, t: f64) -> f64 {
        let slope = Self::road(t + 0.5) - Self::road(t - 0.5);
        (s - Self::road(t)).abs() / slope.hypot(1.0)
    }

    /// How much of the ground here is road, 0 to 1.
    pub(super) fn road_cover(s: f64, t: f64) -> f64 {
        // Behind the village the road runs out into the meadows.
        let end = smoothstep(58.0, 46.0, t);
        end * smoothstep(ROAD_HALF_WIDTH + 0.5, ROAD_HALF_WIDTH - 0.3, Self::road_distance(s, t))
    }

    /// How much this place belongs to the village, 0 to 1.
    pub(super) fn village_cover(s: f64, t: f64) -> f64 {
        let d = ((s - VILLAGE.0) / 50.0).hypot((t - VILLAGE.1) / 32.0);
        smoothstep(1.15, 0.75, d)
    }

    /// Height of the ground, also under water.
    pub(super) fn height(&self, x: f64, y: f64) -> f64 {
        let (s, t) = to_view(x, y);
        let rolling = 3.2 + 3.0 * fractal(self.seed, x / 46.0, y / 46.0, 4);
        let plain = mix(rolling, 3.4, 0.85 * Self::village_cover(s, t));
        let land = plain.max(0.9) + self.hills(x, y, s, t);
        let bank = smoothstep(
            RIVER_HALF_WIDTH - 2.5,
            RIVER_HALF_WIDTH + 9.0,
            Self::river_distance(s, t).abs() + 1.2 * noise2(self.seed ^ 0x21, x / 5.0, y / 5.0),
        );
        mix(WATER - 1.4, land, bank)
    }

    fn hills(&self, x: f64, y: f64, s: f64, t: f64) -> f64 {
        let wander = 16.0 * noise2(self.seed ^ 0x11, s / 38.0, t / 60.0);
        let rise = smoothstep(38.0, 128.0, t + wander);
        let ridge = 1.0 - fractal(self.seed ^ 0x12, x / 40.0, y / 40.0, 5).abs() * 1.7;
        let hill = {
            let d = ((s - CASTLE.0) / 30.0).hypot((t - CASTLE.1) / 28.0);
            17.0 * smoothstep(1.3, 0.6, d)
        };
        let range = rise * (20.0 + 13.0 * ridge);
        // The castle's hill keeps a level top.
        hill.max(range) + 0.15 * hill.min(range)
    }

    /// The field at a place, if the land is tilled there.
    pub(super) fn field(&self, s: f64, t: f64) -> Option<Field> {
        let near_bank = -Self::river_distance(s, t) > 15.0;
        let east = s > 58.0 && t < 44.0 && Self::river_distance(s, t) > 14.0;
        if !(near_bank || east) || Self::road_distance(s, t) < 4.2 {
            return None;
        }
        let across = FIELD_TURN.0 * s + FIELD_TURN.1 * t;
        let along = FIELD_TURN.0 * t - FIELD_TURN.1 * s;
        let row = (along / FIELD.1).floor();
        // Every second row is shifted, as fields are seldom a chessboard.
        let across = across + 13.0 * row;
        let column = (across / FIELD.0).floor();
        let (u, v) = (across - column * FIELD.0, along - row * FIELD.1);
        let border = u.min(FIELD.0 - u).min(v).min(FIELD.1 - v);
        let id = hash(self.seed ^ 0x31, (column as i64 as u64) << 20 ^ (row as i64 as u64));
        let crop = match id % 11 {
            0..=2 => Crop::Wheat,
            3..=4 => Crop::Ploughed,
            5..=6 => Crop::Cabbage,
            7 => Crop::Meadow,
            8..=9 => Crop::Lavender,
            _ => Crop::Orchard,
        };
        Some(Field { crop, border, across: u, along: v })
    }

    /// How dense the forest is, 0 to 1.
    pub(super) fn forest(&self, x: f64, y: f64) -> f64 {
        let (s, t) = to_view(x, y);
        let clumps = 0.5 + 0.9 * fractal(self.seed ^ 0x41, x / 24.0, y / 24.0, 3);
        let summit = ((s - CASTLE.0) / 17.0).hypot((t - CASTLE.1) / 15.0);
        smoothstep(44.0, 76.0, t) * smoothstep(0.15, 0.6, clumps) * smoothstep(0.9, 1.4, summit)
    }

    /// A value in `0.0..1.0` that belongs to the point's index, for its grain.
    pub(super) fn grain(&self, index: u64) -> f64 {
        unit(self.seed ^ 0x51, index)
    }
}
