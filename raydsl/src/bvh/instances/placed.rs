//! Placed instances: the data that traversal of [`Instances`](super::Instances) reads.

use glam::Affine3;

use super::{InstanceError, MAX_CONDITION, MAX_LEVELS};
use crate::bvh::build::{self, BuildConfig, MAX_PRIMITIVES};
use crate::bvh::contract::{Padding, ULP};
use crate::bvh::traverse_packet::InstanceTable;
use crate::bvh::view::{Branches, Trees};
use crate::bvh::{Node, stats};
use crate::geometry::affine::{self, Inverted};
use crate::geometry::{Aabb, Ray, Shared, transform_ray};

/// Maximum stack entries of one ray, on all levels of instances together.
pub(crate) const STACK: usize = 128;

/// Padding with which every box is hit.
const EVERYTHING: f64 = 16.0;

/// Trees and the groups in which they are placed. Rays are traced against the last group.
#[derive(Debug)]
pub(crate) struct Placed<'a, T, S: Shared> {
    pub(crate) trees: Trees<'a, T, S>,
    /// Padding of boxes in the trees.
    pub(crate) padding: Padding,
    /// The depth of each tree.
    depths: Vec<usize>,
    pub(crate) groups: Vec<Placing>,
    /// Number of changes of the groups.
    pub(crate) version: u32,
    /// Packet traversals of the instances.
    pub(crate) queries: InstanceTable,
}

/// Tree over the instances of a group.
#[derive(Debug)]
pub(crate) struct Placing {
    pub(crate) items: Vec<Item>,
    nodes: Vec<Node>,
    /// Index list, with one entry per leaf.
    indices: Vec<u32>,
    pub(crate) padding: Padding,
    /// Number of trees placed in the group, counting every copy.
    pub(crate) size: u32,
    /// Number of levels of instances.
    levels: usize,
    /// Stack entries needed down to the leaves of the trees.
    depth: usize,
    /// See [`Instances::amplification`](super::Instances::amplification).
    pub(super) condition: f64,
}

/// Instance prepared for traversal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Item {
    pub(crate) to_object: Affine3,
    pub(crate) target: Target,
    /// Index of its first tree, among those of its group.
    pub(crate) first: u32,
}

/// Object of an instance, by index.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Target {
    Tree(u32),
    Group(u32),
}

/// Validated instance, from which its box is computed.
pub(crate) struct Placement {
    target: Target,
    map: Inverted,
}

impl Placement {
    pub(super) fn new(
        instance: usize,
        target: Target,
        to_outer: Affine3,
    ) -> Result<Self, InstanceError> {
        let map = affine::inverted(to_outer).ok_or(InstanceError::NoInverse { instance })?;
        if map.condition > MAX_CONDITION {
            let (condition, limit) = (map.condition, MAX_CONDITION);
            return Err(InstanceError::IllConditioned { instance, condition, limit });
        }
        Ok(Self { target, map })
    }
}

/// Object as seen by the group that places it.
struct Seen {
    bounds: Aabb,
    padding: Padding,
    size: u32,
    levels: usize,
    depth: usize,
    condition: f64,
}

impl Placing {
    /// Builds the tree over these instances.
    pub(super) fn build<T, S: Shared>(
        placed: &Placed<'_, T, S>,
        instances: &[Placement],
    ) -> Result<Self, InstanceError> {
        let mut group = Self {
            items: Vec::with_capacity(instances.len()),
            nodes: Vec::new(),
            indices: Vec::new(),
            padding: placed.padding,
            size: 0,
            levels: 1,
            depth: 0,
            condition: 1.0,
        };
        let size = instances.iter().map(|placing| u64::from(placed.see(placing.target).size)).sum();
        let (limit, most) = (u64::from(u32::MAX), MAX_PRIMITIVES as u64);
        if size > limit {
            return Err(InstanceError::TooMany { count: size, limit });
        } else if instances.len() as u64 > most {
            return Err(InstanceError::TooMany { count: instances.len() as u64, limit: most });
        }
        // Collect the boxes of non-empty instances.
        let (mut full, mut boxes) = (Vec::new(), Vec::new());
        for (instance, &Placement { target, map }) in instances.iter().enumerate() {
            let (seen, first) = (placed.see(target), group.size);
            if seen.bounds.is_valid() {
                boxes.push(group.include(instance, &map, &seen)?);
                full.push(instance as u32);
            }
            group.items.push(Item { to_object: map.to_object, target, first });
            group.size += seen.size;
        }
        let config = BuildConfig { max_leaf_size: 1, ..BuildConfig::default() };
        let tree = build::build(|i| boxes[i], boxes.len(), &config);
        let tree = tree.unwrap_or_else(|error| unreachable!("boxes have been checked: {error}"));
        group.depth += stats::depth(&tree.nodes) + 2;
        group.nodes = tree.nodes;
        group.indices = tree.indices.into_iter().map(|i| full[i as usize]).collect();
        group.check_depth()?;
        Ok(group)
    }

