//! Measures the library at what is hard, row by row, and checks every bound that it promises.
//!
//! `cargo run --release -p raydsl-tests --bin campaign -- [--count 1e8] [--only NAME]`
//!
//! A row is a kernel, inputs made to break it, and an error of each result against `f64`, brute
//! force or a closed form. It runs in every variant; packets must also have the scalar variant's
//! bits. The table has the largest error of each, the bound, and the clause of the group that
//! promises it.

mod args;
mod gather;
mod groups;
mod json;
mod measure;
mod outcome;
mod row;
mod table;
mod timing;
mod visits;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use args::Args;
use clap::Parser;
use outcome::Outcome;
use row::{Group, Row};

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => {
            eprintln!("campaign: a bound does not hold, and is not known to");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("campaign: {error}");
            ExitCode::from(2)
        }
    }
}

/// What the rows of a group gave.
struct Measured {
    group: &'static Group,
    rows: Vec<(Row, Outcome)>,
}

/// Prints all tables and returns whether every bound holds.
fn run(args: &Args) -> Result<bool, Box<dyn Error>> {
    let mut all = Vec::new();
    for group in groups::ALL {
        let rows: Vec<Row> =
            (group.rows)().into_iter().filter(|row| args.wants(group.name, row)).collect();
        if rows.is_empty() {
            continue;
        }
        if args.list {
            rows.iter().for_each(|row| println!("{}", row.path(group)));
            continue;
        }
        all.push(measure_group(args, group, rows)?);
        // After each group, so that a run that is ended leaves what it has.
        write(args, &all)?;
    }
    if args.list {
        return Ok(true);
    }
    if all.is_empty() {
        return Err("no row has this name; --list names them".into());
    }
    let rows = || all.iter().flat_map(|measured| &measured.rows);
    let held = rows().filter(|(row, outcome)| row.holds(outcome)).count();
    let missed = rows().filter(|(row, outcome)| row.is_known_miss(outcome)).count();
    println!("{held} of {} rows hold, {missed} miss their bound as is known", rows().count());
    Ok(held + missed == rows().count())
}

/// Writes the files that are asked for.
fn write(args: &Args, all: &[Measured]) -> Result<(), Box<dyn Error>> {
    if let Some(path) = &args.json {
        std::fs::write(path, json::report(all)?)?;
    }
    if let Some(path) = &args.book {
        std::fs::write(path, table::markdown(all))?;
    }
    Ok(())
}

/// Measures and prints the rows of one group.
fn measure_group(
    args: &Args,
    group: &'static Group,
    rows: Vec<Row>,
) -> Result<Measured, Box<dyn Error>> {
    print!("{}", table::head(group));
    let mut measured = Measured { group, rows: Vec::with_capacity(rows.len()) };
    for row in rows {
        let start = Instant::now();
        let outcome = (row.measure)(&args.run(group, &row))
            .map_err(|error| format!("{}: {error}", row.path(group)))?;
        println!("{}", table::line(&row, &outcome));
        for example in row.examples(&outcome) {
            println!("{}", table::note(example));
        }
        if start.elapsed().as_secs() > 10 {
            eprintln!("{}: {:.0} s", row.path(group), start.elapsed().as_secs_f64());
        }
        measured.rows.push((row, outcome));
    }
    println!();
    Ok(measured)
}
