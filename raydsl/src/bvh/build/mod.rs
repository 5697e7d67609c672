//! Binary tree builder.
//!
//! [`build`] makes a [`Tree`] over any primitives with bounds, in one of three ways
//! ([`BuildQuality`]): by the binned surface area heuristic of Ingo Wald, *On fast construction of
//! SAH-based bounding volume hierarchies* (IEEE Symposium on Interactive Ray Tracing, 2007); by the
//! same with spatial splits, Stich et al., *Spatial splits in bounding volume hierarchies* (High
//! Performance Graphics, 2009); or from a sort by Morton codes, Lauterbach et al., *Fast BVH
//! construction on GPUs* (Computer Graphics Forum, 2009). One idea per file:
//!
//! * `source`: the builder's interface to primitives;
//! * `reference`: the 32-byte copy of a primitive's box that is moved about while building, and
//!   input validation;
//! * `scaling`: keeps `f32` areas from overflowing and denormals out of the inner loops;
//! * `binned_sah`, `partition`, `subtree`: split selection, partitioning, the recursion;
//! * `chop`, `spatial_bins`, `spatial`, `compact`: clipping references and why no hit is lost by
//!   it, selection of spatial splits, the recursion, the list without gaps;
//! * `morton`, `linear`: the codes and the sort, the recursion;
//! * `depth`: the depth limit;
//! * `part`: subtrees built separately, and their assembly;
//! * `refit`: node bounds from moved primitives;
//! * `tasks`: parallel or sequential execution;
//! * `watch`: progress and cancellation.
//!
//! The tree is a function of the boxes, the cuts and the configuration alone: neither the number of
//! threads nor an observer changes a bit of it.

mod binned_sah;
mod chop;
mod compact;
mod config;
mod depth;
mod error;
mod linear;
mod morton;
mod part;
mod partition;
mod reference;
mod refit;
mod scaling;
mod source;
mod spatial;
mod spatial_bins;
mod subtree;
pub(super) mod tasks;
mod watch;

#[cfg(test)]
mod tests;

pub(super) use config::BLOCK;
pub(super) use config::Settings;
pub use config::{BuildConfig, BuildQuality, Traversal};
pub use error::BuildError;
pub(super) use refit::refit;
#[cfg(test)]
pub(super) use source::Boxes;
pub(super) use source::{Primitives, Source};

use core::ops::ControlFlow;

use super::Node;
use crate::geometry::Aabb;
use chop::Chopper;
use reference::Reference;
use watch::Watch;

/// Maximum depth of a leaf; the root has depth 0.
///
/// Holds for every input by construction (the proof is in `depth`), so a traversal that pushes at
/// most one entry a level never has more than this many on its stack.
pub const MAX_DEPTH: usize = 62;

/// Maximum number of primitives in a tree.
///
/// Indices are `u32`, up to `2 n - 1` nodes are addressed by `u32` as well, and one bit of an
/// index is used while building (see `reference`).
pub const MAX_PRIMITIVES: usize = 1 << 30;

/// Binary tree over primitives `0 .. n`.
///
/// The root is node 0. The children of an inner node are adjacent, and the descendants of a node
/// are contiguous: first its two children, then the descendants of the left one, then those of the
/// right one. Leaves refer to consecutive ranges of `indices` in that order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tree {
    /// Nodes, the root first; empty when there are no primitives.
    pub nodes: Vec<Node>,
    /// Primitive ids in leaf order: a permutation of `0 .. n`. With [`BuildQuality::Best`] an id
    /// may occur more than once, but never twice in a leaf.
    pub indices: Vec<u32>,
}

