//! The command line.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use raydsl::kernel::Variant;
use raydsl_examples::args::{length, point, size, variant};

/// Show a vector field by streamlines and arrows, or fibre tracts, by every variant of one kernel.
#[derive(Debug, Parser)]
#[command(about, after_help = "Without a FILE a flow of vortices is made in code.")]
pub(crate) struct Args {
    /// The field: .vtu. With --tracts, fibre tracts: .trk.
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// FILE has tracts: show them, coloured by their direction.
    #[arg(
        long,
        requires = "file",
        conflicts_with_all = ["vectors", "color", "map", "lines", "arrows", "tolerance", "length"]
    )]
    pub(crate) tracts: bool,
    /// The array of vectors [default: the first one of three components].
    #[arg(long, value_name = "NAME", requires = "file")]
    pub(crate) vectors: Option<String>,
    /// What colours show: speed, time, or an array of the points of FILE.
    #[arg(long, value_name = "NAME", default_value = "speed")]
    pub(crate) color: String,
    /// Colour map.
    #[arg(long, value_name = "NAME", default_value = "viridis")]
    pub(crate) map: Map,
    /// Number of lines.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) lines: u32,
    /// Show arrows too, so many along the longest side.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) arrows: Option<u32>,
    /// Error of each step, in the field's units [default: 1e-5 of its extent].
    #[arg(long, value_name = "E", value_parser = length)]
    pub(crate) tolerance: Option<f32>,
    /// Length of lines to either side [default: the extent].
    #[arg(long, value_name = "L", value_parser = length)]
    pub(crate) length: Option<f32>,
    /// Radius of tubes [default: 1/200 of the extent].
    #[arg(long, value_name = "R", value_parser = length)]
    pub(crate) radius: Option<f32>,
    /// Direction from the middle to the camera [default: from the front, the left and above].
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) from: Option<[f64; 3]>,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "960x720", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Which variants run, beside the scalar one.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "scalar,packet4,packet8,packet16,wgsl",
        value_parser = variant
    )]
    pub(crate) variants: Vec<Variant>,
    /// Timed rounds.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) runs: u16,
    /// Folder of the pictures.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Time lines through the made flow instead, and measure their errors over tolerances.
    #[arg(
        long,
        conflicts_with_all = [
            "file", "color", "map", "arrows", "tolerance", "length", "radius", "from", "size",
            "variants", "out",
        ]
    )]
    pub(crate) measure: bool,
}

/// Perceptual colour maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Map {
    Viridis,
    Plasma,
    Inferno,
    Magma,
    Cividis,
    Turbo,
}

impl Map {
    pub(crate) const fn gradient(self) -> colorous::Gradient {
        match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Plasma => colorous::PLASMA,
            Self::Inferno => colorous::INFERNO,
            Self::Magma => colorous::MAGMA,
            Self::Cividis => colorous::CIVIDIS,
            Self::Turbo => colorous::TURBO,
        }
    }
}
