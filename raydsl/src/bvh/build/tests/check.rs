//! Invariants of every built tree, beyond those of `validate`.

use super::super::source::Boxes;
use super::super::{BuildConfig, BuildQuality, MAX_DEPTH, Tree};
use crate::bvh::validate;
use crate::geometry::Aabb;

/// Checks that `tree` over `boxes` is as documented; panics otherwise.
pub(super) fn check(tree: &Tree, boxes: &[Aabb], config: &BuildConfig) {
    let Tree { nodes, indices } = tree;
    validate::check(nodes, indices, boxes.len(), &Boxes(|k: usize| boxes[k]))
        .expect("the tree is sound");
    // All of them are in leaves, and cut ones in several.
    let is_cut = config.quality == BuildQuality::Best;
    let spare = if is_cut { (boxes.len() as f32 * config.max_duplication) as usize } else { 0 };
    assert!(indices.len() <= boxes.len() + spare, "{} of {}", indices.len(), boxes.len());
    if boxes.is_empty() {
        assert_eq!(nodes.len(), 0);
        return;
    }
    let mut walk = Walk { tree, boxes, config, next_node: 1, next_index: 0 };
    walk.node(0, 0);
    assert_eq!(walk.next_index, indices.len(), "there are indices outside the leaves");
}

/// Depth-first traversal.
struct Walk<'a> {
    tree: &'a Tree,
    boxes: &'a [Aabb],
    config: &'a BuildConfig,
    /// Expected position of the next pair of nodes.
    next_node: usize,
    /// Expected start of the next leaf's range.
    next_index: usize,
}

impl Walk<'_> {
    fn node(&mut self, k: usize, depth: usize) {
        // The bound documented in `depth` is stricter than the promise.
        let levels = self.boxes.len().next_power_of_two().ilog2() as usize;
        assert!(depth <= MAX_DEPTH.min(2 * levels + 8), "node {k} is too deep");
        let node = self.tree.nodes[k];
        let first = node.first as usize;
        let below = if node.is_leaf() {
            assert_eq!(first, self.next_index, "leaf {k} is out of order");
            assert!(node.count <= self.config.max_leaf_size);
            self.next_index += node.count as usize;
            let indices = self.tree.indices[first..self.next_index].iter();
            let whole = indices.map(|&index| self.boxes[index as usize]);
            let whole = whole.fold(Aabb::EMPTY, Aabb::union);
            // Parts of primitives need less.
            if self.config.quality == BuildQuality::Best { node.bounds() } else { whole }
        } else {
            assert_eq!(first, self.next_node, "the children of {k} are out of order");
            self.next_node += 2;
            self.node(first, depth + 1);
            self.node(first + 1, depth + 1);
            self.tree.nodes[first].bounds().union(self.tree.nodes[first + 1].bounds())
        };
        assert_eq!(node.bounds(), below, "the box of node {k} is not that of what is below");
    }
}
