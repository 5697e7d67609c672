//! The command line.

use std::num::NonZeroU32;
use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use raydsl_examples::args::size;

/// Render by many machines: films of whole scenes, or frames of scenes that are divided in space.
#[derive(Clone, Debug, Parser)]
#[command(
    about,
    after_help = "Without --ranks this process is one rank of the MPI run that started \
it: `mpirun -n 64 raydsl-ranks --scene cornell`. A film that was cut short goes on with --resume."
)]
pub struct Args {
    /// Start so many ranks on this machine, by mpirun.
    #[arg(long, value_name = "N")]
    pub ranks: Option<NonZeroU32>,
    /// What is rendered.
    #[arg(long, value_enum, default_value = "cornell")]
    pub scene: SceneName,
    /// Picture size.
    #[arg(long, value_name = "WxH", default_value = "512x512", value_parser = size)]
    pub size: (u32, u32),
    /// Samples of each pixel of a film.
    #[arg(long, default_value = "256", value_parser = clap::value_parser!(u32).range(1..))]
    pub samples: u32,
    /// Which random numbers a film has.
    #[arg(long, default_value = "0")]
    pub seed: u32,
    /// Edge of the windows that a film is divided into, in pixels.
    #[arg(long, default_value = "64", value_parser = clap::value_parser!(u32).range(8..=4096))]
    pub tile: u32,
    /// Blocks of 64 samples that a rank takes of a window at once: a power of two.
    #[arg(long, default_value = "1", value_parser = power_of_two)]
    pub blocks: u32,
    /// Seconds between the films that are written so that a run can go on from them.
    #[arg(long, value_name = "SECONDS", default_value = "10")]
    pub every: u32,
    /// Frames of a scene that is divided in space, around it.
    #[arg(long, default_value = "8", value_parser = clap::value_parser!(u32).range(1..=9999))]
    pub frames: u32,
    /// Parts of space [default: one for each rank].
    #[arg(long, value_name = "N")]
    pub parts: Option<NonZeroU32>,
    /// Points of the landscape.
    #[arg(long, value_name = "N", default_value = "2000000", value_parser = clap::value_parser!(u32).range(1..))]
    pub points: u32,
    /// Voxels of the head along each axis.
    #[arg(long, value_name = "N", default_value = "192", value_parser = clap::value_parser!(u32).range(2..=4096))]
    pub voxels: u32,
    /// Transmittance below which a part of the head leaves out the rest of a ray.
    #[arg(long, value_name = "SHARE", default_value = "0.001", value_parser = share)]
    pub least: f32,
    /// Threads of each rank [default: the cores of the machine over its ranks].
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroU32>,
    /// Folder of the pictures, of report.json, and of the films so far.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Go on from the films or the frames so far.
    #[arg(long)]
    pub resume: bool,
    /// Print events for the process that started the ranks.
    #[arg(long, hide = true)]
    pub events: bool,
    /// Panic in a thread of this rank, for tests of runs that end so.
    #[arg(long, value_name = "RANK", hide = true)]
    pub panics: Option<u32>,
}

/// What is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SceneName {
    /// A film: the Cornell box, by path tracing.
    Cornell,
    /// A film: ambient occlusion of a pile of blocks.
    Ao,
    /// Frames: a landscape of points, divided in space.
    Points,
    /// Frames: a volume, divided in space.
    Volume,
}

impl SceneName {
    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cornell => "cornell",
            Self::Ao => "ao",
            Self::Points => "points",
            Self::Volume => "volume",
        }
    }
}

/// `16`. Blocks are summed in pairs, and pairs in pairs: only of powers of two is a part one sum.
///
/// # Errors
///
/// A text that is no power of two up to 2^20, with the remedy.
pub fn power_of_two(text: &str) -> Result<u32, String> {
    let number = text.parse().ok().filter(|n: &u32| n.is_power_of_two() && *n <= 1 << 20);
    number.ok_or_else(|| "write a power of two from 1 to 1048576, for example 16".to_owned())
}

/// `0.01`, or `0`.
fn share(text: &str) -> Result<f32, String> {
    let share = text.parse().ok().filter(|share: &f32| (0.0..1.0).contains(share));
    share.ok_or_else(|| "write a share from 0 to below 1, for example 0.001".to_owned())
}
