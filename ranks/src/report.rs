//! What a run measured: `report.json`, and a line for people.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::args::Args;
use super::disk::{self, WriteError};
use super::wire::{Wire, WireError};

/// The figures of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The scene's name on the command line.
    pub scene: String,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// The time from the first unit of work to the last, in seconds, without that of building.
    pub seconds: f64,
    /// Frames that this run rendered; a film is one.
    pub frames: u32,
    /// Bytes that ranks sent to others, for a frame.
    pub bytes_per_frame: f64,
    /// Messages that ranks sent to others, for a frame.
    pub messages_per_frame: f64,
    /// Figures of a film.
    pub film: Option<FilmReport>,
    /// Figures of frames of a scene that is divided in space.
    pub divided: Option<DividedReport>,
    /// Each rank, in order.
    pub ranks: Vec<RankReport>,
}

/// Figures of a film.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FilmReport {
    /// Samples of each pixel.
    pub samples: u32,
    /// Edge of the windows.
    pub tile: u32,
    /// Blocks of samples of a unit of work.
    pub blocks: u32,
    /// The root's processor time for decoding and joining parts.
    pub root_seconds: f64,
    /// The time in which it wrote films so far.
    pub checkpoint_seconds: f64,
    /// Bytes of parts that came from other ranks.
    pub part_bytes: u64,
}

/// Figures of frames of a scene that is divided in space.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DividedReport {
    /// The parts of space.
    pub parts: u32,
    /// Fragments of rays in parts, for a frame.
    pub fragments_per_frame: f64,
    /// The time in which the slowest rank rendered, for all frames.
    pub render_seconds: f64,
    /// The time in which the slowest rank exchanged fragments.
    pub exchange_seconds: f64,
    /// The time in which the slowest rank composited them.
    pub composite_seconds: f64,
    /// The time in which the slowest rank gathered the picture.
    pub gather_seconds: f64,
    /// The processor time of all ranks for compositing.
    pub composite_cpu_seconds: f64,
}

/// Figures of a rank.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RankReport {
    /// Threads that rendered.
    pub threads: usize,
    /// Processor time of rendering, of all threads.
    pub cpu_seconds: f64,
    /// Processor time of compositing.
    pub composite_cpu_seconds: f64,
    /// Samples or rays that it rendered.
    pub samples: u64,
    /// Bytes that it sent to others.
    pub bytes: u64,
    /// Messages that it sent to others.
    pub messages: u64,
    /// Bytes of its part of the scene, those of trees too, where the scene is divided.
    pub scene_bytes: u64,
    /// The time of rendering, exchanging, compositing and gathering, where the scene is divided.
    pub phases: [f64; 4],
    /// Fragments that it sent, to itself too.
    pub fragments: u64,
}

impl RankReport {
    pub(crate) fn new(threads: usize) -> Self {
        Self { threads, ..Self::default() }
    }

    /// Sends it to the root, with what the rank has sent before; returns those of all ranks there.
    pub(crate) fn collect(self, wire: &Wire) -> Result<Vec<Self>, WireError> {
        let (bytes, messages) = wire.sent();
        let own = Self { bytes, messages, ..self };
        // Numbers and fixed names always have a text.
        let text = serde_json::to_vec(&own).unwrap_or_default();
        let texts = wire.gather(&text)?;
        let read = |(from, text): (usize, &Vec<u8>)| {
            serde_json::from_slice(text).map_err(|_| WireError::Damaged { from })
        };
        texts.iter().enumerate().map(read).collect()
    }
}

impl Report {
    fn of(args: &Args, seconds: f64, frames: u32, ranks: Vec<RankReport>) -> Self {
        let each = |n: fn(&RankReport) -> u64| {
            ranks.iter().map(n).sum::<u64>() as f64 / f64::from(frames.max(1))
        };
        Self {
            scene: args.scene.name().to_owned(),
            width: args.size.0,
            height: args.size.1,
            seconds,
            frames,
            bytes_per_frame: each(|rank| rank.bytes),
            messages_per_frame: each(|rank| rank.messages),
            film: None,
            divided: None,
            ranks,
        }
    }

    pub(crate) fn of_film(
        args: &Args,
        seconds: f64,
        film: FilmReport,
        ranks: Vec<RankReport>,
    ) -> Self {
        Self { film: Some(film), ..Self::of(args, seconds, 1, ranks) }
    }

    pub(crate) fn of_frames(
        args: &Args,
        seconds: f64,
        frames: u32,
        parts: u32,
        ranks: Vec<RankReport>,
    ) -> Self {
        let slowest = |i: usize| ranks.iter().map(|rank| rank.phases[i]).fold(0.0, f64::max);
        let fragments: u64 = ranks.iter().map(|rank| rank.fragments).sum();
        let divided = DividedReport {
            parts,
            fragments_per_frame: fragments as f64 / f64::from(frames.max(1)),
            render_seconds: slowest(0),
            exchange_seconds: slowest(1),
            composite_seconds: slowest(2),
            gather_seconds: slowest(3),
            composite_cpu_seconds: ranks.iter().map(|rank| rank.composite_cpu_seconds).sum(),
        };
        Self { divided: Some(divided), ..Self::of(args, seconds, frames, ranks) }
    }

    /// Returns samples or rays for each second of processor time: what other programs of the machine
    /// take does not count.
    pub fn rate_per_thread(&self) -> f64 {
        let samples: u64 = self.ranks.iter().map(|rank| rank.samples).sum();
        let seconds: f64 = self.ranks.iter().map(|rank| rank.cpu_seconds).sum();
        if seconds > 0.0 { samples as f64 / seconds } else { 0.0 }
    }

    /// Returns the figures in a line.
    pub(crate) fn summary(&self) -> String {
        let threads: usize = self.ranks.iter().map(|rank| rank.threads).sum();
        format!(
            "{}: {} ranks with {threads} threads, {:.2} s, {} frames, {:.0} bytes in {:.0} messages a frame",
            self.scene,
            self.ranks.len(),
            self.seconds,
            self.frames,
            self.bytes_per_frame,
            self.messages_per_frame,
        )
    }

    /// Writes `report.json`.
    pub(crate) fn write(&self, folder: &Path) -> Result<(), WriteError> {
        // Numbers and fixed names always have a text.
        let text = serde_json::to_string_pretty(self).unwrap_or_default();
        disk::replace(&folder.join("report.json"), text.as_bytes())
    }
}
