//! Figures of systems beside each other: what is printed and written.

use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;

/// One mode of one row.
#[derive(Serialize)]
pub struct Line {
    /// The name of the scene.
    pub scene: String,
    /// What was asked.
    pub row: &'static str,
    /// Who was asked.
    pub system: &'static str,
    /// How.
    pub mode: String,
    /// The instructions, where the program knows.
    pub isa: &'static str,
    /// Rays at once.
    pub lanes: usize,
    /// Rays in all; of trees that are built, primitives.
    pub rays: usize,
    /// Threads.
    pub threads: usize,
    /// Millions of them a second, with what the system is charged for.
    pub mrays_per_s: f64,
    /// The middle half of the rounds' ratios, or rates where there are none, as a share.
    pub spread: f64,
    /// How much faster than the best mode of Embree.
    pub ratio_to_embree: Option<f64>,
    /// How much faster than the best mode of Embree with its robust flag, where that is measured.
    pub ratio_to_robust: Option<f64>,
    /// Milliseconds that the tree took.
    pub build_ms: f64,
    /// Of the tree; Embree's and obvhs's hold copies of the primitives too.
    pub bytes_per_primitive: f64,
    /// Rays that met something.
    pub hits: usize,
    /// How far away, if that was asked.
    pub mean_t: Option<f64>,
    /// `ok`, `void` where the hits are others than Embree's, or `skipped`.
    pub status: &'static str,
}

/// Prints the lines of a scene.
pub fn print(lines: &[Line]) {
    let has_robust = lines.iter().any(|l| l.ratio_to_robust.is_some());
    for of_row in lines.chunk_by(|a, b| a.row == b.row) {
        println!("{}: {}", of_row[0].row, of_row[0].rays);
        println!(
            "  {:<14}{:<24}{:>8}{:>7}{:>8}{:>7}{}{:>7}{:>9}  status",
            "system",
            "mode",
            "build ms",
            "B/prim",
            "M/s",
            "ratio",
            if has_robust { " robust" } else { "" },
            "spread",
            "hits"
        );
        for l in of_row.iter().filter(|l| l.status != "skipped") {
            let robust = if has_robust { shown(l.ratio_to_robust) } else { String::new() };
            println!(
                "  {:<14}{:<24}{:>8.0}{:>7.1}{:>8.3}{}{robust}{:>6.1}%{:>9}  {}",
                l.system,
                l.mode,
                l.build_ms,
                l.bytes_per_primitive,
                l.mrays_per_s,
                shown(l.ratio_to_embree),
                100.0 * l.spread,
                l.hits,
                l.status
            );
        }
        println!();
    }
}

/// A ratio in a column of seven letters.
fn shown(ratio: Option<f64>) -> String {
    format!("{:>7}", ratio.map_or("-".to_owned(), |r| format!("{r:.3}")))
}

/// Prints the summary of all lines and writes them to a file; fails if nothing was
/// measured, or a line is void.
pub fn finish(lines: &[Line], json: Option<&Path>) -> ExitCode {
    print_summary(lines);
    if let Some(path) = json {
        let text = serde_json::to_string_pretty(lines).expect("lines are plain data");
        if let Err(error) = std::fs::write(path, text) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    let is_void = lines.iter().any(|line| line.status == "void");
    let is_void = is_void || lines.iter().all(|line| line.status == "skipped");
    if is_void { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// Prints the library's best mode for each row and scene beside Embree's.
fn print_summary(lines: &[Line]) {
    let has_robust = lines.iter().any(|l| l.ratio_to_robust.is_some());
    println!("the library's best mode against Embree's, millions of rays a second");
    println!(
        "  {:<13}{:>2} {:<19}{:<24}{:>8}{:>8}{:>7}{}",
        "scene",
        "th",
        "row",
        "mode",
        "raydsl",
        "Embree",
        "ratio",
        if has_robust { " robust" } else { "" }
    );
    for of_row in
        lines.chunk_by(|a, b| (a.row, &a.scene, a.threads) == (b.row, &b.scene, b.threads))
    {
        let own = of_row.iter().filter(|l| l.system == "raydsl" && l.status == "ok");
        let ratio = |l: &&Line| l.ratio_to_embree.unwrap_or_default();
        let best = own.max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        if let Some(l) = best.filter(|l| l.ratio_to_embree.is_some()) {
            let theirs = of_row.iter().filter(|l| l.system == "embree");
            let rate = theirs.map(|l| l.mrays_per_s).fold(0.0, f64::max);
            let robust = if has_robust { shown(l.ratio_to_robust) } else { String::new() };
            println!(
                "  {:<13}{:>2} {:<19}{:<24}{:>8.3}{rate:>8.3}{}{robust}",
                l.scene,
                l.threads,
                l.row,
                l.mode,
                l.mrays_per_s,
                shown(l.ratio_to_embree)
            );
        }
    }
}
