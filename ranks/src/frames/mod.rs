//! Frames of scenes that are divided in space: each rank has some parts and renders them, and the
//! fragments of all parts are composited.
//!
//! A frame has four phases. Each rank renders the window of the picture that each of its parts may
//! be in. It sends each other rank the fragments for that rank's strip of the picture, all at once
//! (direct send: Hsu, "Segmented Ray Casting for Data Parallel Volume Rendering", 1993). Each rank
//! composites its strip, and the root gathers the strips.

mod message;
mod points;
mod record;
mod strips;
mod volume;
mod window;

use std::ops::Range;
use std::path::Path;
use std::time::Instant;

use bytemuck::Pod;
use cpu_time::ProcessTime;
use glam::{UVec2, Vec3, uvec2};
use raydsl::prelude::{Image, Pinhole};
use rayon::prelude::*;

use self::message::{Fragments, Sent};
pub use self::record::RecordError;
use self::strips::Strips;
use super::args::{Args, SceneName};
use super::disk::{self, WriteError};
use super::progress::{Event, Teller};
use super::report::{RankReport, Report};
use super::run::{Failure, panic_if_asked};
use super::wire::{ROOT, Wire, WireError};

/// A rank's parts of a divided scene.
pub(crate) trait Divided: Sync {
    /// What a ray finds in a part.
    type Fragment: Pod + Send;

    /// Returns the camera of a frame, at this share of the way round the scene.
    fn camera(&self, share: f32) -> Pinhole;

    /// Renders the parts: for each its number, and what the rays of pixels find in it. Counts rays.
    fn render(
        &self,
        camera: &Pinhole,
        size: UVec2,
        rays: &mut u64,
    ) -> Vec<(u32, Fragments<Self::Fragment>)>;

    /// Returns the colours of a band's pixels, of fragments of all parts in any order: the part, the
    /// pixel of the picture, and what was found.
    fn composite(
        &self,
        camera: &Pinhole,
        size: UVec2,
        band: Range<u32>,
        fragments: Vec<(u32, u32, Self::Fragment)>,
    ) -> Vec<Vec3>;

    /// Returns the bytes of the parts, those of their trees too.
    fn bytes(&self) -> u64;
}

/// Renders the frames of a run, as the root or another rank.
pub(crate) fn run(wire: &Wire, args: &Args, threads: usize) -> Result<(), Failure> {
    let parts = args.parts.map_or(wire.size() as u32, |n| n.get());
    let own = own_parts(parts, wire.rank(), wire.size());
    let job = Job { wire, args, parts, threads };
    match args.scene {
        SceneName::Volume => volume::with(args, parts, own, &mut |scene| job.run(scene)),
        _ => points::with(args, parts, own, &mut |scene| job.run(scene)),
    }
}

/// Returns the numbers of a rank's parts: neighbours, as evenly as it goes.
fn own_parts(parts: u32, rank: usize, ranks: usize) -> Range<u32> {
    let first = |rank: usize| (u64::from(parts) * rank as u64 / ranks as u64) as u32;
    first(rank)..first(rank + 1)
}

/// A run of frames.
struct Job<'a> {
    wire: &'a Wire,
    args: &'a Args,
    parts: u32,
    threads: usize,
}