/// Builds the tree over `count` primitives with the boxes `bounds(0)`, ..., `bounds(count - 1)`.
///
/// Boxes may be flat, points, coincident and of any finite size; the box of every node is the exact
/// union of those below it, except that `-0.0` becomes `0.0`. [`BuildQuality::Best`] cuts the
/// boxes, and those of the leaves are around parts. `bounds` must be a pure function; it is called
/// once or twice for each primitive (with cuts more often), in any order and from several threads.
/// An empty input makes an empty tree.
///
/// Takes `O(n log n)` time. Memory, the result included: 36 bytes a primitive and 32 a node
/// while building, then 4 a primitive and up to 64 a node while the nodes are put together. With
/// the default configuration a mesh has about 0.9 nodes a triangle (65 bytes a primitive at the
/// peak), a cloud of small separate boxes 1.8 to 2 (measured: 120 bytes); never more than 132.
/// [`BuildQuality::Fast`] needs 16 bytes a primitive more while building, [`BuildQuality::Best`] 32
/// times `max_duplication`, and 36 and the nodes for each entry that it adds.
///
/// # Errors
///
/// When a box is NaN, infinite or inverted, there are more than [`MAX_PRIMITIVES`], or a field of
/// `config` is outside its range.
pub fn build(
    bounds: impl Fn(usize) -> Aabb + Sync,
    count: usize,
    config: &BuildConfig,
) -> Result<Tree, BuildError> {
    let settings = Settings { config: *config, is_wide: false };
    build_watched(&source::Boxes(bounds), count, &settings, None)
}

/// Progress callback: gets the finished share of a build, from 0 to 1; returns whether to go on.
pub(super) type Observer<'a> = dyn FnMut(f64) -> ControlFlow<()> + Send + 'a;

/// Runs [`build`] on primitives that can be cut, with an observer.
pub(super) fn build_watched(
    source: &dyn Source,
    count: usize,
    config: &Settings,
    observer: Option<&mut Observer>,
) -> Result<Tree, BuildError> {
    config.check()?;
    if count > MAX_PRIMITIVES {
        return Err(BuildError::TooManyPrimitives { count, limit: MAX_PRIMITIVES });
    }
    let spare = match config.quality {
        BuildQuality::Best => spatial::spare(count, config),
        BuildQuality::Fast | BuildQuality::Balanced => 0,
    };
    let watch = match observer {
        // Each box is read once, and each place passes to a finished subtree once.
        Some(tell) => Watch::begin(tell, 2 * count + spare),
        None => Watch::nobody(),
    };
    watch.check()?;
    let tree = grow(source, count, spare, config, &watch)?;
    watch.finish()?;
    Ok(tree)
}

fn grow(
    source: &dyn Source,
    count: usize,
    spare: usize,
    config: &Settings,
    watch: &Watch,
) -> Result<Tree, BuildError> {
    // Read and validate the boxes, and scale them if necessary.
    let (mut references, mut span) = reference::collect(source, count, spare, watch)?;
    if count == 0 {
        return Ok(Tree::default());
    }
    let scale = scaling::normalise(&mut references[..count], &mut span);
    // Grow the tree by quality.
    if config.quality == BuildQuality::Best {
        let chopper = Chopper { source, scale };
        let part = spatial::grow(&mut references, count, span, chopper, (config, watch));
        watch.check()?;
        let mut nodes = part.assemble();
        let indices = compact::compact(&mut nodes, &references, scale);
        return Ok(Tree { nodes, indices });
    }
    let (part, indices) = match config.quality {
        BuildQuality::Fast => linear::grow(&references, &span, config, watch),
        _ => {
            let part = subtree::grow(&mut references, span, config, watch);
            watch.check()?;
            (part, tasks::map(&references, part::PIECE, Reference::index))
        }
    };
    watch.check()?;
    // Freeing the references before the nodes are copied into one array keeps the copy from raising
    // the peak.
    drop(references);
    let mut tree = Tree { nodes: part.assemble(), indices };
    if !scale.is_one() {
        refit::refit_checked(&mut tree.nodes, &tree.indices, &|index| source.bounds(index));
    }
    Ok(tree)
}
