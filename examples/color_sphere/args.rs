//! The command line.

use std::path::PathBuf;

use clap::Parser;
use raydsl::kernel::Variant;
use raydsl_examples::args::{point, size, variant};

/// Render a laser scan as coloured spheres, by every variant of one kernel.
#[derive(Debug, Parser)]
#[command(about, after_help = "Without a FILE a landscape is made in code.")]
pub(crate) struct Args {
    /// The scan: .laz, .las, .ply or .xyz.
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "1920x1200", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Points of the made landscape.
    #[arg(long, value_name = "N", default_value_t = 2_000_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=1 << 30))]
    pub(crate) points: u32,
    /// Which landscape.
    #[arg(long, value_name = "N", default_value_t = 7)]
    pub(crate) seed: u64,
    /// Radius of the spheres in the file's units [default: from the spacing of the points].
    #[arg(long, value_name = "R")]
    pub(crate) radius: Option<f64>,
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
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) runs: u16,
    /// Folder of the pictures.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Write the figures as JSON.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Only say how large the kernel's program is, beside one with all features.
    #[arg(long)]
    pub(crate) explain: bool,
    /// Where the camera is, in the file's units [default: a view of everything].
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) eye: Option<[f64; 3]>,
    /// What it looks at.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) target: Option<[f64; 3]>,
    /// Which way is up.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) up: Option<[f64; 3]>,
    /// Vertical field of view in degrees.
    #[arg(long, value_name = "DEG")]
    pub(crate) fov: Option<f64>,
}
