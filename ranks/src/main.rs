//! Renders one picture, or some frames, by the ranks of an MPI run.

use std::process::ExitCode;

use clap::Parser;
use raydsl_ranks::args::Args;
use raydsl_ranks::{launch, run};

fn main() -> ExitCode {
    let args = Args::parse();
    let end = match args.ranks {
        Some(ranks) => launch::launch(ranks, &args).map_err(|e| e.to_string()),
        None => run::run(&args).map_err(|e| e.to_string()),
    };
    match end {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("raydsl-ranks: {e}");
            ExitCode::from(2)
        }
    }
}
