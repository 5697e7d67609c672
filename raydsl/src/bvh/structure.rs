//! The trees over some primitives, of which there are only those that something goes through.

use std::borrow::Cow;
use std::sync::OnceLock;

use super::build::{self, Tree};
use super::view::Branches;
use super::wide::Wide;
use super::{BuildError, Traversal};
use crate::geometry::{Aabb, Primitive};

/// The binary tree, the wide one, or both.
#[derive(Debug)]
pub(crate) struct Structure {
    /// If there is a wide tree, made of it when it is first asked for. From then on it stays, whatever
    /// moves: a device keeps the index list of a tree that is refitted.
    binary: OnceLock<Tree>,
    wide: Option<Wide>,
}

impl Structure {
    /// The tree that was built, or the wide one that it is made into.
    pub(super) fn of(tree: Tree, wide: Option<Wide>) -> Self {
        let binary = if wide.is_some() { OnceLock::new() } else { tree.into() };
        Self { binary, wide }
    }

    /// The wide tree, if there is one.
    #[inline(always)]
    pub(crate) fn wide(&self) -> Option<&Wide> {
        self.wide.as_ref()
    }

    /// How rays go through the wide tree from now on.
    pub(super) fn set_traversal(&mut self, traversal: Traversal) {
        if let Some(wide) = &mut self.wide {
            wide.traversal = traversal;
        }
    }

    /// The binary tree, which is made if it is not there.
    #[inline(always)]
    pub(super) fn binary(&self) -> &Tree {
        match self.binary.get() {
            Some(tree) => tree,
            None => self.make_binary(),
        }
    }

    /// Makes the binary tree on this thread alone. Others that ask wait, so nothing in here may wait
    /// for them: no tasks, none of the host's code, and no packet that goes on meanwhile.
    #[cold]
    #[inline(never)]
    fn make_binary(&self) -> &Tree {
        self.binary.get_or_init(|| match &self.wide {
            Some(wide) => wide.binary(),
            None => unreachable!("there is a wide tree where there is no binary one"),
        })
    }

    /// The binary tree, which is not kept if it was not there.
    pub(super) fn peek(&self) -> Cow<'_, Tree> {
        match (self.binary.get(), &self.wide) {
            (None, Some(wide)) => Cow::Owned(wide.binary()),
            _ => Cow::Borrowed(self.binary()),
        }
    }

    /// The nodes of the binary tree, as [`Structure::binary`], and its index list.
    #[inline(always)]
    pub(crate) fn branches(&self) -> Branches<'_> {
        let Tree { nodes, indices } = self.binary();
        Branches { nodes, indices }
    }

    /// A box around everything.
    pub(super) fn bounds(&self) -> Aabb {
        match &self.wide {
            Some(wide) => wide.bounds(),
            None => self.branches().nodes.first().map_or(Aabb::EMPTY, super::Node::bounds),
        }
    }

    /// Bytes of the trees that there are.
    pub(super) fn bytes(&self) -> usize {
        let of_binary = |tree: &Tree| size_of_val(&tree.nodes[..]) + size_of_val(&tree.indices[..]);
        self.binary.get().map_or(0, of_binary) + self.wide.as_ref().map_or(0, Wide::bytes)
    }

    /// The trees over primitives that have moved.
    pub(super) fn refit<P: Primitive>(
        mut self,
        prims: &[P],
        shared: &[P::Shared],
        collapse: impl FnOnce(&Tree) -> Option<Wide>,
    ) -> Result<Self, BuildError> {
        self.binary();
        let Some(mut tree) = self.binary.take() else { unreachable!("it has been made") };
        let bounds = |k: usize| prims[k].get_bounds(shared);
        build::refit(&mut tree.nodes, &tree.indices, prims.len(), &bounds)?;
        let wide = collapse(&tree);
        // The same tree as before, and what has moved is likely to move again.
        Ok(Self { binary: tree.into(), wide })
    }
}