    /// Adds an instance to the group's limits; returns its box.
    ///
    /// Within the object a hit may lie beside its box by `slack` times the reach, along each axis:
    /// by `sqrt(3)` times that in any direction. The reach, a distance along an axis too, is at
    /// most `sqrt(3)` times the one in the group. Seen from the group both grow by at most the
    /// largest stretch of the map, and of its inverse: together by the condition number, so that
    /// the group needs `3 condition * slack`.
    ///
    /// Transforming a ray to the object rounds the origin by a few units in the last place of the
    /// sum `|M| |o| + |b|` of matrix and translation, and the direction likewise. That error, and
    /// the padding relative to the origin within the object, divide into a part relative to the
    /// distance, one relative to the ray's origin, and a constant that widens the box.
    fn include(
        &mut self,
        instance: usize,
        map: &Inverted,
        seen: &Seen,
    ) -> Result<Aabb, InstanceError> {
        let inner = seen.padding;
        let rounding = 16.0 * ULP;
        // Padding beyond everything is useless, and it must stay finite.
        let larger = |x: f32| {
            let larger = 3.0 * map.condition * f64::from(x + rounding) * (1.0 + 1e-6);
            larger.min(EVERYTHING) as f32
        };
        self.padding.slack = self.padding.slack.max(larger(inner.slack));
        self.padding.origin = self.padding.origin.max(larger(inner.origin));
        self.condition = self.condition.max(map.condition * seen.condition);
        self.levels = self.levels.max(1 + seen.levels);
        self.depth = self.depth.max(seen.depth);
        let shift = f64::from(map.to_object.translation.abs().element_sum());
        let margin = 2.0 * map.stretch * shift * f64::from(rounding + inner.origin);
        let bounds = affine::image(seen.bounds, &map.to_outer, margin);
        if bounds.is_finite() { Ok(bounds) } else { Err(InstanceError::TooLarge { instance }) }
    }

    fn check_depth(&self) -> Result<(), InstanceError> {
        if self.levels <= MAX_LEVELS && self.depth < STACK {
            return Ok(());
        }
        Err(InstanceError::TooDeep {
            levels: self.levels,
            depth: self.depth,
            level_limit: MAX_LEVELS,
            depth_limit: STACK - 1,
        })
    }

    pub(super) fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, Node::bounds)
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.items[..]) + size_of_val(&self.nodes[..]) + size_of_val(&self.indices[..])
    }

    /// Returns the tree over the instances, with one instance per leaf.
    #[inline(always)]
    pub(crate) fn branches(&self) -> Branches<'_> {
        Branches { nodes: &self.nodes, indices: &self.indices }
    }
}

impl<'a, T, S: Shared> Placed<'a, T, S> {
    pub(super) fn new(trees: Trees<'a, T, S>, padding: Padding, queries: InstanceTable) -> Self {
        let nodes = trees.parts.iter().map(|part| part.tree().map_or(&[][..], |tree| tree.nodes));
        let depths = nodes.map(stats::depth).collect();
        Self { trees, padding, depths, groups: Vec::new(), version: 0, queries }
    }

    /// Returns the group that rays are traced against.
    #[inline(always)]
    pub(crate) fn top(&self) -> Option<&Placing> {
        self.groups.last()
    }

    /// Calls `visit` for every level of an instance, outermost first, with its index in its group.
    /// An id beyond the last instance selects the last one.
    #[inline(always)]
    pub(crate) fn each_level(&self, inst: u32, mut visit: impl FnMut(usize, &Item)) {
        let (mut group, mut inst) = (self.top(), inst);
        while let Some(Placing { items, .. }) = group {
            let Some(index) = items.partition_point(|item| item.first <= inst).checked_sub(1)
            else {
                return;
            };
            let item = &items[index];
            visit(index, item);
            inst -= item.first;
            group = match item.target {
                Target::Tree(_) => None,
                Target::Group(group) => Some(&self.groups[group as usize]),
            };
        }
    }

    /// Returns the transform from the space of the scene to that of an instance's tree.
    pub(crate) fn to_object(&self, inst: u32) -> Affine3 {
        let mut map = Affine3::IDENTITY;
        self.each_level(inst, |_, item| map = item.to_object * map);
        map
    }

    /// Returns the ray in the space of an instance's tree.
    pub(crate) fn local_ray(&self, inst: u32, ray: Ray) -> Ray {
        let mut ray = ray;
        self.each_level(inst, |_, item| ray = transform_ray(ray, item.to_object));
        ray
    }
}

impl<T, S: Shared> Placed<'_, T, S> {
    fn see(&self, target: Target) -> Seen {
        match target {
            Target::Tree(tree) => {
                let nodes = self.trees.parts[tree as usize].tree().map_or(&[][..], |t| t.nodes);
                Seen {
                    bounds: nodes.first().map_or(Aabb::EMPTY, Node::bounds),
                    padding: self.padding,
                    size: 1,
                    levels: 0,
                    depth: self.depths[tree as usize] + 2,
                    condition: 1.0,
                }
            }
            Target::Group(group) => {
                let group = &self.groups[group as usize];
                Seen {
                    bounds: group.bounds(),
                    padding: group.padding,
                    size: group.size,
                    levels: group.levels,
                    depth: group.depth,
                    condition: group.condition,
                }
            }
        }
    }
}
