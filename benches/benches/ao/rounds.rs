//! Interleaved rounds, and what they say.

use raydsl_benches::clock::{median, spread};
use raydsl_benches::contest::{Cost, Outcome};

use crate::contender::Contender;
use crate::embree::{EMBREE, ROBUST};
use crate::rays::{SAMPLES, Workload};
use crate::row::Row;

/// What all rounds gave for a contender.
pub(crate) struct Record {
    pub(crate) row: Row,
    pub(crate) system: &'static str,
    pub(crate) mode: String,
    pub(crate) isa: &'static str,
    pub(crate) lanes: usize,
    pub(crate) cost: Cost,
    /// One for each round, with what the contender is charged for.
    seconds: Vec<f64>,
    outcome: Outcome,
}

/// The figures of a record.
pub(crate) struct Figures {
    pub(crate) mrays_per_s: f64,
    /// The middle half of the rounds' ratios, or rates where there are none, as a share.
    pub(crate) spread: f64,
    /// How much faster than the best mode of Embree: the median of the rounds' ratios.
    pub(crate) ratio: Option<f64>,
    /// The same with Embree's robust flag.
    pub(crate) robust_ratio: Option<f64>,
    pub(crate) hits: usize,
    pub(crate) mean_t: Option<f64>,
    pub(crate) is_ok: bool,
}

/// Runs every contender once a round: what the machine does meanwhile touches all alike. Then
/// charges those who were given their rays for the making of them.
pub(crate) fn run(contenders: &mut [Contender<'_>], rounds: usize) -> Vec<Record> {
    let record = |c: &Contender<'_>| Record {
        row: c.row,
        system: c.system,
        mode: c.mode.clone(),
        isa: c.isa,
        lanes: c.lanes,
        cost: c.cost,
        seconds: Vec::new(),
        outcome: Outcome::default(),
    };
    let mut records: Vec<Record> = contenders.iter().map(record).collect();
    // The first round warms up.
    for round in 0..=rounds {
        for (contender, record) in contenders.iter_mut().zip(&mut records) {
            record.outcome = (contender.run)();
            if round > 0 {
                record.seconds.push(record.outcome.seconds);
            }
        }
    }
    let frames = [EMBREE, ROBUST].map(|system| embree_frame(&records, system));
    charge(&mut records);
    records.extend(frames.into_iter().flatten());
    records
}

impl Record {
    /// Of a tree that was built once a round.
    pub(crate) fn of_build(
        system: &'static str,
        mode: String,
        cost: Cost,
        seconds: Vec<f64>,
    ) -> Self {
        let (row, isa, lanes, outcome) = (Row::Build, "", 0, Outcome::default());
        Self { row, system, mode, isa, lanes, cost, seconds, outcome }
    }
}

fn charge(records: &mut [Record]) {
    for row in Row::CHARGES {
        let Some(charge) = find(records, row).map(|record| record.seconds.clone()) else {
            continue;
        };
        let others = records.iter_mut().filter(|r| r.system != "raydsl");
        for record in others.filter(|r| r.row.charge() == Some(row)) {
            add(&mut record.seconds, &charge);
        }
    }
}

fn find(records: &[Record], row: Row) -> Option<&Record> {
    records.iter().find(|record| record.row == row)
}

fn add(seconds: &mut [f64], more: &[f64]) {
    for (seconds, more) in seconds.iter_mut().zip(more) {
        *seconds += more;
    }
}

/// The mode of Embree, with or without its robust flag, that has the least median time.
fn best_embree<'r>(records: &'r [Record], system: &str, row: Row) -> Option<&'r Record> {
    let modes = records.iter().filter(|r| r.system == system && r.row == row.rival());
    modes.min_by(|a, b| median(&a.seconds).total_cmp(&median(&b.seconds)))
}

/// A picture with Embree: its best modes for both kinds of rays, and making them as a frame does,
/// where what a camera ray meets is in registers when its shadow rays are made. Nobody has been
/// charged yet.
fn embree_frame(records: &[Record], system: &'static str) -> Option<Record> {
    let primary = best_embree(records, system, Row::Primary)?;
    let shadow = best_embree(records, system, Row::AoShort)?;
    let mut seconds = primary.seconds.clone();
    add(&mut seconds, &shadow.seconds);
    for row in [Row::PrimaryGeneration, Row::FrameGeneration] {
        add(&mut seconds, &find(records, row)?.seconds);
    }
    let hits = primary.outcome.hits + shadow.outcome.hits;
    Some(Record {
        row: Row::Frame,
        system,
        mode: "best of both".to_owned(),
        isa: shadow.isa,
        lanes: shadow.lanes,
        cost: shadow.cost,
        seconds,
        outcome: Outcome { seconds: 0.0, hits, distance: 0.0 },
    })
}

/// How the ratio of the library's frame to Embree's compares with that of camera rays and short
/// shadow rays, each in the best mode: well below 1, the scheduler loses time between them.
pub(crate) fn frame_over_parts(records: &[Record]) -> Option<f64> {
    let best = |system, row| {
        let modes = records.iter().filter(|r| r.system == system && r.row == row);
        modes.map(|r| median(&r.seconds)).min_by(f64::total_cmp)
    };
    let parts = |system| Some(best(system, Row::Primary)? + best(system, Row::AoShort)?);
    let frame = best("embree", Row::Frame)? / best("raydsl", Row::Frame)?;
    Some(frame / (parts("embree")? / parts("raydsl")?))
}

/// How many rays a row asks; of builds, how many primitives there are.
pub(crate) fn rays(row: Row, work: &Workload) -> usize {
    let shadow = work.places.len() * SAMPLES as usize;
    match row {
        Row::Frame => work.primary.len() + shadow,
        Row::Primary | Row::PrimaryGeneration | Row::FrameGeneration => work.primary.len(),
        Row::Build => work.primitives,
        Row::SingleClosest => work.single.len(),
        Row::AoShort | Row::AoUnbounded | Row::AoShortUnbatched | Row::Bounce | Row::Generation => {
            shadow
        }
    }
}

/// The figures of one of the records.
pub(crate) fn figures(record: &Record, records: &[Record], rays: usize) -> Figures {
    let embree = best_embree(records, EMBREE, record.row);
    let expected =
        embree.or_else(|| find(records, record.row)).map_or(record.outcome, |r| r.outcome);
    let rates: Vec<f64> = record.seconds.iter().map(|s| rays as f64 / s * 1e-6).collect();
    let ratios_to = |rival: &Record| -> Vec<f64> {
        rival.seconds.iter().zip(&record.seconds).map(|(a, b)| a / b).collect()
    };
    let ratios = embree.map(ratios_to);
    let robust_ratios = best_embree(records, ROBUST, record.row).map(ratios_to);
    Figures {
        mrays_per_s: median(&rates),
        spread: spread(ratios.as_ref().unwrap_or(&rates)),
        ratio: ratios.as_deref().map(median),
        robust_ratio: robust_ratios.as_deref().map(median),
        hits: record.outcome.hits,
        mean_t: record.outcome.mean(),
        is_ok: record.outcome.agrees(&expected, rays),
    }
}
