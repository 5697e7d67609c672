//! The root: hands out parts of the film, joins what comes back, and writes the films so far.

use std::collections::VecDeque;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use cpu_time::{ProcessTime, ThreadTime};
use raydsl::prelude::{Image, Vec4};
use raydsl::render::{FilmExtent, FilmPart, PartError};

use super::assembly::Assembly;
use super::checkpoint::{self, CheckpointError};
use super::division::{extent, message, ranges};
use super::{AHEAD, Job, PART, Render, UNIT};
use crate::args::Args;
use crate::disk::{self, WriteError};
use crate::progress::{Event, Teller};
use crate::report::{FilmReport, RankReport, Report};
use crate::run::Failure;
use crate::wire::{ROOT, Wire, WireError};

/// The time between looks for messages when there is nothing else to do.
const NAP: Duration = Duration::from_micros(200);

/// Renders the film, writes it as `film.pfm` and `film.png`, and the report.
pub(super) fn run(
    wire: &Wire,
    args: &Args,
    job: &Job,
    threads: usize,
    render: Render<'_>,
) -> Result<(), Failure> {
    let mut teller = Teller::new(args.events);
    disk::create_folder(&args.out)?;
    let mut assembly = so_far(args, job)?;
    if args.resume {
        teller.line(format!("{:.1} % are there already", 100.0 * assembly.share()));
    }
    let begin = Instant::now();
    let shared = thread::scope(|scope| {
        let (to_own, units) = channel();
        let (parts, from_own) = channel();
        scope.spawn(move || own_rank(&units, &parts, threads, render));
        let ranks = Ranks { wire, to_own, from_own };
        share_out(&ranks, args, job, &mut assembly, &mut teller)
    })?;
    let mut own = shared.own;
    own.threads = threads;
    let seconds = begin.elapsed().as_secs_f64();

    write_pictures(&args.out, &assembly)?;
    checkpoint::remove(&args.out)?;
    let ranks = own.collect(wire)?;
    let film = FilmReport {
        samples: job.samples,
        tile: job.tile,
        blocks: job.blocks,
        root_seconds: shared.root_seconds,
        checkpoint_seconds: shared.checkpoint_seconds,
        part_bytes: shared.part_bytes,
    };
    let report = Report::of_film(args, seconds, film, ranks);
    report.write(&args.out)?;
    teller.line(report.summary());
    teller.end();
    Ok(())
}

/// Returns the films so far, if this run goes on from them.
fn so_far(args: &Args, job: &Job) -> Result<Assembly, CheckpointError> {
    let mut assembly = Assembly::new(job);
    if args.resume {
        checkpoint::read(&args.out, job, &mut assembly)?;
    } else {
        checkpoint::refuse(&args.out)?;
    }
    Ok(assembly)
}

/// Renders in the root's process, beside the thread that speaks to the others.
fn own_rank(
    units: &Receiver<FilmExtent>,
    parts: &Sender<(FilmPart, RankReport)>,
    threads: usize,
    render: Render<'_>,
) {
    for extent in units {
        let mut report = RankReport::new(threads);
        let begin = ProcessTime::now();
        let part = render(&extent);
        report.cpu_seconds = begin.elapsed().as_secs_f64();
        report.samples = extent.total_samples();
        // The root has ended early where nobody takes it.
        if parts.send((part, report)).is_err() {
            return;
        }
    }
}

/// The parts that ranks have been given and have not sent back, in order.
struct Given(Vec<VecDeque<FilmExtent>>);

impl Given {
    fn note(&mut self, rank: usize, extent: FilmExtent) {
        self.0[rank].push_back(extent);
    }

    /// Notes that a part has come back: messages of one rank arrive in the order in which it sends
    /// them, so it must be the first. Any other would be missing from the film in the end.
    fn take(&mut self, rank: usize, part: &FilmPart) -> Result<(), WireError> {
        let first = self.0[rank].pop_front();
        if first.as_ref() == Some(part.extent()) {
            Ok(())
        } else {
            Err(WireError::Damaged { from: rank })
        }
    }

    fn is_empty(&self) -> bool {
        self.0.iter().all(VecDeque::is_empty)
    }
}

/// The ranks, as the root sees them: itself by channels, others by messages.
struct Ranks<'a> {
    wire: &'a Wire,
    to_own: Sender<FilmExtent>,
    from_own: Receiver<(FilmPart, RankReport)>,
}

impl Ranks<'_> {
    fn give(&self, rank: usize, extent: FilmExtent) -> Result<(), WireError> {
        if rank == ROOT {
            // It takes units as long as its sender is there.
            let _ = self.to_own.send(extent);
            return Ok(());
        }
        self.wire.send(rank, UNIT, &message(&extent))
    }
}

/// What the root counts.
struct Shared {
    own: RankReport,
    /// The processor time that the root needed to decode and join parts.
    root_seconds: f64,
    checkpoint_seconds: f64,
    /// The bytes of the parts that came by messages.
    part_bytes: u64,
}

