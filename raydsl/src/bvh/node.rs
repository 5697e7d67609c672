//! Node of the binary tree.

use glam::Vec3;

use crate::geometry::Aabb;

/// Node of the binary tree: 32 bytes, two to a cache line.
///
/// The children of an inner node are adjacent, the left one at [`Node::first`]; a leaf holds the
/// range `first .. first + count` of the tree's index list.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Node {
    /// Lower corner of the node's box.
    pub min: Vec3,
    /// Inner node: the left child's index. Leaf: the first entry in the index list.
    pub first: u32,
    /// Upper corner of the node's box.
    pub max: Vec3,
    /// Number of primitives; 0 marks an inner node.
    pub count: u32,
}

impl Node {
    /// Creates an inner node over the two nodes at `left` and `left + 1`.
    pub fn inner(bounds: Aabb, left: u32) -> Self {
        Self { min: bounds.min, first: left, max: bounds.max, count: 0 }
    }

    /// Creates a leaf over `count > 0` entries of the index list from `first` on.
    pub fn leaf(bounds: Aabb, first: u32, count: u32) -> Self {
        debug_assert!(count > 0);
        Self { min: bounds.min, first, max: bounds.max, count }
    }

    /// Returns whether the node holds primitives.
    pub fn is_leaf(&self) -> bool {
        self.count > 0
    }

    /// Returns the node's bounds.
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.min, self.max)
    }
}
