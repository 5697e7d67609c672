//! A box room, its walls for rays, and what formulas say of its reverberation.

use glam::DVec3;
use raydsl::prelude::*;

/// Speed of sound in air of 20 °C, in metres a second.
pub(crate) const SPEED: f64 = 343.0;
/// How far walls reach beyond the room's edges, as a share of its sides: no ray leaves between two.
const OVERLAP: f64 = 1e-3;

/// A wall that reflects like a mirror.
#[primitive(rectangle(corner, u_edge, v_edge))]
pub(crate) struct Wall {
    pub(crate) corner: Vec3,
    pub(crate) u_edge: Vec3,
    pub(crate) v_edge: Vec3,
    /// Share of the energy that is not reflected.
    pub(crate) absorption: f32,
}

/// A box from the origin to `size`, with a source of sound that sends energy 1 evenly in all
/// directions at the time 0, and a receiver: a ball, over which energy is averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Room {
    /// Its sides, in metres.
    pub(crate) size: DVec3,
    /// Shares of energy that walls absorb: x = 0, x = size.x, y = 0, and so on.
    pub(crate) absorption: [f64; 6],
    /// Attenuation of energy in air, per metre.
    pub(crate) air: f64,
    /// Where the source is.
    pub(crate) source: DVec3,
    /// Centre of the receiver, and its radius.
    pub(crate) receiver: DVec3,
    pub(crate) radius: f64,
}

impl Room {
    /// Checks that the source and the whole receiver are in the room, apart from each other.
    pub(crate) fn check(&self) -> Result<(), String> {
        let inside = |p: DVec3, margin: f64| {
            p.cmpgt(DVec3::splat(margin)).all() && p.cmplt(self.size - margin).all()
        };
        if !(self.size.cmpge(DVec3::splat(0.1)) & self.size.cmple(DVec3::splat(1e3))).all() {
            return Err("a room has sides from 0.1 to 1000 m; change --room".to_owned());
        }
        if self.absorption.iter().any(|a| !(0.0..=1.0).contains(a)) {
            return Err("a wall absorbs at most 100%; lower --absorption".to_owned());
        }
        if !inside(self.source, 0.0) {
            return Err("the source is outside of the room; move --source".to_owned());
        }
        if !inside(self.receiver, self.radius) {
            let remedy = "move --receiver or lower --radius";
            return Err(format!("a part of the receiver is outside of the room; {remedy}"));
        }
        // Both are rounded to `f32`, so they must not touch.
        if self.source.distance(self.receiver) < 1.001 * self.radius {
            let remedy = "move one of them or lower --radius";
            return Err(format!("the source is within the receiver; {remedy}"));
        }
        Ok(())
    }

    /// The six walls.
    pub(crate) fn walls(&self) -> Vec<Wall> {
        let (low, all) = (-OVERLAP * self.size, (1.0 + 2.0 * OVERLAP) * self.size);
        let wall = |i: usize| {
            let (axis, is_far) = (i / 2, i % 2 == 1);
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut corner = low;
            corner[axis] = if is_far { self.size[axis] } else { 0.0 };
            let edge = |k: usize| (DVec3::AXES[k] * all[k]).as_vec3();
            let absorption = self.absorption[i] as f32;
            Wall { corner: corner.as_vec3(), u_edge: edge(u), v_edge: edge(v), absorption }
        };
        (0..6).map(wall).collect()
    }

    /// Centre and radius of the receiver, for kernels.
    pub(crate) fn ball(&self) -> Vec4 {
        self.receiver.as_vec3().extend(self.radius as f32)
    }

    /// Volume of the receiver.
    pub(crate) fn ball_volume(&self) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * self.radius.powi(3)
    }

    fn volume(&self) -> f64 {
        self.size.element_product()
    }

    /// Area of the walls, and their area weighted by absorption.
    fn areas(&self) -> (f64, f64) {
        let area = |i: usize| self.volume() / self.size[i / 2];
        let sum = |of: &dyn Fn(usize) -> f64| (0..6).map(of).sum::<f64>();
        (sum(&area), sum(&|i| area(i) * self.absorption[i]))
    }

    /// The time to -60 dB if sound loses `per_metre` of its energy along every metre.
    fn time_of(per_metre: f64) -> f64 {
        6.0 * std::f64::consts::LN_10 / (SPEED * per_metre)
    }

    /// The reverberation time in seconds of an even field that loses energy continuously (Sabine,
    /// "Reverberation", 1900).
    pub(crate) fn sabine(&self) -> f64 {
        Self::time_of(self.areas().1 / (4.0 * self.volume()) + self.air)
    }

    /// The reverberation time in seconds of an even field that loses energy at each reflection, after
    /// the mean free path (Eyring, "Reverberation Time in 'Dead' Rooms", 1930).
    pub(crate) fn eyring(&self) -> f64 {
        let (area, absorbing) = self.areas();
        let loss = -(-absorbing / area).ln_1p();
        Self::time_of(area * loss / (4.0 * self.volume()) + self.air)
    }

    /// How many image sources are heard within a way of this length, about.
    pub(crate) fn image_count(&self, reach: f64) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * reach.powi(3) / self.volume()
    }
}
