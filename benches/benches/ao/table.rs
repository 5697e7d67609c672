//! What is printed and written.

use serde::Serialize;

use crate::rays::Workload;
use crate::rounds::{self, Record};
use crate::row::Row;

/// One mode of one row.
#[derive(Serialize)]
pub(crate) struct Line {
    scene: String,
    row: &'static str,
    system: &'static str,
    mode: String,
    isa: &'static str,
    lanes: usize,
    rays: usize,
    threads: usize,
    /// With what the system is charged for.
    mrays_per_s: f64,
    /// The middle half of the rounds' ratios, or rates where there are none, as a share.
    spread: f64,
    /// How much faster than the best mode of Embree.
    ratio_to_embree: Option<f64>,
    build_ms: f64,
    /// Of the tree; Embree's and obvhs's hold copies of the triangles too.
    bytes_per_primitive: f64,
    hits: usize,
    mean_t: Option<f64>,
    /// `ok`, `void` where the hits are others than Embree's, or `skipped`.
    pub(crate) status: &'static str,
}

/// The lines of the rows that are wanted, row by row, and of what others are charged with.
pub(crate) fn lines(
    scene: &str,
    threads: usize,
    work: &Workload,
    records: &[Record],
    only: &[Row],
) -> Vec<Line> {
    let wanted = Row::COMPARED.into_iter().filter(|row| is_wanted(only, *row));
    let mut all = Vec::new();
    for row in wanted.chain(Row::CHARGES) {
        let rays = rounds::rays(row, work);
        let of_row = records.iter().filter(|r| r.row == row);
        all.extend(of_row.map(|r| line(scene, threads, r, records, rays)));
        let has_rival = records.iter().any(|r| r.system == "embree" && r.row == row.rival());
        if !has_rival && !Row::CHARGES.contains(&row) {
            all.push(skipped(scene, threads, row, rays));
        }
    }
    all
}

/// Whether a row was asked for; all are if none is named.
pub(crate) fn is_wanted(only: &[Row], row: Row) -> bool {
    only.is_empty() || only.contains(&row)
}

fn line(scene: &str, threads: usize, r: &Record, records: &[Record], rays: usize) -> Line {
    let figures = rounds::figures(r, records, rays);
    Line {
        scene: scene.to_owned(),
        row: r.row.name(),
        system: r.system,
        mode: r.mode.clone(),
        isa: r.isa,
        lanes: r.lanes,
        rays,
        threads,
        mrays_per_s: figures.mrays_per_s,
        spread: figures.spread,
        ratio_to_embree: figures.ratio,
        build_ms: r.cost.build_ms,
        bytes_per_primitive: r.cost.bytes_per_primitive,
        hits: figures.hits,
        mean_t: figures.mean_t,
        status: if figures.is_ok { "ok" } else { "void" },
    }
}

fn skipped(scene: &str, threads: usize, row: Row, rays: usize) -> Line {
    Line {
        scene: scene.to_owned(),
        row: row.name(),
        system: "embree",
        mode: String::new(),
        isa: "embree",
        lanes: 0,
        rays,
        threads,
        mrays_per_s: 0.0,
        spread: 0.0,
        ratio_to_embree: None,
        build_ms: 0.0,
        bytes_per_primitive: 0.0,
        hits: 0,
        mean_t: None,
        status: "skipped",
    }
}

/// Prints the lines of a scene.
pub(crate) fn print(lines: &[Line]) {
    for of_row in lines.chunk_by(|a, b| a.row == b.row) {
        println!("{}, {} rays", of_row[0].row, of_row[0].rays);
        println!(
            "  {:<14}{:<20}{:>9}{:>9}{:>9}{:>9}{:>9}{:>11}  status",
            "system", "mode", "build ms", "B/prim", "Mrays/s", "ratio", "spread", "hits"
        );
        for l in of_row.iter().filter(|l| l.status != "skipped") {
            let ratio = l.ratio_to_embree.map_or("-".to_owned(), |r| format!("{r:.3}"));
            println!(
                "  {:<14}{:<20}{:>9.0}{:>9.1}{:>9.2}{ratio:>9}{:>8.1}%{:>11}  {}",
                l.system,
                l.mode,
                l.build_ms,
                l.bytes_per_primitive,
                l.mrays_per_s,
                100.0 * l.spread,
                l.hits,
                l.status
            );
        }
        println!();
    }
}

/// Prints the ratio of the library's best mode for each row and scene.
pub(crate) fn print_summary(lines: &[Line]) {
    println!("the library's best mode against Embree's");
    println!("  {:<14}{:>8}  {:<20}{:<16}{:>9}", "scene", "threads", "row", "mode", "ratio");
    for of_row in
        lines.chunk_by(|a, b| (a.row, &a.scene, a.threads) == (b.row, &b.scene, b.threads))
    {
        let own = of_row.iter().filter(|l| l.system == "raydsl" && l.status == "ok");
        let ratio = |l: &&Line| l.ratio_to_embree.unwrap_or_default();
        let best = own.max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
        if let Some(l) = best.filter(|l| l.ratio_to_embree.is_some()) {
            let (scene, threads, ratio) = (&l.scene, l.threads, ratio(&l));
            println!("  {scene:<14}{threads:>8}  {:<20}{:<16}{ratio:>9.3}", l.row, l.mode);
        }
    }
}
