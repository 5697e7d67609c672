//! The node of the wide tree.

use crate::bvh::build::BLOCK;
use crate::geometry::Aabb;

/// How many children a node has at most, and a block primitives.
pub(crate) const WIDTH: usize = BLOCK;

/// What a slot of a node leads to: another node, or a block of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Child(pub(crate) u32);

impl Child {
    const BLOCK: u32 = 1 << 31;

    /// Where a stack ends, and what an empty slot leads to; no tree has that many blocks.
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

    /// The number of the node, or of the block.
    #[inline(always)]
    pub(crate) const fn index(self) -> usize {
        (self.0 & !Self::BLOCK) as usize
    }
}

/// A node: the boxes of up to eight children, each plane of all of them side by side.
///
/// An empty slot has a box that is inside out, which no ray enters. The slots are in the order in
/// which rays that ask for any hit should visit them, the last one first.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct WideNode {
    /// Lower and upper planes along x, along y, along z.
    pub(crate) planes: [[f32; WIDTH]; 6],
    pub(crate) children: [u32; WIDTH],
    /// The binary nodes between this one and its children, the lowest first: what each of them
    /// joins, slots or, from `WIDTH` on, joints.
    joints: [[u8; 2]; WIDTH - 1],
    /// How many there are.
    joint_count: u8,
}

impl WideNode {
    pub(crate) const EMPTY: Self = {
        const LOWER: [f32; WIDTH] = [f32::INFINITY; WIDTH];
        const UPPER: [f32; WIDTH] = [f32::NEG_INFINITY; WIDTH];
        Self {
            planes: [LOWER, UPPER, LOWER, UPPER, LOWER, UPPER],
            children: [Child::NONE.0; WIDTH],
            joints: [[0; 2]; WIDTH - 1],
            joint_count: 0,
        }
    };

    /// The box of a slot.
    pub(crate) fn bounds(&self, slot: usize) -> Aabb {
        let along = |axis: usize| (self.planes[2 * axis][slot], self.planes[2 * axis + 1][slot]);
        let (x, y, z) = (along(0), along(1), along(2));
        Aabb::new([x.0, y.0, z.0].into(), [x.1, y.1, z.1].into())
    }

    /// Says how the children are joined; the last joint is that of all.
    pub(super) fn join(&mut self, joints: &[[u8; 2]]) {
        self.joints[..joints.len()].copy_from_slice(joints);
        self.joint_count = joints.len() as u8;
    }

    /// The member that stands for all children.
    pub(super) fn top(&self) -> usize {
        match self.joint_count {
            0 => 0,
            count => WIDTH + count as usize - 1,
        }
    }

    /// The two members that a member joins; none if it is a slot.
    pub(super) fn joined(&self, member: usize) -> Option<[usize; 2]> {
        Some(self.joints[member.checked_sub(WIDTH)?].map(usize::from))
    }

    pub(crate) fn set(&mut self, slot: usize, bounds: Aabb, child: Child) {
        let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
        for axis in 0..3 {
            self.planes[2 * axis][slot] = min[axis];
            self.planes[2 * axis + 1][slot] = max[axis];
        }
        self.children[slot] = child.0;
    }
}

const _: () = assert!(size_of::<WideNode>() == 256);
