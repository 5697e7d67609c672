//! The command line.

use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use raydsl::report::work_precision::Backend;
use raydsl_examples::args::seconds;

/// Error against run time.
#[derive(Parser)]
pub(crate) struct Args {
    /// A case, `all`, or `list`.
    #[arg(default_value = "list")]
    pub(crate) case: String,
    /// Values of the knob: samples of each pixel.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "64,256,1024,4096")]
    pub(crate) knob: Vec<u32>,
    /// Methods.
    #[arg(long, value_delimiter = ',', default_value = "random,stratified,sobol")]
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
