//! One rank of a run.

use std::io::{self, Write as _};

use mpi::Threading;
use mpi::traits::*;

use super::args::{Args, SceneName};
use super::divide::DivideError;
use super::films::checkpoint::CheckpointError;
use super::wire::{ROOT, Wire, WireError};
use super::{disk, films, frames};

/// Why a rank cannot go on, and the run with it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// MPI is there already, or cannot be called from one thread of several.
    #[error("MPI cannot be used beside threads: build Open MPI with MPI_THREAD_FUNNELED")]
    Mpi,
    /// The threads of this rank cannot be started.
    #[error("{0}: choose fewer --threads")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A message cannot be sent, or is damaged.
    #[error(transparent)]
    Wire(#[from] WireError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] disk::WriteError),
    /// The films so far cannot be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// Parts of a film do not belong together.
    #[error(transparent)]
    Part(#[from] raydsl::render::PartError),
    /// Space cannot be divided so.
    #[error(transparent)]
    Divide(#[from] DivideError),
    /// A scene cannot be built.
    #[error(transparent)]
    Build(#[from] raydsl::error::BuildError),
    /// Lights cannot be joined.
    #[error(transparent)]
    Lights(#[from] raydsl::light::LightsError),
    /// A grid is too large, or has no voxels.
    #[error(transparent)]
    Grid(#[from] raydsl::volume::GridError),
    /// A transfer function is not one.
    #[error(transparent)]
    Transfer(#[from] raydsl::volume::TransferError),
    /// The frames so far cannot be used.
    #[error(transparent)]
    Record(#[from] frames::RecordError),
}

/// The exit code of a rank that has told an error.
pub(crate) const TOLD: i32 = 2;

/// The exit code of a panic, as that of Rust's own programs.
const PANICKED: i32 = 101;

/// The exit code of a rank whose launcher has ended.
const LEFT: i32 = 3;

/// Runs this process as one rank of the MPI run that started it, until the pictures are there.
///
/// # Errors
///
/// If MPI cannot be used. Any later error is told on the terminal, and ends all ranks at once: the
/// others may wait for this one.
pub fn run(args: &Args) -> Result<(), Failure> {
    end_by_panics();
    let mpi = mpi::initialize_with_threading(Threading::Funneled);
    let (universe, level) = mpi.ok_or(Failure::Mpi)?;
    if level < Threading::Funneled {
        return Err(Failure::Mpi);
    }
    let wire = Wire::new(universe.world());
    if args.events && wire.rank() == ROOT {
        end_with_launcher();
    }
    let end = start_threads(args, wire.neighbours()).and_then(|threads| match args.scene {
        SceneName::Cornell | SceneName::Ao => films::run(&wire, args, threads),
        SceneName::Points | SceneName::Volume => frames::run(&wire, args, threads),
    });
    if let Err(error) = end {
        eprintln!("raydsl-ranks: rank {}: {error}", wire.rank());
        universe.world().abort(TOLD);
    }
    Ok(())
}

/// Has a panic of any thread end the process: unwinding would wait for the other ranks, which wait
/// for this one. `mpirun` then ends them.
fn end_by_panics() {
    let tell = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        tell(info);
        std::process::exit(PANICKED);
    }));
}

/// Has the root end with the process that started the ranks, and `mpirun` then the others: else they
/// would render for nobody. The launcher keeps the root's standard input open as long as it lives.
fn end_with_launcher() {
    std::thread::spawn(|| {
        let _ = io::copy(&mut io::stdin(), &mut io::sink());
        // The terminal may have gone with it.
        let _ = writeln!(io::stderr(), "raydsl-ranks: the launcher has ended, and the run with it");
        std::process::exit(LEFT);
    });
}

/// Panics in a thread that renders, where a test asks for it.
pub(crate) fn panic_if_asked(args: &Args, rank: usize) {
    if args.panics.is_some_and(|asked| asked as usize == rank) {
        rayon::scope(|scope| scope.spawn(|_| panic!("as --panics asks for")));
    }
}

/// Starts the threads that render, and returns their number. `ranks` share this machine.
fn start_threads(args: &Args, ranks: usize) -> Result<usize, Failure> {
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let threads = args.threads.map_or((cores / ranks).max(1), |n| n.get() as usize);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    Ok(threads)
}
