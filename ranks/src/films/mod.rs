//! Films by many ranks: windows and ranges of samples, rendered anywhere, joined to the same bits.

mod assembly;
pub mod checkpoint;
mod division;
mod root;
mod worker;

use std::ops::Range;

use glam::{UVec2, uvec2};
use raydsl::render::{FilmExtent, FilmPart};

use super::args::Args;
use super::run::{Failure, panic_if_asked};
use super::scenes;
use super::wire::{ROOT, Wire};

/// The film that is rendered, and how it is divided.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Job {
    pub(crate) film: UVec2,
    pub(crate) samples: u32,
    /// The edge of a window.
    pub(crate) tile: u32,
    /// The blocks of samples that a rank takes of a window at once.
    pub(crate) blocks: u32,
    /// What has an influence on the bits of the film, and the windows that films so far have.
    pub(crate) description: String,
}

impl Job {
    pub(crate) fn of(args: &Args) -> Self {
        let &Args { size: (width, height), samples, tile, blocks, seed, .. } = args;
        let description = format!(
            "{} {width}x{height}, {samples} samples, seed {seed}, windows of {tile}",
            args.scene.name()
        );
        Self { film: uvec2(width, height), samples, tile, blocks, description }
    }

    /// Returns all samples.
    pub(crate) fn range(&self) -> Range<u32> {
        0..self.samples
    }
}

/// What renders a part of the film.
pub(crate) type Render<'a> = &'a (dyn Fn(&FilmExtent) -> FilmPart + Sync);

/// Messages from the root with a part to render, empty at the end; and those with a rendered part.
const UNIT: mpi::Tag = 1;
const PART: mpi::Tag = 2;

/// The parts that a rank has been given and has not sent back: it has the next one when it has
/// rendered one.
const AHEAD: usize = 2;

/// Renders the film of a run, as the root or another rank.
pub(crate) fn run(wire: &Wire, args: &Args, threads: usize) -> Result<(), Failure> {
    let job = Job::of(args);
    let rank = wire.rank();
    scenes::with_film(args, |render| {
        let render = |extent: &FilmExtent| {
            panic_if_asked(args, rank);
            render(extent)
        };
        if rank == ROOT {
            root::run(wire, args, &job, threads, &render)
        } else {
            worker::run(wire, &job, threads, &render)
        }
    })
}
