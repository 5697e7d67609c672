//! The command line.

use std::path::PathBuf;

use clap::Parser;
use raydsl::kernel::Variant;
use raydsl_examples::args::{length, variant};

use super::SIDE;
use super::scanner::{Mirror, Scanner};

/// The most pulses: their results take 84 bytes each, twice.
const MOST_PULSES: f64 = 16_777_216.0;

/// Scan the procedural landscape by a laser from an aeroplane, by every variant of one kernel.
#[derive(Debug, Parser)]
#[command(about)]
pub(crate) struct Args {
    /// Folder of the files.
    #[arg(value_name = "FOLDER", default_value = "out")]
    pub(crate) folder: PathBuf,
    /// Height of flight above the water, in metres.
    #[arg(long, value_name = "M", default_value = "300", value_parser = length)]
    pub(crate) altitude: f32,
    /// Speed of flight, in metres a second.
    #[arg(long, value_name = "M/S", default_value = "60", value_parser = length)]
    pub(crate) speed: f32,
    /// Parallel flight lines, flown there and back.
    #[arg(long, value_name = "N", default_value_t = 3)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=100))]
    pub(crate) lines: u16,
    /// Metres between lines.
    #[arg(long, value_name = "M", default_value = "60", value_parser = length)]
    pub(crate) spacing: f32,
    /// Pulses a second.
    #[arg(long, value_name = "HZ", default_value_t = 50_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(100..=10_000_000))]
    pub(crate) rate: u32,
    /// Turns of the mirror a second.
    #[arg(long, value_name = "HZ", default_value_t = 100)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) turns: u32,
    /// Largest scan angle to each side, in degrees.
    #[arg(long, value_name = "DEGREES", default_value = "20", value_parser = length)]
    pub(crate) angle: f32,
    /// How the mirror moves.
    #[arg(long, value_name = "NAME", default_value = "polygon")]
    pub(crate) mirror: Mirror,
    /// The beam's divergence, the whole angle at 1/e² of the light, in milliradians.
    #[arg(long, value_name = "MRAD", default_value = "0.5", value_parser = length)]
    pub(crate) divergence: f32,
    /// Standard deviation of ranges, in metres.
    #[arg(long, value_name = "M", default_value = "0.02", value_parser = length)]
    pub(crate) noise: f32,
    /// Largest roll, pitch and yaw of the aeroplane, in degrees.
    #[arg(long, value_name = "DEGREES", default_value = "1", value_parser = length)]
    pub(crate) wobble: f32,
    /// Another number is another noise.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u32,
    /// Which variants run, beside the scalar one.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "packet4,packet8,packet16,wgsl",
        value_parser = variant
    )]
    pub(crate) variants: Vec<Variant>,
}

impl Args {
    /// The scanner that is asked for.
    pub(crate) fn scanner(&self) -> Result<Scanner, String> {
        let line_pulses = (SIDE / f64::from(self.speed) * f64::from(self.rate)).ceil();
        if line_pulses * f64::from(self.lines) > MOST_PULSES {
            return Err(format!(
                "{:.0} pulses are more than {MOST_PULSES}; lower --rate or --lines, or raise --speed",
                line_pulses * f64::from(self.lines)
            ));
        }
        if self.rate / self.turns < 2 {
            return Err("a turn of the mirror has less than two pulses; raise --rate".to_owned());
        }
        // A tilted beam still points down.
        if self.angle + self.wobble > 75.0 || self.wobble > 15.0 {
            return Err("--angle and --wobble reach 75 degrees together, --wobble 15".to_owned());
        }
        if self.altitude < 100.0 || self.altitude > 10_000.0 {
            return Err("choose an --altitude from 100, above all hills, to 10000".to_owned());
        }
        Ok(Scanner {
            altitude: self.altitude,
            speed: self.speed,
            half_line: 0.5 * SIDE as f32,
            spacing: self.spacing,
            lines: self.lines.into(),
            line_pulses: line_pulses as u32,
            pulse_rate: self.rate as f32,
            turn_pulses: self.rate / self.turns,
            mirror: self.mirror,
            swing: self.angle / 360.0,
            wobble: self.wobble / 360.0,
            half_divergence: 0.5e-3 * self.divergence,
            noise: self.noise,
            separation: 0.6,
            threshold: 0.01,
            seed: self.seed,
        })
    }
}
