//! The trees over some primitives; each is made only if something traverses it.

use std::borrow::Cow;
use std::sync::OnceLock;

use super::build::{self, Tree};
use super::view::Branches;
use super::wide::Wide;
use super::{BuildError, Traversal};
use crate::geometry::{Aabb, Primitive, SharedSlices};

/// The binary tree, the wide tree, or both.
#[derive(Debug)]
pub(crate) struct Structure {
    /// With a wide tree, the binary tree is expanded from it on first use, and kept from then on,
    /// even by refitting: a device keeps the index list of a tree that is refitted.
    binary: OnceLock<Tree>,
    wide: Option<Wide>,
}

impl Structure {
    /// Keeps the binary tree, or the wide tree that it was collapsed to.
    pub(super) fn of(tree: Tree, wide: Option<Wide>) -> Self {
        let binary = if wide.is_some() { OnceLock::new() } else { tree.into() };
        Self { binary, wide }
    }

    /// Returns the wide tree, if there is one.
    #[inline(always)]
    pub(crate) fn wide(&self) -> Option<&Wide> {
        self.wide.as_ref()
    }

    /// Sets the traversal of the wide tree.
    pub(super) fn set_traversal(&mut self, traversal: Traversal) {
        if let Some(wide) = &mut self.wide {
            wide.traversal = traversal;
        }
    }

    /// Returns the binary tree, which is expanded from the wide one if necessary.
    #[inline(always)]
    pub(super) fn binary(&self) -> &Tree {
        match self.binary.get() {
            Some(tree) => tree,
            None => self.make_binary(),
        }
    }

    /// Expands the binary tree on this thread. Other threads that need it block, so nothing in here
    /// may wait for them: no tasks, no host code, and no fiber that yields.
    #[cold]
    #[inline(never)]
    fn make_binary(&self) -> &Tree {
        self.binary.get_or_init(|| match &self.wide {
            Some(wide) => wide.binary(),
            None => unreachable!("there is a wide tree where there is no binary one"),
        })
    }

    /// Returns the binary tree, without keeping it if it has to be expanded.
    pub(super) fn peek(&self) -> Cow<'_, Tree> {
        match (self.binary.get(), &self.wide) {
            (None, Some(wide)) => Cow::Owned(wide.binary()),
            _ => Cow::Borrowed(self.binary()),
        }
    }

    /// Returns the nodes and the index list of the binary tree, as [`Structure::binary`].
    #[inline(always)]
    pub(crate) fn branches(&self) -> Branches<'_> {
        let Tree { nodes, indices } = self.binary();
        Branches { nodes, indices }
    }

    /// Returns the number of nodes of the binary tree and of its index list, without making it.
    pub(super) fn binary_len(&self) -> [usize; 2] {
        match (self.binary.get(), &self.wide) {
            (None, Some(wide)) => wide.binary_len(),
            _ => {
                let Branches { nodes, indices } = self.branches();
                [nodes.len(), indices.len()]
            }
        }
    }

    /// Returns the bounds of all primitives.
    pub(super) fn bounds(&self) -> Aabb {
        match &self.wide {
            Some(wide) => wide.bounds(),
            None => self.branches().nodes.first().map_or(Aabb::EMPTY, super::Node::bounds),
        }
    }

    /// Returns the size of the existing trees in bytes.
    pub(super) fn bytes(&self) -> usize {
        let of_binary = |tree: &Tree| size_of_val(&tree.nodes[..]) + size_of_val(&tree.indices[..]);
        self.binary.get().map_or(0, of_binary) + self.wide.as_ref().map_or(0, Wide::bytes)
    }

    /// Refits the trees to primitives that have moved.
    pub(super) fn refit<P: Primitive>(
        mut self,
        prims: &[P],
        shared: SharedSlices<'_, P>,
        collapse: impl FnOnce(&Tree) -> Option<Wide>,
    ) -> Result<Self, BuildError> {
        self.binary();
        let Some(mut tree) = self.binary.take() else { unreachable!("it has been made") };
        let bounds = |k: usize| prims[k].get_bounds(shared);
        build::refit(&mut tree.nodes, &tree.indices, prims.len(), &bounds)?;
        let wide = collapse(&tree).map(|mut wide| {
            wide.set_refitted();
            wide
        });
        // The topology is the same, and primitives that have moved are likely to move again.
        Ok(Self { binary: tree.into(), wide })
    }
}
