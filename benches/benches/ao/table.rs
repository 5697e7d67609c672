//! From records to lines.

use raydsl_benches::table::Line;

use crate::rays::Workload;
use crate::rounds::{self, Record};
use crate::row::Row;

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
            all.push(skipped("embree", scene, threads, row, rays));
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
        ratio_to_robust: figures.robust_ratio,
        build_ms: r.cost.build_ms,
        bytes_per_primitive: r.cost.bytes_per_primitive,
        hits: figures.hits,
        mean_t: figures.mean_t,
        status: if figures.is_ok { "ok" } else { "void" },
    }
}

/// A scene that is not there has no figures.
pub(crate) fn without_scene<'a>(
    scene: &'a str,
    threads: usize,
    only: &'a [Row],
) -> impl Iterator<Item = Line> + 'a {
    let wanted = Row::COMPARED.into_iter().filter(|row| is_wanted(only, *row));
    wanted.map(move |row| skipped("raydsl", scene, threads, row, 0))
}

fn skipped(system: &'static str, scene: &str, threads: usize, row: Row, rays: usize) -> Line {
    Line {
        scene: scene.to_owned(),
        row: row.name(),
        system,
        mode: String::new(),
        isa: "",
        lanes: 0,
        rays,
        threads,
        mrays_per_s: 0.0,
        spread: 0.0,
        ratio_to_embree: None,
        ratio_to_robust: None,
        build_ms: 0.0,
        bytes_per_primitive: 0.0,
        hits: 0,
        mean_t: None,
        status: "skipped",
    }
}
