//! Error against run time of random, stratified and Sobol samples, by every variant, on integrals
//! whose results are known. Learn here how to measure a kernel of your own so.
//!
//! `cargo run --release --example report -- P-AO2` writes `work_precision.svg` and `.png`,
//! `points.csv`, `report.json`, `table.txt`, `errors.txt` and `omissions.md` to `out/report`; `all`
//! measures every case, `list` names them.

mod args;
mod cloud;
mod light;
mod textured;
mod visibility;

use std::error::Error;
use std::process::{Command, ExitCode};

use args::Args;
use clap::Parser;
use raydsl::report::work_precision::{Case, WorkPrecision};
use raydsl_examples::raster::raster;

/// Of each pixel of each half of the cloud's reference: a second or two.
const CLOUD_SAMPLES: u32 = 16_384;

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("report: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    let mut cases: Vec<Case<'_>> =
        [visibility::cases(), light::cases(), textured::cases()].into_iter().flatten().collect();
    if args.case == "list" {
        let names: Vec<&str> = cases.iter().map(Case::name).chain(["cloud"]).collect();
        println!("cases: all, {}", names.join(", "));
        return Ok(());
    }
    cases.retain(|c| args.case == "all" || c.name() == args.case);
    if args.case == "all" || args.case == "cloud" {
        cases.push(cloud::case(CLOUD_SAMPLES)?);
    }
    if cases.is_empty() {
        return Err(format!("there is no case `{}`; `list` names them", args.case).into());
    }
    let methods: Vec<&str> = args.methods.iter().map(String::as_str).collect();
    let mut settings = WorkPrecision::new();
    if let Some(commit) = args.commit.clone().or_else(commit) {
        settings = settings.commit(commit);
    }
    let report = settings
        .knobs(&args.knob)
        .methods(&methods)
        .backends(&args.variants)
        .repetitions(args.repetitions)
        .time(args.time)
        .size(cloud::EDGE, cloud::EDGE)
        .progress(|what| eprintln!("{what}"))
        .run(&cases)?;
    let plots = report.write(&args.out)?;
    for (path, case) in plots.iter().zip(&report.cases) {
        raster(&case.plot(), 2).save(path.with_extension("png"))?;
    }
    println!("{}\n{}", report.table(), report.errors());
    println!("{}", args.out.display());
    Ok(())
}

/// The commit of the folder that this runs in, `-dirty` if files were changed since; none if there
/// is no git, or the folder is no clone.
fn commit() -> Option<String> {
    let asked = ["describe", "--always", "--dirty", "--exclude=*", "--abbrev=12"];
    let answer = Command::new("git").args(asked).output().ok()?;
    let name = String::from_utf8(answer.stdout).ok()?.trim().to_owned();
    (answer.status.success() && !name.is_empty()).then_some(name)
}