impl Job<'_> {
    /// Renders all frames that are not there yet.
    fn run<S: Divided>(&self, scene: &S) -> Result<(), Failure> {
        let Self { wire, args, .. } = *self;
        let is_root = wire.rank() == ROOT;
        let mut teller = is_root.then(|| Teller::new(args.events));
        let mut report = RankReport::new(self.threads);
        report.scene_bytes = scene.bytes();
        let first = self.first_frame()?;
        // The parts are there on all ranks: the time that is measured is that of frames.
        wire.barrier();
        let begin = Instant::now();
        for frame in first..args.frames {
            let picture = self.frame(scene, frame, &mut report)?;
            if let (Some(teller), Some(picture)) = (&mut teller, picture) {
                write_pictures(&args.out, frame, &picture)?;
                teller.tell(&Event::Done(f64::from(frame + 1) / f64::from(args.frames)));
            }
        }
        let seconds = begin.elapsed().as_secs_f64();
        let ranks = report.collect(wire)?;
        if let Some(mut teller) = teller {
            let frames = args.frames - first;
            let report = Report::of_frames(args, seconds, frames, self.parts, ranks);
            report.write(&args.out)?;
            teller.line(report.summary());
            teller.end();
        }
        Ok(())
    }

    /// Returns the first frame to render: the root looks which are there, and tells the others.
    fn first_frame(&self) -> Result<u32, Failure> {
        let Self { wire, args, .. } = *self;
        let mut first = 0;
        if wire.rank() == ROOT {
            disk::create_folder(&args.out)?;
            first = record::frames_so_far(args, &description(args, self.parts))?;
        }
        let messages: Vec<Vec<u8>> = match wire.rank() {
            ROOT => vec![first.to_le_bytes().to_vec(); wire.size()],
            _ => vec![Vec::new(); wire.size()],
        };
        let from_root = wire.exchange(&messages)?.swap_remove(ROOT);
        let first = from_root.try_into().ok().map(u32::from_le_bytes);
        Ok(first.filter(|first| *first <= args.frames).ok_or(WireError::Damaged { from: ROOT })?)
    }

    /// Renders a frame; the root gets the picture.
    fn frame<S: Divided>(
        &self,
        scene: &S,
        frame: u32,
        report: &mut RankReport,
    ) -> Result<Option<Image<Vec3>>, Failure> {
        let Self { wire, args, .. } = *self;
        let size = uvec2(args.size.0, args.size.1);
        let camera = scene.camera(frame as f32 / args.frames as f32);
        let strips = Strips::new(size, wire.size() as u32);
        let mut clock = Phases { report, begin: Instant::now(), phase: 0 };

        let begin = ProcessTime::now();
        panic_if_asked(args, wire.rank());
        let parts = scene.render(&camera, size, &mut clock.report.samples);
        clock.report.cpu_seconds += begin.elapsed().as_secs_f64();
        clock.next();
        clock.report.fragments += parts.iter().map(|(_, f)| f.len() as u64).sum::<u64>();
        let messages = message::encode(&strips, &parts);
        let received = wire.exchange(&messages)?;
        clock.next();
        let begin = ProcessTime::now();
        let strip = strips.of(wire.rank() as u32);
        let colors = composite(scene, &camera, size, &strip, self.parts, &received)?;
        clock.report.composite_cpu_seconds += begin.elapsed().as_secs_f64();
        clock.next();
        let gathered = wire.gather(bytemuck::cast_slice(&colors))?;
        clock.next();

        if wire.rank() != ROOT {
            return Ok(None);
        }
        Ok(Some(picture(size, &strips, &gathered)?))
    }
}

/// Returns what has an influence on frames. A point is the same in every division; the light of a
/// volume is rounded at the planes between its parts, and each part leaves out a share of its own.
fn description(args: &Args, parts: u32) -> String {
    let &Args { scene, size: (width, height), frames, points, voxels, least, .. } = args;
    let name = scene.name();
    let (items, division) = match scene {
        SceneName::Volume => (voxels, format!(", {parts} parts, least {least}")),
        _ => (points, String::new()),
    };
    format!("{name} of {items}, {width}x{height}, {frames} frames{division}")
}

/// Returns the picture of the strips of all ranks.
fn picture(size: UVec2, strips: &Strips, gathered: &[Vec<u8>]) -> Result<Image<Vec3>, WireError> {
    let mut pixels: Vec<Vec3> = Vec::new();
    for (from, bytes) in gathered.iter().enumerate() {
        // Of a strip of another length, all pixels behind it would be elsewhere.
        if bytes.len() != strips.of(from as u32).len() * size_of::<Vec3>() {
            return Err(WireError::Damaged { from });
        }
        pixels.extend(bytemuck::pod_collect_to_vec::<u8, Vec3>(bytes));
    }
    Ok(Image::from_fn(size.x, size.y, |x, y| pixels[y as usize * size.x as usize + x as usize]))
}