/// Hands out what is missing, and joins what comes back, until the film is whole.
fn share_out(
    ranks: &Ranks<'_>,
    args: &Args,
    job: &Job,
    assembly: &mut Assembly,
    teller: &mut Teller,
) -> Result<Shared, Failure> {
    let mut units = units(job, assembly)?.into_iter();
    let mut given = Given(vec![VecDeque::new(); ranks.wire.size()]);
    let mut give_next = |rank: usize, given: &mut Given| -> Result<(), WireError> {
        let Some(extent) = units.next() else { return Ok(()) };
        given.note(rank, extent.clone());
        ranks.give(rank, extent)
    };
    for rank in (0..AHEAD).flat_map(|_| 0..ranks.wire.size()) {
        give_next(rank, &mut given)?;
    }
    let mut shared = Shared {
        own: RankReport::new(0),
        root_seconds: 0.0,
        checkpoint_seconds: 0.0,
        part_bytes: 0,
    };
    let every = Duration::from_secs(u64::from(args.every));
    let mut written = Instant::now();
    while !given.is_empty() {
        let Some((rank, part)) = next_part(ranks, &mut shared)? else {
            thread::sleep(NAP);
            continue;
        };
        given.take(rank, &part)?;
        // The next unit first: joining takes time.
        give_next(rank, &mut given)?;
        let begin = ThreadTime::now();
        assembly.add(part).map_err(|_| WireError::Damaged { from: rank })?;
        shared.root_seconds += begin.elapsed().as_secs_f64();
        teller.tell(&Event::Done(assembly.share()));
        if written.elapsed() >= every && !given.is_empty() {
            let begin = Instant::now();
            checkpoint::write(&args.out, job, assembly)?;
            write_shown(&args.out, &assembly.film()?.image())?;
            shared.checkpoint_seconds += begin.elapsed().as_secs_f64();
            written = Instant::now();
        }
    }
    for rank in (0..ranks.wire.size()).filter(|rank| *rank != ROOT) {
        ranks.wire.send(rank, UNIT, &[])?;
    }
    Ok(shared)
}

/// Returns what is missing, in parts for ranks: the first samples of all windows, then the next.
fn units(job: &Job, assembly: &Assembly) -> Result<Vec<FilmExtent>, PartError> {
    let mut units = Vec::new();
    for (window, missing) in assembly.missing() {
        for samples in ranges(job, &missing) {
            units.push(extent(job, window, samples)?);
        }
    }
    units.sort_by_key(|extent| extent.samples().start);
    Ok(units)
}

/// Returns a part that a rank has rendered, if there is one.
fn next_part(
    ranks: &Ranks<'_>,
    shared: &mut Shared,
) -> Result<Option<(usize, FilmPart)>, WireError> {
    if let Ok((part, report)) = ranks.from_own.try_recv() {
        shared.own.cpu_seconds += report.cpu_seconds;
        shared.own.samples += report.samples;
        return Ok(Some((ROOT, part)));
    }
    let Some((from, bytes)) = ranks.wire.try_receive(PART) else { return Ok(None) };
    let begin = ThreadTime::now();
    let part = FilmPart::from_bytes(&bytes).map_err(|_| WireError::Damaged { from })?;
    shared.root_seconds += begin.elapsed().as_secs_f64();
    shared.part_bytes += bytes.len() as u64;
    Ok(Some((from, part)))
}

/// Writes the film: its light as it is, and a picture to look at.
fn write_pictures(folder: &Path, assembly: &Assembly) -> Result<(), Failure> {
    // Each part came back as it was given, and what was given is all that was missing.
    debug_assert!(assembly.is_whole());
    let image = assembly.film()?.image();
    let light = image.map(|pixel| pixel.truncate());
    disk::replace_by(&folder.join("film.pfm"), |path| light.write_pfm(path))?;
    Ok(write_shown(folder, &image)?)
}

/// Writes the picture to look at.
fn write_shown(folder: &Path, image: &Image<Vec4>) -> Result<(), WriteError> {
    disk::replace_png(&folder.join("film.png"), image)
}

#[cfg(test)]
mod tests {
    use raydsl::prelude::*;

    use super::*;

    #[test]
    fn only_the_part_that_was_asked_for_is_taken() {
        let extent = |x: u32, samples| {
            FilmExtent::new(uvec2(20, 5), uvec2(x, 0), uvec2(10, 5), samples).expect("within")
        };
        let part = |extent: &FilmExtent| {
            let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
            let slope = kernel!(|ray: Ray| ray.direction.y);
            TiledScheduler::new().render_part(&camera, &slope, &Sampling::new(100), extent)
        };
        let damaged = Err(WireError::Damaged { from: 1 });
        let (first, next) = (extent(0, 0..64), extent(10, 0..64));
        let given = || {
            let mut given = Given(vec![VecDeque::new(); 2]);
            given.note(1, first.clone());
            given.note(1, next.clone());
            given
        };
        let mut all = given();
        assert_eq!(all.take(1, &part(&first)), Ok(()));
        assert!(!all.is_empty());
        assert_eq!(all.take(1, &part(&next)), Ok(()));
        assert!(all.is_empty());
        assert_eq!(all.take(1, &part(&next)), damaged, "none is awaited");
        for other in [next.clone(), extent(0, 64..100), extent(0, 0..50)] {
            assert_eq!(given().take(1, &part(&other)), damaged, "{other:?}");
        }
    }
}
