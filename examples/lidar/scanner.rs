//! Where the aeroplane is at each pulse, and where its beam points.

use clap::ValueEnum;
use raydsl::prelude::*;
use raydsl::{Type, kernel};

/// GPS time of the first pulse, in seconds after 10⁹ of standard GPS time, as LAS files count.
const START: f64 = 300_000_000.0;
/// Seconds that the aeroplane takes to turn round.
const TURN_ROUND: f64 = 90.0;

/// How the mirror moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Type, ValueEnum)]
#[repr(u32)]
pub(crate) enum Mirror {
    /// Facets turn: each sweeps from left to right at an even speed.
    Polygon,
    /// It swings, and is slowest at both sides.
    Oscillating,
}

/// A scanner and its flight. Lines run along y, every second one backwards, beside each other in x;
/// z is up. Lengths are in metres, times in seconds, angles in turns if nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(crate) struct Scanner {
    /// Height of flight.
    pub(crate) altitude: f32,
    /// Speed of flight.
    pub(crate) speed: f32,
    /// Half the length of a line.
    pub(crate) half_line: f32,
    /// Distance between lines.
    pub(crate) spacing: f32,
    /// Number of lines.
    pub(crate) lines: u32,
    /// Pulses of a line.
    pub(crate) line_pulses: u32,
    /// Pulses a second.
    pub(crate) pulse_rate: f32,
    /// Pulses of a turn of the mirror, or of a facet's sweep.
    pub(crate) turn_pulses: u32,
    /// How the mirror moves.
    pub(crate) mirror: Mirror,
    /// Largest scan angle to each side.
    pub(crate) swing: f32,
    /// Largest roll, pitch and yaw.
    pub(crate) wobble: f32,
    /// Angle from the axis at which the light is 1/e² of that on it, in radians.
    pub(crate) half_divergence: f32,
    /// Standard deviation of ranges.
    pub(crate) noise: f32,
    /// Distance behind a return within which no other is detected.
    pub(crate) separation: f32,
    /// Intensity of the weakest return that is detected.
    pub(crate) threshold: f32,
    /// Seed of all noise.
    pub(crate) seed: u32,
}

/// The axis of a pulse's beam.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(crate) struct Beam {
    /// Where the aeroplane is.
    pub(crate) origin: Vec3,
    /// The direction, of unit length.
    pub(crate) axis: Vec3,
    /// Angle from the vertical across the flight, roll included; positive to the right.
    pub(crate) angle: f32,
}

// ANCHOR: beam
#[kernel]
impl Scanner {
    /// The beam of a pulse, counted through all lines.
    pub(crate) fn beam(&self, pulse: u32) -> Beam {
        let line = pulse / self.line_pulses;
        let of_line = pulse % self.line_pulses;
        let seconds = of_line as f32 / self.pulse_rate;
        let heading = if line % 2 == 1 { -1.0 } else { 1.0 };
        let along = heading * (seconds * self.speed - self.half_line);
        let across = (line as f32 - 0.5 * (self.lines as f32 - 1.0)) * self.spacing;

        // A slow motion about each axis; no two lines have the same.
        let time = seconds + 1.7 * line as f32;
        let roll = self.wobble * sincos_2pi(0.31 * time).sin;
        let pitch = sincos_2pi(self.wobble * sincos_2pi(0.47 * time + 0.2).sin);
        let yaw = sincos_2pi(self.wobble * sincos_2pi(0.23 * time + 0.6).sin);
        let angle = roll + self.scan_angle(of_line);
        let scan = sincos_2pi(angle);

        // To the right, forwards and up, tilted by pitch; then turned by yaw.
        let right = heading * scan.sin;
        let forwards = heading * scan.cos * pitch.sin;
        let down = scan.cos * pitch.cos;
        let x = right * yaw.cos - forwards * yaw.sin;
        let y = right * yaw.sin + forwards * yaw.cos;
        Beam {
            origin: vec3(across, along, self.altitude),
            axis: vec3(x, y, -down).normalize(),
            angle,
        }
    }

    /// The mirror's angle, by whole numbers: a time in seconds would lose its phase.
    fn scan_angle(&self, of_line: u32) -> f32 {
        let phase = (of_line % self.turn_pulses) as f32 / self.turn_pulses as f32;
        let share = match self.mirror {
            Mirror::Polygon => 2.0 * phase - 1.0,
            Mirror::Oscillating => sincos_2pi(phase).sin,
        };
        self.swing * share
    }
}
// ANCHOR_END: beam

impl Scanner {
    /// The line of a pulse, from 0.
    pub(crate) fn line(&self, pulse: u32) -> u32 {
        pulse / self.line_pulses
    }

    /// Whether the mirror sweeps to the right at a pulse.
    pub(crate) fn sweeps_right(&self, pulse: u32) -> bool {
        let of_turn = pulse % self.line_pulses % self.turn_pulses;
        let quarters = 4 * of_turn / self.turn_pulses;
        self.mirror == Mirror::Polygon || quarters == 0 || quarters == 3
    }

    /// When a pulse is emitted, as LAS files count.
    pub(crate) fn gps_time(&self, pulse: u32) -> f64 {
        let turns = TURN_ROUND * f64::from(self.line(pulse));
        START + turns + f64::from(pulse) / f64::from(self.pulse_rate)
    }
}
