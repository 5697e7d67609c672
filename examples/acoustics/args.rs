//! The command line.

use std::path::PathBuf;

use clap::Parser;
use glam::DVec3;
use raydsl::kernel::Variant;
use raydsl_examples::args::{point, share, variant};

use super::bins::Bins;
use super::room::{Room, SPEED};

/// The most image sources that are summed, and the most bins.
const MOST_IMAGES: f64 = 1e8;
const MOST_BINS: f64 = 1e5;

/// Hear an impulse in a box room: by rays, and exactly, by image sources.
#[derive(Debug, Parser)]
#[command(about)]
pub(crate) struct Args {
    /// Folder of the picture.
    #[arg(value_name = "FOLDER", default_value = "out")]
    pub(crate) folder: PathBuf,
    /// Sides of the room, in metres.
    #[arg(long, value_name = "X,Y,Z", default_value = "7.1,5.3,3.7", value_parser = point)]
    pub(crate) room: [f64; 3],
    /// Where the source is.
    #[arg(long, value_name = "X,Y,Z", default_value = "1.6,1.9,1.5", value_parser = point)]
    pub(crate) source: [f64; 3],
    /// Where the receiver's centre is.
    #[arg(long, value_name = "X,Y,Z", default_value = "5.2,3.4,1.7", value_parser = point)]
    pub(crate) receiver: [f64; 3],
    /// Radius of the receiver, in metres.
    #[arg(long, value_name = "M", default_value_t = 0.5)]
    pub(crate) radius: f64,
    /// What walls absorb: one share, or six, of x = 0, the wall opposite, y = 0, and so on.
    #[arg(
        long,
        value_name = "SHARES",
        value_delimiter = ',',
        default_value = "20%",
        value_parser = share
    )]
    pub(crate) absorption: Vec<f64>,
    /// Attenuation of energy in air, per metre.
    #[arg(long, value_name = "SHARE", default_value_t = 0.001)]
    pub(crate) air: f64,
    /// Length of the response, in milliseconds.
    #[arg(long, value_name = "MS", default_value_t = 900.0)]
    pub(crate) time: f64,
    /// Length of a bin, in milliseconds.
    #[arg(long, value_name = "MS", default_value_t = 1.0)]
    pub(crate) bin: f64,
    /// The most rays; fewer by factors of ten come before.
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1000..=1_000_000_000))]
    pub(crate) rays: u32,
    /// Another number is other rays.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u32,
    /// Which variants are compared, beside the scalar one.
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
    /// The room that is asked for.
    pub(crate) fn room(&self) -> Result<Room, String> {
        let absorption = match self.absorption[..] {
            [one] => [one; 6],
            [a, b, c, d, e, f] => [a, b, c, d, e, f],
            _ => return Err("--absorption is one share, or six".to_owned()),
        };
        let is_length = |v: f64| v.is_finite() && v > 0.0;
        if !is_length(self.radius) || !(0.0..=1.0).contains(&self.air) {
            return Err("--radius is above 0, and --air from 0 to 1".to_owned());
        }
        let room = Room {
            size: DVec3::from(self.room),
            absorption,
            air: self.air,
            source: DVec3::from(self.source),
            receiver: DVec3::from(self.receiver),
            radius: self.radius,
        };
        room.check().map(|()| room)
    }

    /// The bins that are asked for.
    pub(crate) fn bins(&self, room: &Room) -> Result<Bins, String> {
        let count = (self.time / self.bin).ceil();
        if !(self.bin > 0.0 && (10.0..=MOST_BINS).contains(&count)) {
            return Err(format!("--time has from 10 to {MOST_BINS} times --bin"));
        }
        let bins = Bins { count: count as usize, length: 1e-3 * self.bin * SPEED };
        let images = room.image_count(bins.reach());
        if images > MOST_IMAGES {
            return Err(format!("{images:.1e} image sources are too many; lower --time"));
        }
        Ok(bins)
    }
}
