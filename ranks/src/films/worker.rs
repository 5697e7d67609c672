//! Ranks that render what the root asks for.

use cpu_time::ProcessTime;

use super::{Job, PART, Render, UNIT, division};
use crate::report::RankReport;
use crate::run::Failure;
use crate::wire::{ROOT, Wire, WireError};

/// Renders parts until the root has no more.
pub(super) fn run(
    wire: &Wire,
    job: &Job,
    threads: usize,
    render: Render<'_>,
) -> Result<(), Failure> {
    let mut report = RankReport::new(threads);
    loop {
        let message = wire.receive(ROOT, UNIT);
        if message.is_empty() {
            break;
        }
        let extent = division::extent_of(job, &message).ok_or(WireError::Damaged { from: ROOT })?;
        let begin = ProcessTime::now();
        let part = render(&extent);
        report.cpu_seconds += begin.elapsed().as_secs_f64();
        report.samples += extent.total_samples();
        wire.send(ROOT, PART, &part.to_bytes())?;
    }
    report.collect(wire)?;
    Ok(())
}
