//! Single-ray traversal of instances.

use super::placed::{Placing, STACK, Target};
use crate::bvh::contract::{Slabs, is_finite};
use crate::bvh::traverse::Stack;
use crate::geometry::{Ray, transform_ray};

/// Traversal of the groups of a scene that stops at every tree the ray may enter.
///
/// The groups' trees have leaves of one instance each. All levels share one stack: a level ends
/// where the stack is as short as when the level was entered.
pub(crate) struct Descent<'a> {
    groups: &'a [Placing],
    levels: Vec<Level<'a>>,
    stack: Stack<f32, STACK>,
    /// Number of box tests.
    pub(crate) nodes: u32,
}

/// Group being traversed.
struct Level<'a> {
    group: &'a Placing,
    /// Instance id of its first tree.
    first: u32,
    /// The ray in the space of the group.
    ray: Ray,
    slabs: Slabs,
    /// Length of the stack when the group was entered.
    bottom: usize,
}

/// Placed tree.
pub(crate) struct Place {
    pub(crate) tree: u32,
    pub(crate) inst: u32,
    /// The ray in the space of the tree.
    pub(crate) ray: Ray,
}

impl<'a> Descent<'a> {
    /// Begins a traversal of the last group.
    pub(crate) fn new(groups: &'a [Placing], ray: Ray) -> Box<Self> {
        let levels = Vec::with_capacity(1);
        let mut descent = Box::new(Self { groups, levels, stack: Stack::new(), nodes: 0 });
        if let Some(top) = groups.last() {
            descent.enter(top, 0, ray, ray.t_max);
        }
        descent
    }

    /// Enters a group if the ray may hit its bounds.
    fn enter(&mut self, group: &'a Placing, first: u32, ray: Ray, limit: f32) {
        let Some(root) = group.branches().nodes.first() else { return };
        if !is_finite(ray) {
            return;
        }
        let slabs = Slabs::of(&ray, root, group.padding);
        self.nodes += 1;
        if let Some(enter) = slabs.enter(root, ray.t_min, limit) {
            self.levels.push(Level { group, first, ray, slabs, bottom: self.stack.len() });
            self.stack.push(0, enter);
        }
    }

    /// Returns the next tree that the ray may enter at or before `limit`.
    pub(crate) fn next(&mut self, limit: f32) -> Option<Place> {
        while let Some(level) = self.levels.last() {
            let (group, first, ray) = (level.group, level.first, level.ray);
            let Some(index) = self.next_item(limit) else {
                self.levels.pop();
                continue;
            };
            let item = &group.items[index as usize];
            // Transform the ray to the space of the object, then enter it.
            let (inst, ray) = (first + item.first, transform_ray(ray, item.to_object));
            match item.target {
                Target::Tree(tree) if is_finite(ray) => return Some(Place { tree, inst, ray }),
                Target::Tree(_) => {}
                Target::Group(group) => self.enter(&self.groups[group as usize], inst, ray, limit),
            }
        }
        None
    }

    /// Returns the next instance of the innermost group that the ray may enter.
    fn next_item(&mut self, limit: f32) -> Option<u32> {
        let level = self.levels.last()?;
        let tree = level.group.branches();
        while self.stack.len() > level.bottom {
            let (index, enter) = self.stack.pop()?;
            if enter > limit {
                continue;
            }
            let mut node = &tree.nodes[index as usize];
            // Descend to a leaf, the nearer child first.
            while !node.is_leaf() {
                let children = &tree.nodes[node.first as usize..node.first as usize + 2];
                self.nodes += 2;
                let t_min = level.ray.t_min;
                let enter = |child| level.slabs.enter(child, t_min, limit);
                let enters = [enter(&children[0]), enter(&children[1])];
                node = match enters {
                    [Some(left), Some(right)] => {
                        let near = usize::from(right < left);
                        // Push the farther child.
                        self.stack.push(node.first + 1 - near as u32, left.max(right));
                        &children[near]
                    }
                    [Some(_), None] => &children[0],
                    [None, Some(_)] => &children[1],
                    [None, None] => break,
                };
            }
            if node.is_leaf() {
                return Some(tree.indices[node.first as usize]);
            }
        }
        None
    }
}