/// Bands of a strip for each thread: some have more fragments than others.
const BANDS: usize = 8;

/// Composites a strip of the messages of all ranks, on all threads.
fn composite<S: Divided>(
    scene: &S,
    camera: &Pinhole,
    size: UVec2,
    strip: &Range<u32>,
    parts: u32,
    messages: &[Vec<u8>],
) -> Result<Vec<Vec3>, WireError> {
    let bands = strips::bands(strip, (BANDS * rayon::current_num_threads()) as u32);
    let colors = bands.into_par_iter().map(|band| {
        let mut fragments = Vec::new();
        for (from, bytes) in messages.iter().enumerate() {
            let sent = Sent { parts: own_parts(parts, from, messages.len()), strip: strip.clone() };
            message::decode(bytes, &sent, &band, &mut fragments)
                .ok_or(WireError::Damaged { from })?;
        }
        Ok(scene.composite(camera, size, band, fragments))
    });
    Ok(colors.collect::<Result<Vec<_>, _>>()?.concat())
}

/// The time of the phases of a frame.
struct Phases<'a> {
    report: &'a mut RankReport,
    begin: Instant,
    phase: usize,
}

impl Phases<'_> {
    /// Ends a phase.
    fn next(&mut self) {
        self.report.phases[self.phase] += self.begin.elapsed().as_secs_f64();
        self.phase += 1;
        self.begin = Instant::now();
    }
}

/// Writes a frame: a picture to look at, then its light, by which the frame counts as finished.
fn write_pictures(folder: &Path, frame: u32, picture: &Image<Vec3>) -> Result<(), WriteError> {
    let shown = picture.map(|p| p.extend(1.0));
    disk::replace_png(&folder.join(format!("frame_{frame:04}.png")), &shown)?;
    disk::replace_by(&record::light_file(folder, frame), |path| picture.write_pfm(path))
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn each_part_is_of_one_rank() {
        for (parts, ranks) in [(1, 1), (7, 3), (2, 5)] {
            let all = (0..ranks).flat_map(|rank| own_parts(parts, rank, ranks));
            assert!(all.eq(0..parts), "{parts} of {ranks}");
        }
    }

    #[test]
    fn descriptions_have_what_changes_pixels() {
        let of =
            |line: &str, parts: u32| description(&Args::parse_from(line.split_whitespace()), parts);
        let points = "ranks --scene points --size 30x20 --frames 3 --points 500";
        assert_eq!(of(points, 2), "points of 500, 30x20, 3 frames");
        assert_eq!(of(&format!("{points} --least 0.1 --voxels 9"), 5), of(points, 2));
        let volume = "ranks --scene volume --size 30x20 --frames 3 --voxels 50 --least 0.1";
        assert_eq!(of(volume, 2), "volume of 50, 30x20, 3 frames, 2 parts, least 0.1");
        assert_ne!(of(volume, 5), of(volume, 2));
    }

    #[test]
    fn strips_of_other_lengths_are_refused() {
        let (size, ranks) = (uvec2(5, 3), 2);
        let strips = Strips::new(size, ranks);
        let color = |pixel: u32| Vec3::new(pixel as f32, 1.0, 2.0);
        let strip = |rank: u32| -> Vec<u8> {
            strips.of(rank).flat_map(|p| bytemuck::bytes_of(&color(p)).to_vec()).collect()
        };
        let strips_of_all = || vec![strip(0), strip(1)];
        let whole = picture(size, &strips, &strips_of_all()).expect("as ranks send them");
        assert_eq!(whole.pixels().last(), Some(&color(14)));
        for rank in 0..2 {
            let pixel = size_of::<Vec3>();
            for wrong in
                [Vec::new(), strip(rank)[pixel..].to_vec(), [&strip(rank)[..], &[0]].concat()]
            {
                let mut sent = strips_of_all();
                sent[rank as usize] = wrong;
                let refused = picture(size, &strips, &sent).err();
                assert_eq!(refused, Some(WireError::Damaged { from: rank as usize }));
            }
        }
    }
}
