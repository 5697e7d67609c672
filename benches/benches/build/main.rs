//! Building trees: how fast, and how good they are, beside what others build in the same rounds.

mod contender;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use raydsl_benches::clock::{median, spread};
use raydsl_benches::scenes;
use serde::Serialize;

use contender::{Contender, Tree, contenders};

/// Measures builders of trees over triangles.
#[derive(Parser)]
struct Args {
    /// Writes the rows to this file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Only the scenes whose names contain one of these words.
    #[arg(long)]
    scene: Vec<String>,
    /// Numbers of threads, each measured on its own.
    #[arg(long, value_delimiter = ',', default_value = "1,2",
          value_parser = clap::value_parser!(u16).range(1..))]
    threads: Vec<u16>,
    /// Rounds; each builds with every builder once.
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    /// Cargo says so.
    #[arg(long, hide = true)]
    bench: bool,
}

/// One builder on one scene.
#[derive(Serialize)]
struct Row {
    scene: &'static str,
    system: &'static str,
    builder: &'static str,
    threads: usize,
    mtris_per_s: f64,
    /// The middle half of the rounds' ratios to the first builder or of their rates, as a share.
    spread: f64,
    /// How much faster than the first builder of the table: the median of the rounds' ratios.
    speedup: f64,
    /// With the library's costs of a visit and of an intersection.
    sah_cost: Option<f64>,
    nodes: Option<usize>,
    bytes_per_primitive: Option<f64>,
    refit_mtris_per_s: Option<f64>,
    /// `ok`, or why there are no figures.
    status: String,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let mut rows = Vec::new();
    let mut scene = |name: &'static str, triangles: &[raydsl::prelude::Triangle]| {
        if args.scene.is_empty() || args.scene.iter().any(|word| name.contains(word.as_str())) {
            for &threads in &args.threads {
                rows.extend(measure(&args, name, triangles, threads.into()));
            }
        }
    };
    scene("colonnade", &scenes::colonnade().prims);
    scene("scatter", &scenes::scatter(200_000));
    match std::env::var_os("RAYDSL_DATA") {
        Some(data) => {
            for name in scenes::FILES {
                match scenes::file(data.as_ref(), name) {
                    Ok(read) => scene(name, &read.prims),
                    Err(error) => eprintln!("skipped {name}: {error}"),
                }
            }
        }
        None => eprintln!("skipped the scenes of RAYDSL_DATA, which names no folder"),
    }
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&rows).expect("rows are plain data");
        if let Err(error) = std::fs::write(path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    if rows.iter().all(|row| row.status == "ok") { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// What the rounds gave for one builder.
#[derive(Default)]
struct Record {
    seconds: Vec<f64>,
    refits: Vec<f64>,
    last: Option<Result<Tree, String>>,
}

/// Interleaved rounds: what the machine does meanwhile touches all builders alike.
fn measure(
    args: &Args,
    scene: &'static str,
    triangles: &[raydsl::prelude::Triangle],
    threads: usize,
) -> Vec<Row> {
    println!("{scene}: {} triangles, threads: {threads}", triangles.len());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.expect("threads can be started");
    let mut contenders = contenders(triangles, threads);
    let mut records: Vec<Record> = contenders.iter().map(|_| Record::default()).collect();
    // The first round warms up.
    for round in 0..=args.rounds {
        for (contender, record) in contenders.iter_mut().zip(&mut records) {
            let result = pool.install(|| (contender.build)());
            if let Ok(tree) = &result
                && round > 0
            {
                record.seconds.push(tree.seconds);
                record.refits.extend(tree.refit_seconds);
            }
            record.last = Some(result);
        }
    }
    let first = records[0].seconds.clone();
    let rows: Vec<Row> = contenders
        .iter()
        .zip(&records)
        .map(|(contender, record)| row(scene, triangles.len(), threads, contender, record, &first))
        .collect();
    print_rows(&rows);
    rows
}

fn row(
    scene: &'static str,
    triangles: usize,
    threads: usize,
    contender: &Contender<'_>,
    record: &Record,
    first: &[f64],
) -> Row {
    let tree = record.last.as_ref().and_then(|last| last.as_ref().ok());
    let status = match &record.last {
        Some(Err(why)) => why.clone(),
        _ => "ok".to_owned(),
    };
    let ratios: Vec<f64> = first.iter().zip(&record.seconds).map(|(a, b)| a / b).collect();
    let rates: Vec<f64> = record.seconds.iter().map(|s| 1.0 / s).collect();
    let rate = |seconds: &[f64]| triangles as f64 / median(seconds) * 1e-6;
    Row {
        scene,
        system: contender.system,
        builder: contender.builder,
        threads,
        mtris_per_s: if record.seconds.is_empty() { 0.0 } else { rate(&record.seconds) },
        spread: if rates.is_empty() { 0.0 } else { spread(&ratios).max(spread(&rates)) },
        speedup: median(&ratios),
        sah_cost: tree.and_then(|t| t.sah_cost),
        nodes: tree.and_then(|t| t.nodes),
        bytes_per_primitive: tree.and_then(|t| t.bytes).map(|b| b as f64 / triangles as f64),
        refit_mtris_per_s: (!record.refits.is_empty()).then(|| rate(&record.refits)),
        status,
    }
}

fn print_rows(rows: &[Row]) {
    let number = |x: Option<f64>| x.map_or("-".to_owned(), |x| format!("{x:.1}"));
    println!(
        "{:<8}{:<14}{:>9}{:>9}{:>8}{:>8}{:>10}{:>9}{:>9}  status",
        "system", "builder", "Mtris/s", "speedup", "spread", "SAH", "nodes", "B/tri", "refit/s"
    );
    for r in rows {
        println!(
            "{:<8}{:<14}{:>9.2}{:>8.2}x{:>7.1}%{:>8}{:>10}{:>9}{:>9}  {}",
            r.system,
            r.builder,
            r.mtris_per_s,
            r.speedup,
            100.0 * r.spread,
            number(r.sah_cost),
            r.nodes.map_or("-".to_owned(), |n| n.to_string()),
            number(r.bytes_per_primitive),
            number(r.refit_mtris_per_s),
            r.status
        );
    }
    println!();
}
