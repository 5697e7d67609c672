//! Whole runs, each of several processes that `mpirun` starts.

mod common;
mod deaths;
mod pictures;
