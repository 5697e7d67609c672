//! The command line.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use raydsl::kernel::Variant;
use raydsl_examples::args::{length, point, size, variant};

use super::transfer::Choice;

/// Render a field on an unstructured grid as a volume, as a surface of one value, or both, by every
/// variant of one kernel.
#[derive(Debug, Parser)]
#[command(
    about,
    after_help = format!(
        "{}\n\nWithout a FILE a grid of hexahedra around a cylinder is made in code.",
        Choice::help()
    )
)]
pub(crate) struct Args {
    /// The grid: .vtu.
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    /// The array that is shown, of points or of cells; of a vector, its length [default: the active
    /// scalars].
    #[arg(long, value_name = "NAME")]
    pub(crate) array: Option<String>,
    #[arg(
        long,
        value_name = "NAME|FILE",
        default_value = "inferno",
        value_parser = Choice::parse,
        help = format!("Colours and opacities: {}", Choice::known())
    )]
    pub(crate) tf: Choice,
    /// Thickness of the layer that opacities are of, in the file's units [default: 1/20 of the
    /// grid's extent].
    #[arg(long, value_name = "D", value_parser = length)]
    pub(crate) unit: Option<f32>,
    /// Show the surface of this value, behind which nothing is seen.
    #[arg(long, value_name = "V", allow_negative_numbers = true)]
    pub(crate) iso: Option<f32>,
    /// What is cut away: sphere:X,Y,Z,R, plane:X,Y,Z,D (all p with n·p <= D), or mesh:FILE, in the
    /// file's units; with `!` before it, all but that. Several are cut one after another.
    #[arg(long, value_name = "CUT", allow_hyphen_values = true)]
    pub(crate) cut: Vec<String>,
    /// Cut nothing where no --cut is given.
    #[arg(long)]
    pub(crate) whole: bool,
    /// How light along a ray is computed.
    #[arg(long, value_name = "NAME", default_value = "shaded-cell")]
    pub(crate) integrator: Integrator,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "960x960", value_parser = size)]
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
    /// Time a box of so many cells along each axis instead, as cells and as a structured grid.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=200))]
    pub(crate) beside: Option<u32>,
    /// Direction from the middle to the camera [default: from the front, the left and above].
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) from: Option<[f64; 3]>,
}

/// Integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Integrator {
    ExactCell,
    ShadedCell,
}
