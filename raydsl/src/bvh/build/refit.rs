//! Refitting of node bounds to moved primitives.

use std::convert::Infallible;

use super::error::BuildError;
use super::{reference, tasks};
use crate::bvh::Node;
use crate::geometry::Aabb;

/// Nodes per piece of parallel work.
const PIECE: usize = 1 << 14;

/// Refits the bounds of all nodes over `count` primitives; of several invalid ones the first is the
/// error.
pub(in crate::bvh) fn refit(
    nodes: &mut [Node],
    indices: &[u32],
    count: usize,
    bounds: &(dyn Fn(usize) -> Aabb + Sync),
) -> Result<(), BuildError> {
    let checked = |index| reference::checked(bounds(index), index);
    set_boxes(nodes, indices, &checked).map_err(|error| {
        // Leaves have an order of their own. On the error path there is time to look for the first.
        (0..count).find_map(|index| checked(index).err()).unwrap_or(error)
    })
}

/// Refits like [`refit`], for validated primitives.
pub(super) fn refit_checked(
    nodes: &mut [Node],
    indices: &[u32],
    bounds: &(dyn Fn(usize) -> Aabb + Sync),
) {
    let Ok(()) = set_boxes(nodes, indices, &|index| Ok::<_, Infallible>(bounds(index)));
}

/// Sets the bounds of all nodes: leaves in parallel, then inner nodes in one pass. Leaves take
/// nearly all of the time, as their primitives may be anywhere in memory.
fn set_boxes<E: Send>(
    nodes: &mut [Node],
    indices: &[u32],
    bounds: &(impl Fn(usize) -> Result<Aabb, E> + Sync),
) -> Result<(), E> {
    let pieces = tasks::map_pieces_mut(nodes, PIECE, |_, piece| {
        let mut leaves = piece.iter_mut().filter(|node| node.is_leaf());
        leaves.try_for_each(|leaf| set_leaf(leaf, indices, bounds))
    });
    pieces.into_iter().collect::<Result<(), E>>()?;
    // Children come after their parents.
    for k in (0..nodes.len()).rev() {
        let Node { first, count, .. } = nodes[k];
        if count > 0 {
            continue;
        }
        let first = first as usize;
        let bounds = nodes[first].bounds().union(nodes[first + 1].bounds());
        (nodes[k].min, nodes[k].max) = (bounds.min, bounds.max);
    }
    Ok(())
}

fn set_leaf<E>(
    leaf: &mut Node,
    indices: &[u32],
    bounds: &impl Fn(usize) -> Result<Aabb, E>,
) -> Result<(), E> {
    let mut all = Aabb::EMPTY;
    for &index in &indices[leaf.first as usize..][..leaf.count as usize] {
        all = all.union(bounds(index as usize)?);
    }
    // As for references: only one kind of zero.
    (leaf.min, leaf.max) = (all.min + glam::Vec3::ZERO, all.max + glam::Vec3::ZERO);
    Ok(())
}
