//! Messages between ranks, and how many bytes they have.

use std::cell::Cell;

use mpi::datatype::PartitionMut;
use mpi::request::WaitGuard;
use mpi::topology::SimpleCommunicator;
use mpi::traits::*;
use mpi::{Count, Rank, Tag};

/// The rank that collects pictures.
pub(crate) const ROOT: usize = 0;

/// Messages of [`Wire::exchange`].
const EXCHANGE: Tag = 3;

/// Why a message cannot be sent, or be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WireError {
    /// MPI counts bytes in 31 bits.
    #[error(
        "a message of {bytes} bytes is longer than MPI's 2 GiB: render smaller pictures or windows"
    )]
    TooLong {
        /// Its length.
        bytes: usize,
    },
    /// A message is not what its sender writes.
    #[error("rank {from} sent a damaged message: do all ranks run the same program?")]
    Damaged {
        /// The sender.
        from: usize,
    },
}

/// The messages of one rank to the others.
pub(crate) struct Wire {
    world: SimpleCommunicator,
    bytes: Cell<u64>,
    messages: Cell<u64>,
}

impl Wire {
    pub(crate) fn new(world: SimpleCommunicator) -> Self {
        Self { world, bytes: Cell::new(0), messages: Cell::new(0) }
    }

    /// Returns the index of this rank.
    pub(crate) fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    /// Returns the number of ranks.
    pub(crate) fn size(&self) -> usize {
        self.world.size() as usize
    }

    /// Returns the number of ranks on this one's machine. All ranks must ask.
    pub(crate) fn neighbours(&self) -> usize {
        self.world.split_shared(0).size() as usize
    }

    /// Returns the numbers of bytes and of messages that this rank has sent to others.
    pub(crate) fn sent(&self) -> (u64, u64) {
        (self.bytes.get(), self.messages.get())
    }

    fn count(&self, to: usize, bytes: usize) {
        if to != self.rank() && bytes > 0 {
            self.bytes.set(self.bytes.get() + bytes as u64);
            self.messages.set(self.messages.get() + 1);
        }
    }

    /// Sends bytes to a rank, and returns once they may be changed.
    pub(crate) fn send(&self, to: usize, tag: Tag, bytes: &[u8]) -> Result<(), WireError> {
        length(bytes.len())?;
        self.count(to, bytes.len());
        self.world.process_at_rank(to as Rank).send_with_tag(bytes, tag);
        Ok(())
    }

    /// Waits for a message of a rank.
    pub(crate) fn receive(&self, from: usize, tag: Tag) -> Vec<u8> {
        self.world.process_at_rank(from as Rank).receive_vec_with_tag(tag).0
    }

    /// Returns a message of any rank and its sender, if one has arrived.
    pub(crate) fn try_receive(&self, tag: Tag) -> Option<(usize, Vec<u8>)> {
        let (message, status) = self.world.any_process().immediate_matched_probe_with_tag(tag)?;
        let mut bytes = vec![0u8; status.count(u8::equivalent_datatype()) as usize];
        message.matched_receive_into(&mut bytes[..]);
        Some((status.source_rank() as usize, bytes))
    }

    /// Sends each rank its bytes, and returns those of each for this one.
    ///
    /// The messages are those of ranks to each other: Open MPI's `MPI_Alltoallv` of version 4.1 fails
    /// where a rank has nothing to send.
    pub(crate) fn exchange(&self, to_ranks: &[Vec<u8>]) -> Result<Vec<Vec<u8>>, WireError> {
        let lengths: Vec<u64> = to_ranks.iter().map(|bytes| bytes.len() as u64).collect();
        let mut expected = vec![0u64; self.size()];
        self.world.all_to_all_into(&lengths[..], &mut expected[..]);
        for bytes in lengths.iter().chain(&expected) {
            length(usize::try_from(*bytes).unwrap_or(usize::MAX))?;
        }
        let own = self.rank();
        let mut received: Vec<Vec<u8>> = expected.iter().map(|n| vec![0; *n as usize]).collect();
        received[own].clone_from(&to_ranks[own]);
        let is_message = |rank: usize, bytes: &[u8]| rank != own && !bytes.is_empty();
        mpi::request::scope(|scope| {
            let mut waits = Vec::new();
            for (from, bytes) in received.iter_mut().enumerate() {
                if is_message(from, bytes) {
                    let process = self.world.process_at_rank(from as Rank);
                    let receive =
                        process.immediate_receive_into_with_tag(scope, &mut bytes[..], EXCHANGE);
                    waits.push(WaitGuard::from(receive));
                }
            }
            for (to, bytes) in to_ranks.iter().enumerate() {
                if is_message(to, bytes) {
                    self.count(to, bytes.len());
                    let process = self.world.process_at_rank(to as Rank);
                    let send = process.immediate_send_with_tag(scope, &bytes[..], EXCHANGE);
                    waits.push(WaitGuard::from(send));
                }
            }
            // Each waits when it is dropped.
        });
        Ok(received)
    }

    /// Sends bytes to the root, which returns those of all ranks in order; others return nothing.
    pub(crate) fn gather(&self, bytes: &[u8]) -> Result<Vec<Vec<u8>>, WireError> {
        length(bytes.len())?;
        self.count(ROOT, bytes.len());
        let root = self.world.process_at_rank(ROOT as Rank);
        if self.rank() != ROOT {
            root.gather_into(&(bytes.len() as u64));
            root.gather_varcount_into(bytes);
            return Ok(Vec::new());
        }
        let mut lengths = vec![0u64; self.size()];
        root.gather_into_root(&(bytes.len() as u64), &mut lengths[..]);
        let (counts, starts) = layout(&lengths)?;
        let mut received = vec![0; lengths.iter().sum::<u64>() as usize];
        let mut parts = PartitionMut::new(&mut received[..], counts, &starts[..]);
        root.gather_varcount_into_root(bytes, &mut parts);
        Ok(divided(&received, &lengths))
    }

    /// Waits until all ranks wait.
    pub(crate) fn barrier(&self) {
        self.world.barrier();
    }
}

fn length(bytes: usize) -> Result<Count, WireError> {
    Count::try_from(bytes).map_err(|_| WireError::TooLong { bytes })
}

/// Returns the counts of messages side by side, and where they begin.
fn layout(lengths: &[u64]) -> Result<(Vec<Count>, Vec<Count>), WireError> {
    let (mut counts, mut starts, mut start) = (Vec::new(), Vec::new(), 0usize);
    for bytes in lengths {
        let bytes = usize::try_from(*bytes).unwrap_or(usize::MAX);
        counts.push(length(bytes)?);
        starts.push(length(start)?);
        start = start.saturating_add(bytes);
    }
    length(start)?;
    Ok((counts, starts))
}

fn divided(mut bytes: &[u8], lengths: &[u64]) -> Vec<Vec<u8>> {
    let mut parts = Vec::with_capacity(lengths.len());
    for length in lengths {
        let (part, rest) = bytes.split_at(*length as usize);
        parts.push(part.to_vec());
        bytes = rest;
    }
    parts
}
