//! Frames of scenes that are divided in space: each rank has some parts and renders them, and the
//! fragments of all parts are composited.
//!
//! A frame has four phases. Each rank renders the window of the picture that each of its parts may
//! be in. It sends each other rank the fragments for that rank's strip of the picture, all at once
//! (direct send: Hsu, "Segmented Ray Casting for Data Parallel Volume Rendering", 1993). Each rank
//! composites its strip, and the root gathers the strips.

mod message;
mod points;
mod strips;
mod volume;
mod window;

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

use bytemuck::Pod;
use cpu_time::ProcessTime;
use glam::{UVec2, Vec3, uvec2};
use raydsl::prelude::{Image, Pinhole};
use raydsl::render::Display;
use rayon::prelude::*;

use self::message::Fragments;
use self::strips::Strips;
use super::args::{Args, SceneName};
use super::disk;
use super::progress::{Event, Teller};
use super::report::{RankReport, Report};
use super::run::Failure;
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

    /// Returns the bytes of the parts.
    fn bytes(&self) -> u64;
}

/// Renders the frames of a run, as the root or another rank.
pub(crate) fn run(wire: &Wire, args: &Args, threads: usize) -> Result<(), Failure> {
    let parts = args.parts.map_or(wire.size() as u32, |n| n.get());
    let own = own_parts(parts, wire);
    let job = Job { wire, args, parts, threads };
    match args.scene {
        SceneName::Volume => volume::with(args, parts, own, &mut |scene| job.run(scene)),
        _ => points::with(args, parts, own, &mut |scene| job.run(scene)),
    }
}

/// Returns the numbers of this rank's parts: neighbours, as evenly as it goes.
fn own_parts(parts: u32, wire: &Wire) -> Range<u32> {
    let (rank, ranks) = (wire.rank() as u64, wire.size() as u64);
    let first = |rank: u64| (u64::from(parts) * rank / ranks) as u32;
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
            first = frames_so_far(args, &self.description())?;
        }
        let messages: Vec<Vec<u8>> = match wire.rank() {
            ROOT => vec![first.to_le_bytes().to_vec(); wire.size()],
            _ => vec![Vec::new(); wire.size()],
        };
        let from_root = wire.exchange(&messages)?.swap_remove(ROOT);
        let bytes = from_root.try_into().map_err(|_| WireError::Damaged { from: ROOT })?;
        Ok(u32::from_le_bytes(bytes))
    }

    /// Returns what has an influence on frames.
    fn description(&self) -> String {
        let &Args { scene, size: (width, height), frames, points, voxels, least, .. } = self.args;
        let items = if scene == SceneName::Points { points } else { voxels };
        let scene = scene.name();
        format!("{scene} of {items}, {width}x{height}, {frames} frames, least {least}")
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
        let parts = scene.render(&camera, size, &mut clock.report.samples);
        clock.report.cpu_seconds += begin.elapsed().as_secs_f64();
        clock.next();
        clock.report.fragments += parts.iter().map(|(_, f)| f.len() as u64).sum::<u64>();
        let messages = message::encode(&strips, &parts);
        let received = wire.exchange(&messages)?;
        clock.next();
        let begin = ProcessTime::now();
        let strip = strips.of(wire.rank() as u32);
        let colors = composite(scene, &camera, size, &strip, &received)?;
        clock.report.composite_cpu_seconds += begin.elapsed().as_secs_f64();
        clock.next();
        let gathered = wire.gather(bytemuck::cast_slice(&colors))?;
        clock.next();

        let pixels = gathered.iter().flat_map(|bytes| bytemuck::pod_collect_to_vec(bytes));
        let mut pixels = pixels.collect::<Vec<Vec3>>().into_iter();
        let mut pixel = |_, _| pixels.next().unwrap_or(Vec3::NAN);
        Ok((wire.rank() == ROOT).then(|| Image::from_fn(size.x, size.y, &mut pixel)))
    }
}

/// Bands of a strip for each thread: some have more fragments than others.
const BANDS: usize = 8;

/// Composites a strip of the messages of all ranks, on all threads.
fn composite<S: Divided>(
    scene: &S,
    camera: &Pinhole,
    size: UVec2,
    strip: &Range<u32>,
    messages: &[Vec<u8>],
) -> Result<Vec<Vec3>, WireError> {
    let bands = strips::bands(strip, (BANDS * rayon::current_num_threads()) as u32);
    let colors = bands.into_par_iter().map(|band| {
        let mut fragments = Vec::new();
        for (from, bytes) in messages.iter().enumerate() {
            message::decode(bytes, strip, &band, &mut fragments)
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

/// The file with the description of a folder's frames.
const DESCRIPTION: &str = "frames.txt";

fn light_file(folder: &Path, frame: u32) -> PathBuf {
    folder.join(format!("frame_{frame:04}.pfm"))
}

/// Returns the number of frames that are there, if this run goes on from them; notes what they are.
fn frames_so_far(args: &Args, description: &str) -> Result<u32, Failure> {
    let note = args.out.join(DESCRIPTION);
    if args.resume
        && let Ok(found) = std::fs::read_to_string(&note)
    {
        if found != description {
            let (place, wanted) = (args.out.display().to_string(), description.to_owned());
            return Err(Failure::OtherFrames { place, found, wanted });
        }
        let is_there = |frame: &u32| light_file(&args.out, *frame).exists();
        return Ok((0..args.frames).take_while(is_there).count() as u32);
    }
    // Frames of before are none of this run, also if it is cut short and goes on.
    for frame in 0..args.frames {
        let _ = std::fs::remove_file(light_file(&args.out, frame));
    }
    disk::replace(&note, description.as_bytes())?;
    Ok(0)
}

/// Writes a frame: a picture to look at, then its light, by which the frame counts as finished.
fn write_pictures(folder: &Path, frame: u32, picture: &Image<Vec3>) -> Result<(), Failure> {
    let shown = Display::new().show(&picture.map(|p| p.extend(1.0)));
    shown.write_png(folder.join(format!("frame_{frame:04}.png")))?;
    disk::replace_by(&light_file(folder, frame), |path| picture.write_pfm(path))?;
    Ok(())
}
