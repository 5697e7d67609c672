//! Compile time of kernels. Writes programs of a user of raydsl into a folder of its own, compiles
//! their dependencies, and then measures the CPU time of each program's own crate: rustc and its
//! linker, user and system time. Other programs change that less than the wall time; where they
//! share the cores it still grows, up to twice, so compare measurements taken at the same time.
//!
//! Rows with a copy's name are of programs that have the scalar function and this copy alone
//! (`RAYDSL_VARIANTS`, which the macros read); "over scalar" is what the copy costs. Where the
//! library's macros do not know the variable, these rows are left out, and the program says so.
//!
//! No network is needed: versions are those of the library's own `Cargo.lock`, which have been
//! fetched to build this program.

mod arithmetic;
mod cases;
mod project;
mod rows;
mod rustc;

use std::path::PathBuf;
use std::process::{Command, ExitCode};

use clap::Parser;

use cases::Case;
use rows::Rows;

/// Measures what programs with kernels cost to compile.
#[derive(Parser)]
struct Args {
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the cases whose names contain one of these words.
    #[arg(long)]
    case: Vec<String>,
    /// How often each is compiled; the table has the median.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// The workspace of the library, if it is not the one that this program belongs to.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/.."))]
    library: PathBuf,
    /// Counts rustc's instructions in place of seconds, by valgrind, in some 25 times the time: they
    /// are the same to a thousandth on a busy machine. The linker's are not counted.
    #[arg(long)]
    instructions: bool,
    /// Only `cargo check`, of every case: whether all of it compiles.
    #[arg(long)]
    quick: bool,
    /// Leaves the folder with the programs where it is.
    #[arg(long)]
    keep: bool,
    /// Names the cases.
    #[arg(long)]
    list: bool,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    if let Some(notes) = std::env::var_os(rustc::NOTES) {
        return rustc::run(notes.as_ref());
    }
    let args = Args::parse();
    let mut cases = cases::all();
    let has = |case: &Case, word: &String| case.name.contains(word.as_str());
    if let Some(word) = args.case.iter().find(|word| !cases.iter().any(|case| has(case, word))) {
        eprintln!("error: no case has `{word}` in its name; --list names them");
        return ExitCode::FAILURE;
    }
    cases.retain(|case| args.case.is_empty() || args.case.iter().any(|word| has(case, word)));
    if args.list {
        cases.iter().for_each(|case| println!("{}", case.name));
        return ExitCode::SUCCESS;
    }
    if args.instructions
        && let Err(error) = Command::new(rustc::VALGRIND).arg("--version").output()
    {
        eprintln!("error: --instructions needs {}, and it does not run: {error}", rustc::VALGRIND);
        return ExitCode::FAILURE;
    }
    if !rustc::HAS_CPU_TIME {
        eprintln!(
            "THIS SYSTEM DOES NOT SAY HOW LONG THE PROCESSORS WERE BUSY: only the time of day"
        );
        eprintln!("is measured, which depends on the number of cores and on what else runs.");
    }
    match measure(&args, &cases) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Measures the cases, and writes the rows, also those before an error.
fn measure(args: &Args, cases: &[Case]) -> Result<(), String> {
    let mut rows = Rows::new(&args.library, args.runs.into(), args.keep, args.instructions)?;
    let mut errors: u32 = 0;
    for case in cases {
        if let Err(error) = if args.quick { rows.check(case) } else { rows.measure(case) } {
            eprintln!("error: {}: {error}", case.name);
            errors += 1;
        }
    }
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(rows.rows()).expect("rows are plain data");
        std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    if errors > 0 { Err(format!("{errors} of {} cases failed", cases.len())) } else { Ok(()) }
}
