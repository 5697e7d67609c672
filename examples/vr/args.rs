//! The command line.

use std::path::PathBuf;

use clap::Parser;
use raydsl::kernel::Variant;
use raydsl_examples::args::{size, variant};

/// A stereo pair from a tracked head: a rasteriser and rays in one picture, with leaves cut out by
/// masks, a mirror and shadows, by every variant.
#[derive(Debug, Parser)]
#[command(about)]
pub(crate) struct Args {
    /// Folder of the pictures.
    #[arg(value_name = "FOLDER", default_value = "out")]
    pub(crate) folder: PathBuf,
    /// Frames of the head: 16 numbers a line, column by column [default: a path made in code].
    #[arg(long, value_name = "FILE")]
    pub(crate) head: Option<PathBuf>,
    /// What draws the triangles, wgpu or software [default: wgpu where there is a device].
    #[arg(long, value_name = "NAME")]
    pub(crate) rasterizer: Option<String>,
    /// Size of the pair's pictures, each of an eye.
    #[arg(long, value_name = "WxH", default_value = "480x432", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Which variants are compared, beside the scalar one.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "scalar,packet4,packet8,packet16,wgsl",
        value_parser = variant
    )]
    pub(crate) variants: Vec<Variant>,
    /// Timed rounds of the comparison.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) runs: u16,
    /// Leave the frame times out.
    #[arg(long)]
    pub(crate) no_times: bool,
}
