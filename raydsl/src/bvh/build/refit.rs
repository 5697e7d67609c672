//! Boxes from primitives, for a tree that exists.

use std::convert::Infallible;

use super::error::BuildError;
use super::{reference, tasks};
use crate::bvh::Node;
use crate::geometry::Aabb;

/// Nodes whose leaves are one piece of work.
const PIECE: usize = 1 << 14;

/// Sets the boxes of all nodes over `count` primitives; of several bad ones the first is the error.
pub(in crate::bvh) fn refit(
    nodes: &mut [Node],
    indices: &[u32],
    count: usize,
    bounds: &(dyn Fn(usize) -> Aabb + Sync),
) -> Result<(), BuildError> {
    let checked = |index| reference::checked(bounds(index), index);
    set_boxes(nodes, indices, &checked).map_err(|error| {
        // Leaves have an order of their own. There is time now to look for the first.
        (0..count).find_map(|index| checked(index).err()).unwrap_or(error)
    })
}

/// [`refit`] for primitives that have been checked.
pub(super) fn refit_checked(
    nodes: &mut [Node],
    indices: &[u32],
    bounds: &(dyn Fn(usize) -> Aabb + Sync),
) {
    let Ok(()) = set_boxes(nodes, indices, &|index| Ok::<_, Infallible>(bounds(index)));
}

/// Leaves take nearly all of the time, for their primitives may be anywhere in memory, and each can
/// be done for itself. What is left is one pass over the nodes.
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
    // As for references: only one zero.
    (leaf.min, leaf.max) = (all.min + glam::Vec3::ZERO, all.max + glam::Vec3::ZERO);
    Ok(())
}
