//! The command line.

use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use raydsl_examples::args::seconds;
use raydsl_report::work_precision::Backend;

/// Error against run time.
#[derive(Parser)]
pub(crate) struct Args {
    /// A case, a family of cases, `all`, or `list`.
    #[arg(default_value = "list")]
    pub(crate) case: String,
    /// Only cases with this knob: `spp`, samples of each pixel, `step`, steps along a ray, or another
    /// that `list` names.
    #[arg(long, value_name = "NAME")]
    pub(crate) knob: Option<String>,
    /// Values of the knob, rising; each case's own without this.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(crate) values: Vec<u32>,
    /// Methods, by name; all of each case without this. Cases that have none are left out.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(crate) methods: Vec<String>,
    /// Variants; the first is what speed-ups are over. `f64` is the reference machine.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "scalar,packet8,packet16,wgsl",
        value_parser = backend
    )]
    pub(crate) variants: Vec<Backend>,
    /// Runs of each point.
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub(crate) repetitions: u32,
    /// The time for each case, such as 30s.
    #[arg(long, default_value = "30s", value_parser = seconds)]
    pub(crate) time: Duration,
    /// The commit of the source, for the files. Without this git is asked.
    #[arg(long, value_name = "NAME")]
    pub(crate) commit: Option<String>,
    /// Folder of the results.
    #[arg(long, value_name = "DIR", default_value = "out/report")]
    pub(crate) out: PathBuf,
}

fn backend(name: &str) -> Result<Backend, String> {
    let names = Backend::ALL.map(Backend::name).join(", ");
    Backend::from_name(name).ok_or_else(|| format!("choose from {names}"))
}
