//! The command line.

use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use raydsl::kernel::Variant;
use raydsl_examples::args::{seconds, share, size, variant};

/// Render a mesh under a white sky until the picture's error is small enough.
#[derive(Debug, Parser)]
#[command(about, after_help = "Ctrl-C leaves the best picture so far.")]
pub(crate) struct Args {
    /// Folder of the picture.
    #[arg(value_name = "FOLDER", default_value = "out")]
    pub(crate) folder: PathBuf,
    /// The mesh, .obj, .ply or .tri [default: half a sponge].
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// The root mean squared error to reach, of white: 1% or 0.01.
    #[arg(long, value_name = "SHARE", default_value = "1%", value_parser = share)]
    pub(crate) error: f64,
    /// How sure that must be, from 50% to 99.99%.
    #[arg(long, value_name = "SHARE", default_value = "95%", value_parser = share)]
    pub(crate) confidence: f64,
    /// Take more samples where the picture needs more, and write how many: until_samples.png.
    #[arg(long)]
    pub(crate) adaptive: bool,
    /// The time that may be spent, such as 30s.
    #[arg(long, default_value = "120s", value_parser = seconds)]
    pub(crate) time: Duration,
    /// What runs the kernel: scalar, packet4, packet8, packet16 or wgsl.
    #[arg(long, default_value = Variant::widest().name(), value_parser = variant)]
    pub(crate) variant: Variant,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = size)]
    pub(crate) size: (u32, u32),
}
