//! The node of the wide tree.

use crate::bvh::build::BLOCK;
use crate::geometry::Aabb;

/// Maximum number of children of a node, and of primitives of a block.
pub(crate) const WIDTH: usize = BLOCK;

/// The planes of eight boxes: the lower and the upper ones along x, along y, along z.
pub(crate) type Planes = [[f32; WIDTH]; 6];

/// Planes of eight boxes that no ray enters.
pub(crate) const NO_BOXES: Planes = {
    const LOWER: [f32; WIDTH] = [f32::INFINITY; WIDTH];
    const UPPER: [f32; WIDTH] = [f32::NEG_INFINITY; WIDTH];
    [LOWER, UPPER, LOWER, UPPER, LOWER, UPPER]
};

/// Sets the box in a slot.
pub(super) fn set_box(planes: &mut Planes, slot: usize, bounds: Aabb) {
    let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
    for axis in 0..3 {
        planes[2 * axis][slot] = min[axis];
        planes[2 * axis + 1][slot] = max[axis];
    }
}

/// A child of a node: another node, or a block of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(pub(crate) u32);

impl Child {
    const BLOCK: u32 = 1 << 31;

    /// The child of an empty slot, and the end of a stack; no tree has that many blocks.
    pub(crate) const NONE: Self = Self(u32::MAX);

    pub(crate) const fn node(index: u32) -> Self {
        Self(index)
    }

    pub(crate) const fn block(index: u32) -> Self {
        Self(index | Self::BLOCK)
    }

    #[inline(always)]
    pub(crate) const fn is_block(self) -> bool {
        self.0 >= Self::BLOCK
    }

    /// Returns the index of the node, or of the block.
    #[inline(always)]
    pub(crate) const fn index(self) -> usize {
        (self.0 & !Self::BLOCK) as usize
    }
}

/// A node: the boxes of up to eight children, in structure-of-arrays layout.
///
/// An empty slot has an inverted box, which no ray enters. The slots are in the traversal order of
/// any-hit queries, last one first.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct WideNode {
    pub(crate) planes: Planes,
    pub(crate) children: [u32; WIDTH],
    /// The binary nodes between this one and its children, lowest first: the two members that each
    /// of them joins, slots or, from `WIDTH` on, joints.
    joints: [[u8; 2]; WIDTH - 1],
    /// The number of joints.
    joint_count: u8,
}

impl WideNode {
    pub(crate) const EMPTY: Self = Self {
        planes: NO_BOXES,
        children: [Child::NONE.0; WIDTH],
        joints: [[0; 2]; WIDTH - 1],
        joint_count: 0,
    };

    /// Returns the box of a slot.
    pub(crate) fn bounds(&self, slot: usize) -> Aabb {
        let along = |axis: usize| (self.planes[2 * axis][slot], self.planes[2 * axis + 1][slot]);
        let (x, y, z) = (along(0), along(1), along(2));
        Aabb::new([x.0, y.0, z.0].into(), [x.1, y.1, z.1].into())
    }

    /// Sets the joints of the children; the last one joins all.
    pub(super) fn join(&mut self, joints: &[[u8; 2]]) {
        self.joints[..joints.len()].copy_from_slice(joints);
        self.joint_count = joints.len() as u8;
    }

    /// Returns the member that joins all children.
    pub(super) fn top(&self) -> usize {
        match self.joint_count {
            0 => 0,
            count => WIDTH + count as usize - 1,
        }
    }

    /// Returns the two members that a joint joins; none for a slot.
    pub(super) fn joined(&self, member: usize) -> Option<[usize; 2]> {
        Some(self.joints[member.checked_sub(WIDTH)?].map(usize::from))
    }

    pub(crate) fn set(&mut self, slot: usize, bounds: Aabb, child: Child) {
        set_box(&mut self.planes, slot, bounds);
        self.children[slot] = child.0;
    }
}

const _: () = assert!(size_of::<WideNode>() == 256);
