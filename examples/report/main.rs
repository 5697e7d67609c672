//! Error against run time of random, stratified and Sobol samples, by every variant, on integrals
//! whose results are known. Learn here how to measure a kernel of your own so.
//!
//! `cargo run --release --example report -- P-AO2` writes `work_precision.svg` and `.png`,
//! `points.csv`, `report.json`, `table.txt`, `errors.txt` and `omissions.md` to `out/report`; `all`
//! measures every case with a knob of samples, with `--knob step` every one with steps; `list`
//! names them. With `RAYDSL_DATA` set there are two scenes from files.

mod args;
mod cloud;
mod files;
mod light;
mod luneburg;
mod open;
mod paths;
mod quadrature;
mod textured;
mod visibility;
mod volumes;

use std::error::Error;
use std::process::{Command, ExitCode};

use args::{Args, Knob};
use clap::Parser;
use raydsl_examples::raster::raster;
use raydsl_examples::{cornell, lens};
use raydsl_report::work_precision::{Case, Method, WorkPrecision};

/// Of each pixel of each half of the cloud's reference: a second or two.
const CLOUD_SAMPLES: u32 = 16_384;
/// The same of scenes from files, whose every sample has two rays.
const FILE_SAMPLES: u32 = 4096;
/// Of paths, of several rays each.
const PATH_SAMPLES: u32 = 16_384;

/// How to make a case.
type Make = Box<dyn Fn() -> Result<Case<'static>, Box<dyn Error>>>;

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("report: {e}");
            ExitCode::from(2)
        }
    }
}

/// Those whose references take a while, by name; all have a knob of samples. They are made only if
/// they are measured.
fn slow_cases() -> [(&'static str, Make); 5] {
    let path = |name| -> Make { Box::new(move || paths::case(name, PATH_SAMPLES)) };
    let [cornell, plates] = paths::NAMES;
    [
        ("cloud", Box::new(|| cloud::case(CLOUD_SAMPLES))),
        ("scene", Box::new(|| open::case("scene", files::scene()?, FILE_SAMPLES))),
        ("scan", Box::new(|| open::case("scan", files::scan()?, FILE_SAMPLES))),
        (cornell, path(cornell)),
        (plates, path(plates)),
    ]
}

fn quick_cases() -> Vec<Case<'static>> {
    let last = vec![quadrature::case(), luneburg::case()];
    let all =
        [visibility::cases(), light::cases(), textured::cases(), last, volumes::cases(cloud::EDGE)];
    all.into_iter().flatten().collect()
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
        let is_asked_for = |name: &str| args.case == "all" || args.case == name;
        let mut chosen = Self::default();
        for case in quick_cases().into_iter().filter(|c| is_asked_for(c.name())) {
            chosen.add(args, case);
        }
        for (name, make) in slow_cases().into_iter().filter(|(name, _)| is_asked_for(name)) {
            if args.knob != Knob::Spp {
                chosen.left_out.push((name.to_owned(), without(args.knob, "spp")));
                continue;
            }
            match make() {
                Ok(case) => chosen.add(args, case),
                Err(why) => chosen.left_out.push((name.to_owned(), why.to_string())),
            }
        }
        match (chosen.cases.is_empty(), &chosen.left_out[..]) {
            (true, []) => Err(format!("no case is `{}`; `list` names them", args.case).into()),
            (true, [(case, why), ..]) => Err(format!("case `{case}`: {why}").into()),
            _ => Ok(chosen),
        }
    }

    /// Unless it has another knob, or other methods.
    fn add(&mut self, args: &Args, case: Case<'static>) {
        let is_chosen = |name: &str| args.methods.iter().any(|m| m == name);
        let why = if case.knob_name() != args.knob.name() {
            without(args.knob, case.knob_name())
        } else if !args.methods.is_empty() && !case.methods().any(|m| is_chosen(m.name())) {
            let names: Vec<&str> = case.methods().map(Method::name).collect();
            format!("none of the methods asked for is one of {}", names.join(", "))
        } else {
            self.cases.push(case);
            return;
        };
        self.left_out.push((case.name().to_owned(), why));
    }
}

fn without(asked_for: Knob, own: &str) -> String {
    format!("its knob is `{own}`, not `{}`", asked_for.name())
}

/// The names of all cases, by knob.
fn list() -> String {
    let quick = quick_cases();
    let of = |knob: Knob| {
        let has_it = |c: &&Case<'_>| c.knob_name() == knob.name();
        let names: Vec<&str> = quick.iter().filter(has_it).map(Case::name).collect();
        names.join(", ")
    };
    let slow = slow_cases().map(|(name, _)| name).join(", ");
    format!(
        "all, or one of\n--knob spp: {}, {slow}\n--knob step: {}",
        of(Knob::Spp),
        of(Knob::Step)
    )
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    if args.case == "list" {
        println!("{}", list());
        return Ok(());
    }
    let Chosen { cases, left_out } = Chosen::of(args)?;
    let mut settings = WorkPrecision::new();
    if let Some(commit) = args.commit.clone().or_else(commit) {
        settings = settings.commit(commit);
    }
    if !args.methods.is_empty() {
        let names: Vec<&str> = args.methods.iter().map(String::as_str).collect();
        settings = settings.methods(&names);
    }
    settings = left_out.into_iter().fold(settings, |all, (case, why)| all.omit(case, why));
    let report = settings
        .knobs(args.values())
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
