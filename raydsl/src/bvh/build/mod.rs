//! Building the binary tree.
//!
//! [`build`] makes a [`Tree`] over any primitives that have boxes, in one of two ways
//! ([`BuildQuality`]): by the binned surface area heuristic of Ingo Wald, *On fast construction of
//! SAH-based bounding volume hierarchies* (IEEE Symposium on Interactive Ray Tracing, 2007), or
//! from a sort by Morton codes as of Lauterbach et al., *Fast BVH construction on GPUs* (Computer
//! Graphics Forum, 2009). One idea a file:
//!
//! * `reference`: the 32-byte copy of a primitive's box that is moved about while building, and
//!   the checks on the input;
//! * `scaling`: what keeps `f32` areas from overflowing and denormals out of the inner loops;
//! * `binned_sah`, `partition`, `subtree`: where the heuristic splits, splitting, the recursion;
//! * `morton`, `linear`: the codes and the sort, the recursion;
//! * `depth`: how deep a tree may be;
//! * `part`: pieces of a tree, and how they are put together;
//! * `refit`: boxes from primitives that have moved;
//! * `tasks`: threads, or their absence.
//!
//! The tree is a function of the boxes and the configuration alone: the number of threads, and
//! whether there are any, does not change a bit of it.

mod binned_sah;
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
mod subtree;
mod tasks;

#[cfg(test)]
mod tests;

pub use config::{BuildConfig, BuildQuality};
pub use error::BuildError;
pub(super) use refit::refit;

use super::Node;
use crate::geometry::Aabb;
use reference::Reference;

/// The largest depth of a leaf; the root has depth 0.
///
/// Holds for every input by construction (the proof is in `depth`), so a traversal that pushes
/// at most one entry a level never has more than this many on its stack.
pub const MAX_DEPTH: usize = 62;

/// The largest number of primitives a tree can hold.
///
/// Indices are `u32`, up to `2 n - 1` nodes are addressed by `u32` as well, and one bit of an
/// index is used while building (see `reference`).
pub const MAX_PRIMITIVES: usize = 1 << 30;

/// A binary tree over primitives `0 .. n`.
///
/// The root is node 0. The children of an inner node are adjacent, and the nodes below a node are
/// contiguous: first its two children, then what is below the left one, then what is below the
/// right one. Leaves refer to consecutive ranges of `indices` in that order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tree {
    /// The nodes, the root first; empty when there are no primitives.
    pub nodes: Vec<Node>,
    /// The primitives in the order of the leaves: a permutation of `0 .. n`.
    pub indices: Vec<u32>,
}

/// Builds the tree over `count` primitives with the boxes `bounds(0)`, ..., `bounds(count - 1)`.
///
/// Boxes may be flat, points, coincident and of any finite size; the box of every node is the
/// exact union of those below it, except that `-0.0` becomes `0.0`. `bounds` must be a pure
/// function; it is called once or twice for each primitive, in any order and from several threads.
/// No primitives make an empty tree.
///
/// Takes `O(n log n)` time. Memory, the result included: 36 bytes a primitive and 32 a node
/// while building, then 4 a primitive and up to 64 a node while the nodes are put together. With
/// the default configuration a mesh has about 0.9 nodes a triangle (65 bytes a primitive at the
/// peak), a cloud of small separate boxes 1.8 to 2 (measured: 120 bytes); never more than 132.
/// [`BuildQuality::Fast`] needs 16 bytes a primitive more while building.
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
    config.check()?;
    if count > MAX_PRIMITIVES {
        return Err(BuildError::TooManyPrimitives { count, limit: MAX_PRIMITIVES });
    }
    let (mut references, mut span) = reference::collect(&bounds, count)?;
    if references.is_empty() {
        return Ok(Tree::default());
    }
    let scaled = scaling::normalise(&mut references, &mut span);
    let (part, indices) = match config.quality {
        BuildQuality::Fast => linear::grow(&references, &span, config),
        BuildQuality::Balanced => {
            let part = subtree::grow(&mut references, span, config);
            (part, references.iter().map(Reference::index).collect())
        }
    };
    // The nodes are copied into one array next; the references are not needed for that, and
    // giving them back first keeps the copy from raising the peak.
    drop(references);
    let mut tree = Tree { nodes: part.assemble(), indices };
    if scaled {
        refit::refit_checked(&mut tree.nodes, &tree.indices, &bounds);
    }
    Ok(tree)
}
