//! Final step of a build with spatial splits: closes the gaps in the index list and restores
//! unscaled leaf boxes.

use super::reference::Reference;
use super::scaling::Scale;
use crate::bvh::Node;
use crate::geometry::Aabb;

/// Redirects leaves from `places` to the returned index list, and recomputes inner boxes as the
/// union of their children.
pub(super) fn compact(nodes: &mut [Node], places: &[Reference], scale: Scale) -> Vec<u32> {
    let is_leaf = |node: &&Node| node.is_leaf();
    let count = nodes.iter().filter(is_leaf).map(|leaf| leaf.count as usize).sum();
    let mut indices = Vec::with_capacity(count);
    number(nodes, 0, places, &mut indices);
    if !scale.is_one() {
        for leaf in nodes.iter_mut().filter(|node| node.is_leaf()) {
            set_box(leaf, scale.back(leaf.bounds()));
        }
    }
    // Children come after their parents. A cut may have left a smaller box.
    for k in (0..nodes.len()).rev() {
        if nodes[k].is_leaf() {
            continue;
        }
        let first = nodes[k].first as usize;
        let bounds = nodes[first].bounds().union(nodes[first + 1].bounds());
        set_box(&mut nodes[k], bounds);
    }
    indices
}

/// Assigns index ranges to leaves in depth-first order; recurses as deep as the tree.
fn number(nodes: &mut [Node], node: usize, places: &[Reference], indices: &mut Vec<u32>) {
    let Node { first, count, .. } = nodes[node];
    let first = first as usize;
    if count == 0 {
        number(nodes, first, places, indices);
        number(nodes, first + 1, places, indices);
        return;
    }
    nodes[node].first = indices.len() as u32;
    indices.extend(places[first..][..count as usize].iter().map(Reference::index));
}

fn set_box(node: &mut Node, bounds: Aabb) {
    (node.min, node.max) = (bounds.min, bounds.max);
}
