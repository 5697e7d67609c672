//! The tree in which blocks of samples are summed.

use core::ops::Range;

use crate::render::moments::{Moments, Sums};

/// A subtree: the moments of `1 << level` blocks, the `index`-th such group.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    level: u32,
    index: u32,
    pub(super) pixels: Vec<Sums>,
}

impl Node {
    /// Creates the leaf of a block.
    pub(super) fn of_block(block: u32, pixels: &[Moments]) -> Self {
        let sums = |moments: &Moments| {
            let mut sums = Sums::default();
            sums.join(moments);
            sums
        };
        Self { level: 0, index: block, pixels: pixels.iter().map(sums).collect() }
    }

    /// Creates the subtree of a place.
    pub(super) fn at(Place { level, index }: Place, pixels: Vec<Sums>) -> Self {
        Self { level, index, pixels }
    }

    /// Returns whether it is one block.
    pub(super) fn is_leaf(&self) -> bool {
        self.level == 0
    }

    /// Returns whether `next` is the right child of the parent whose left child this is.
    fn is_left_of(&self, next: &Self) -> bool {
        self.level == next.level && self.index.is_multiple_of(2) && next.index == self.index + 1
    }

    /// Makes the parent of this left child and the right one.
    fn absorb(&mut self, right: &Self) {
        for (sums, more) in self.pixels.iter_mut().zip(&right.pixels) {
            sums.merge(more);
        }
        (self.level, self.index) = (self.level + 1, self.index / 2);
    }
}

/// Adds the next subtree to those of a range, and joins what has become complete.
pub(super) fn push(nodes: &mut Vec<Node>, node: Node) {
    nodes.push(node);
    while let [.., left, right] = &mut nodes[..]
        && left.is_left_of(right)
    {
        left.absorb(right);
        nodes.pop();
    }
}

/// The place of a subtree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) level: u32,
    pub(super) index: u32,
}

impl Place {
    /// Returns the blocks of the subtree.
    pub(super) fn blocks(self) -> Range<u64> {
        let Self { level, index } = self;
        u64::from(index) << level..(u64::from(index) + 1) << level
    }
}

/// Returns the largest subtrees of a range of blocks, in order.
pub(super) fn largest(blocks: Range<u32>) -> Vec<Place> {
    let (mut first, mut places) = (blocks.start, Vec::new());
    while first < blocks.end {
        // `first` may be a multiple of any power.
        let level = first.trailing_zeros().min((blocks.end - first).ilog2());
        places.push(Place { level, index: first >> level });
        first += 1 << level;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushing_makes_the_largest_subtrees() {
        for first in 0..20 {
            let mut nodes = Vec::new();
            for block in first..first + 40 {
                push(&mut nodes, Node::of_block(block, &[]));
                let found: Vec<Place> =
                    nodes.iter().map(|n| Place { level: n.level, index: n.index }).collect();
                assert_eq!(found, largest(first..block + 1));
            }
        }
        assert_eq!(largest(0..1 << 20).len(), 1);
        assert_eq!(largest(5..5), []);
        // The last block that a film can have.
        let last = u32::MAX.div_ceil(super::super::SAMPLE_BLOCK);
        let ends = largest(0..last).last().map(|place| place.blocks().end);
        assert_eq!(ends, Some(u64::from(last)));
    }
}
