//! Error against run time of every method of the library, by every variant, where results are known.
//! Learn here how to measure a kernel of your own so.
//!
//! `cargo run --release --example report -- P-AO2` writes `work_precision.svg` and `.png`,
//! `points.csv`, `report.json`, `table.txt`, `errors.txt` and `omissions.md` to `out/report`; `all`
//! measures every case, each with its own knob, and writes a table `choice_FAMILY.txt` for each
//! family of cases; `list` names both. With `RAYDSL_DATA` set there are scenes from files.

mod args;
mod arithmetic;
mod builders;
mod cloud;
mod files;
mod filters;
#[path = "../bvh_cost/hall.rs"]
mod hall;
mod lamps;
mod light;
mod lines;
mod luneburg;
mod open;
mod paths;
mod quadrature;
mod registry;
mod strategies;
mod textured;
mod transmittance;
mod visibility;
mod volumes;

use std::error::Error;
use std::process::{Command, ExitCode};

use args::Args;
use clap::Parser;
use raydsl_examples::{cornell, lens};
use raydsl_report::work_precision::{Case, Method, WorkPrecision};
use registry::{Entry, entries};

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("report: {e}");
            ExitCode::from(2)
        }
    }
}

/// The cases that are asked for, and the names of others with why they are left out.
#[derive(Default)]
struct Chosen {
    cases: Vec<Case<'static>>,
    left_out: Vec<(String, String)>,
}

impl Chosen {
    /// One that is asked for by its name must be measured.
    fn of(args: &Args) -> Result<Self, Box<dyn Error>> {
        let asked = args.case.as_str();
        let is_asked_for = |e: &Entry| asked == "all" || [e.family, &e.name].contains(&asked);
        let mut chosen = Self::default();
        for entry in entries().into_iter().filter(is_asked_for) {
            let name = entry.name.clone();
            match case_of(entry, args) {
                Ok(case) => chosen.cases.push(case),
                Err(why) => chosen.left_out.push((name, why.to_string())),
            }
        }
        match (chosen.cases.is_empty(), &chosen.left_out[..]) {
            (true, []) => Err(format!("no case is `{asked}`; `list` names them").into()),
            (true, [(case, why), ..]) => Err(format!("case `{case}`: {why}").into()),
            _ => Ok(chosen),
        }
    }

    /// One list of values fits one knob.
    fn check_values(&self, args: &Args) -> Result<(), String> {
        let mut knobs: Vec<&str> = self.cases.iter().map(Case::knob_name).collect();
        knobs.sort_unstable();
        knobs.dedup();
        if args.values.is_empty() || knobs.len() == 1 {
            return Ok(());
        }
        Err(format!("`--values` with the knobs {}: choose one by `--knob`", knobs.join(", ")))
    }
}

/// The case, unless it has another knob, or other methods.
fn case_of(entry: Entry, args: &Args) -> Result<Case<'static>, Box<dyn Error>> {
    if let Some(knob) = args.knob.as_ref().filter(|k| **k != entry.knob) {
        return Err(format!("its knob is `{}`, not `{knob}`", entry.knob).into());
    }
    let case = (entry.make)()?;
    let is_chosen =
        |m: &Method| args.methods.is_empty() || args.methods.iter().any(|n| n == m.name());
    if case.methods().any(is_chosen) {
        return Ok(case);
    }
    let names: Vec<&str> = case.methods().map(Method::name).collect();
    Err(format!("none of the methods asked for is one of {}", names.join(", ")).into())
}

/// The names of all cases, by family, with their knobs.
fn list() -> String {
    let entries = entries();
    let mut text = "all, or a family, or one of its cases:\n".to_owned();
    for group in entries.chunk_by(|a, b| a.family == b.family && a.knob == b.knob) {
        let names: Vec<&str> = group.iter().map(|e| e.name.as_str()).collect();
        text += &format!("{} (knob {}): {}\n", group[0].family, group[0].knob, names.join(", "));
    }
    text
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    if args.case == "list" {
        print!("{}", list());
        return Ok(());
    }
    let chosen = Chosen::of(args)?;
    chosen.check_values(args)?;
    let Chosen { cases, left_out } = chosen;
    let mut settings = WorkPrecision::new();
    if let Some(commit) = args.commit.clone().or_else(commit) {
        settings = settings.commit(commit);
    }
    if !args.methods.is_empty() {
        let names: Vec<&str> = args.methods.iter().map(String::as_str).collect();
        settings = settings.methods(&names);
    }
    if !args.values.is_empty() {
        settings = settings.knobs(&args.values);
    }
    settings = left_out.into_iter().fold(settings, |all, (case, why)| all.omit(case, why));
    let report = settings
        .backends(&args.variants)
        .repetitions(args.repetitions)
        .time(args.time)
        .size(cloud::EDGE, cloud::EDGE)
        .progress(|what| eprintln!("{what}"))
        .run(&cases)?;
    let _plots = report.write(&args.out)?;
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
