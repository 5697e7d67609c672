//! The command line.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use raydsl::kernel::Variant;
use raydsl_examples::args::{length, point, size, variant};

use super::transfer::Choice;

/// Render a scan as a volume, cut open, by every variant of one kernel.
#[derive(Debug, Parser)]
#[command(about, after_help = format!("{}\n\nWithout a FILE a head is made in code.", Choice::help()))]
pub(crate) struct Args {
    /// The scan: .nii, .nii.gz, .vti, .mha, .mhd, .nrrd.
    #[arg(value_name = "FILE")]
    pub(crate) file: Option<PathBuf>,
    #[arg(
        long,
        value_name = "NAME|FILE",
        default_value = "tissue",
        value_parser = Choice::parse,
        help = format!("Colours and opacities: {}", Choice::known())
    )]
    pub(crate) tf: Choice,
    /// Thickness of the layer that opacities are of, in the file's units [default: 1/200 of the
    /// scan's extent].
    #[arg(long, value_name = "D", value_parser = length)]
    pub(crate) unit: Option<f32>,
    /// What is cut away: sphere:X,Y,Z,R, plane:X,Y,Z,D (all p with n·p <= D), or mesh:FILE, in the
    /// file's units; with `!` before it, all but that. Several are cut one after another, but one
    /// plane at most on each side.
    #[arg(long, value_name = "CUT", allow_hyphen_values = true)]
    pub(crate) cut: Vec<String>,
    /// Cut nothing where no --cut is given.
    #[arg(long)]
    pub(crate) whole: bool,
    /// How light along a ray is computed [default: shaded-cell; labels with --tf labels; adaptive
    /// with --tol].
    #[arg(long, value_name = "NAME")]
    pub(crate) integrator: Option<Integrator>,
    /// Tolerance of the integrator `adaptive` [default: 0.001].
    #[arg(long, value_name = "X", value_parser = length)]
    pub(crate) tol: Option<f32>,
    /// Step of the integrators that take steps, in voxels.
    #[arg(long, value_name = "VOXELS", default_value = "0.5", value_parser = length)]
    pub(crate) step: f32,
    /// Only say how large the kernel's program is, beside one with all features.
    #[arg(long)]
    pub(crate) explain: bool,
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
    /// Direction from the middle to the camera [default: from the front, the left and above].
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) from: Option<[f64; 3]>,
}

/// Integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Integrator {
    Euler,
    ExponentialLeft,
    Midpoint,
    MeanExtinction,
    PreIntegrated,
    Adaptive,
    ExactCell,
    ShadedCell,
    Labels,
}

impl Args {
    pub(crate) fn integrator(&self) -> Integrator {
        let chosen = match (&self.tf, self.tol) {
            (Choice::Labels, _) => Integrator::Labels,
            (_, Some(_)) => Integrator::Adaptive,
            _ => Integrator::ShadedCell,
        };
        self.integrator.unwrap_or(chosen)
    }
}
