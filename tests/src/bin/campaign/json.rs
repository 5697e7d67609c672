//! The report for programs.

use serde::Serialize;

use crate::Measured;

#[derive(Serialize)]
struct Line<'a> {
    row: String,
    variant: &'a str,
    count: u64,
    /// Not a number of JSON where it is infinite: `null`.
    worst: f64,
    bound: f64,
    /// Of the worst figure and the bound.
    unit: &'static str,
    clause: &'a str,
    verdict: &'static str,
    /// Why the bound is known not to hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<&'static str>,
    /// How many results of packets have other bits than the scalar variant's.
    other_bits: u64,
}

pub(crate) fn report(all: &[Measured]) -> serde_json::Result<Vec<u8>> {
    let mut lines = Vec::new();
    for Measured { group, rows } in all {
        for (row, outcome) in rows {
            lines.extend(outcome.found.iter().map(|found| Line {
                row: row.path(group),
                variant: found.variant,
                count: found.count,
                worst: found.worst,
                bound: row.bound_of(found),
                unit: row.unit.name(),
                clause: group.clauses[row.clause - 1],
                verdict: match (row.keeps(found), row.is_known_miss(outcome)) {
                    (true, _) => "holds",
                    (false, true) => "misses",
                    (false, false) => "fails",
                },
                why: row.miss.as_ref().map(|miss| miss.why),
                other_bits: outcome.other_bits,
            }));
        }
    }
    serde_json::to_vec_pretty(&lines)
}
