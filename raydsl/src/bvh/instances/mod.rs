//! Instances: trees placed in a scene many times.

mod buffers;
mod descent;
mod packet_descent;
mod placed;

use glam::Affine3;
use thiserror::Error;

use super::contract::Padding;
use super::traverse_packet::instance_table;
use super::{Bvh, BvhList, ListError, SceneView, View};
pub(crate) use buffers::{IS_INSTANCE, PLACE_SCHEMA};
pub(crate) use descent::Descent;
pub(crate) use packet_descent::PacketDescent;
pub(crate) use placed::{Placed, Placing, STACK, Target};

use crate::geometry::{Aabb, Hit, Primitive, SharedSlices};
use crate::machine::{Capture, Machine, Parameter, Resource};

/// Maximum number of levels of instances: a group of groups of trees has two.
pub const MAX_LEVELS: usize = 8;

/// Maximum condition number of a transform.
pub const MAX_CONDITION: f64 = 1e7;

/// Scene of instances: trees over primitives of one type, each placed any number of times, rotated,
/// scaled and sheared. Objects to place may be trees or [`Group`]s of placed trees.
///
/// A ray is transformed to the space of each object whose box it hits, so that a tree is in memory
/// once however often it is placed. The direction is not normalized there: `t` means the same
/// everywhere. A query returns the result over all copies: the least `(t, inst_id, prim_id)`.
/// [`Hit::inst_id`] counts the placed trees, those of the first instance of the outermost group
/// first; [`Hit::prim_id`] counts through the trees as in a [`BvhList`].
///
/// ```
/// use raydsl::prelude::*;
///
/// #[primitive(sphere(center, radius))]
/// struct Ball {
///     center: Vec3,
///     radius: f32,
/// }
///
/// let pearls = [0.0, 1.0, 2.0].map(|x| Ball { center: vec3(x, 0.0, 0.0), radius: 0.5 });
/// let trees = [Bvh::build(&pearls)?];
/// let place = |z, scale| {
///     let translation = vec3(0.0, 0.0, z);
///     Instance::new(0, Affine3 { translation, ..Affine3::from_scale(Vec3::splat(scale)) })
/// };
/// let scene = Instances::build(&trees, &[place(9.0, 1.0), place(5.0, 2.0)])?;
/// let hit = scene.closest_hit(Ray::new(vec3(2.0, 0.0, 0.0), Vec3::Z));
/// assert_eq!((hit.inst_id, hit.prim_id, hit.t), (1, 1, 4.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Rounding
///
/// Where a transform stretches directions by different amounts, rounding in the object is that much
/// larger in the scene: [`Instances::amplification`] returns the factor. Boxes are widened by as
/// much, so that hits do not depend on the tree over the instances.
#[derive(Debug)]
pub struct Instances<'a, P: Primitive> {
    placed: Placed<'a, P, P::Shared>,
    /// The instances of each group.
    groups: Vec<Vec<Instance>>,
}

/// Placed object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// The placed object.
    pub object: Object,
    /// Transform from the space of the object to that of its group or scene.
    pub to_outer: Affine3,
}

/// Object of an [`Instance`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Object {
    /// A tree, by its index in the scene.
    Tree(usize),
    /// All instances of a group.
    Group(Group),
}

/// Group of instances that can be placed as one, see [`Instances::group`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Id of the owning scene.
    scene: u64,
    index: u32,
}

impl Instance {
    /// Places an object: a tree by its index, or a [`Group`].
    pub fn new(object: impl Into<Object>, to_outer: Affine3) -> Self {
        Self { object: object.into(), to_outer }
    }
}

impl core::fmt::Display for Object {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Tree(tree) => write!(f, "tree {tree}"),
            Self::Group(group) => write!(f, "group {}", group.index),
        }
    }
}

impl From<usize> for Object {
    fn from(tree: usize) -> Self {
        Self::Tree(tree)
    }
}

impl From<Group> for Object {
    fn from(group: Group) -> Self {
        Self::Group(group)
    }
}

/// Error of placing instances.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InstanceError {
    /// The trees cannot form a list.
    #[error(transparent)]
    Trees(#[from] ListError),
    /// There is no such tree or group.
    #[error("instance {instance} places {object}, which the scene does not have before it")]
    NoSuchObject {
        /// Index of the instance in its group.
        instance: usize,
        /// The object it places.
        object: Object,
    },
    /// The group to be replaced belongs to another scene.
    #[error("the group belongs to another scene: keep what `group` of this one gave")]
    ForeignGroup,
    /// A transform is not finite or flattens its object.
    #[error(
        "the transform of instance {instance} is not finite or flattens the object: give one with \
         an inverse"
    )]
    NoInverse {
        /// Index of the instance in its group.
        instance: usize,
    },
    /// A transform stretches one direction far more than another.
    #[error(
        "the transform of instance {instance} stretches one direction {condition:.3e} times as much \
         as another: {limit:e} times is the most that `f32` can tell apart"
    )]
    IllConditioned {
        /// Index of the instance in its group.
        instance: usize,
        /// The condition number.
        condition: f64,
        /// Maximum condition number.
        limit: f64,
    },
    /// An instance is so large or so far away that its box is not finite.
    #[error("instance {instance} reaches beyond the largest `f32`: make it smaller")]
    TooLarge {
        /// Index of the instance in its group.
        instance: usize,
    },
    /// There are more placed trees than 32-bit ids.
    #[error("the trees are placed {count} times in all: {limit} can be numbered")]
    TooMany {
        /// Number of placed trees.
        count: u64,
        /// Maximum number of placed trees.
        limit: u64,
    },
    /// There are more levels than [`MAX_LEVELS`], or the trees are too deep for them.
    #[error(
        "the group has {levels} levels of instances and {depth} of nodes: {level_limit} and \
         {depth_limit} are the most; place the trees in fewer groups"
    )]
    TooDeep {
        /// Number of levels of instances.
        levels: usize,
        /// Number of levels of nodes in all of them.
        depth: usize,
        /// Maximum number of levels of instances.
        level_limit: usize,
        /// Maximum number of levels of nodes.
        depth_limit: usize,
    },
}

impl<'a, P: Primitive> Instances<'a, P> {
    /// Creates a scene of these instances of trees.
    ///
    /// # Errors
    ///
    /// As [`Instances::new`] and [`Instances::group`].
    pub fn build(trees: &'a [Bvh<'a, P>], instances: &[Instance]) -> Result<Self, InstanceError> {
        let mut scene = Self::new(trees)?;
        scene.group(instances)?;
        Ok(scene)
    }

    /// Creates an empty scene in which these trees can be placed.
    ///
    /// # Errors
    ///
    /// As [`BvhList::new`].
    pub fn new(trees: &'a [Bvh<'a, P>]) -> Result<Self, InstanceError> {
        let trees = BvhList::new(trees)?.into_trees();
        let placed = Placed::new(trees, Padding::of::<P>(), instance_table::<P>());
        Ok(Self { placed, groups: Vec::new() })
    }

    /// Adds a group of instances of trees and of earlier groups. Rays are traced against the group
    /// added last, with everything in it.
    ///
    /// ```
    /// # use raydsl::prelude::*;
    /// # #[primitive(sphere(center, radius))]
    /// # struct Ball { center: Vec3, radius: f32 }
    /// # let leaves = [Ball { center: Vec3::ZERO, radius: 1.0 }];
    /// let trees = [Bvh::build(&leaves)?];
    /// let mut scene = Instances::new(&trees)?;
    /// let at = |x: f32, y: f32| Affine3::from_translation(vec3(x, y, 0.0));
    /// let row: Vec<_> = (0..100).map(|i| Instance::new(0, at(3.0 * i as f32, 0.0))).collect();
    /// let row = scene.group(&row)?;
    /// let field: Vec<_> = (0..100).map(|i| Instance::new(row, at(0.0, 3.0 * i as f32))).collect();
    /// scene.group(&field)?;
    /// assert_eq!(scene.count(), 10_000);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If an object does not exist; a transform has no inverse, or a condition number above
    /// [`MAX_CONDITION`]; boxes exceed `f32`; or there are more instances, or levels of them, than
    /// can be numbered. The scene is then unchanged.
    pub fn group(&mut self, instances: &[Instance]) -> Result<Group, InstanceError> {
        let group = self.make(instances, self.groups.len())?;
        self.placed.groups.push(group);
        self.placed.version += 1;
        self.groups.push(instances.to_vec());
        Ok(Group { scene: self.id(), index: self.groups.len() as u32 - 1 })
    }

    /// Replaces the instances of a group: they may move, appear and disappear. The trees over the
    /// groups that contain it are rebuilt too. Those of primitives stay as they are; a device keeps
    /// the primitives, and is sent nodes, indices and places.
    ///
    /// # Errors
    ///
    /// As [`Instances::group`]; also for a group of another scene. The scene is then unchanged. If a
    /// group that contains this one cannot be built, the error names one of *its* instances.
    pub fn set_group(&mut self, group: Group, instances: &[Instance]) -> Result<(), InstanceError> {
        let at = group.index as usize;
        if group.scene != self.id() {
            return Err(InstanceError::ForeignGroup);
        }
        let instances_before = core::mem::replace(&mut self.groups[at], instances.to_vec());
        let mut before: Vec<(usize, Placing)> = Vec::new();
        let mut is_changed = vec![false; self.groups.len()];
        for k in at..self.groups.len() {
            let contains_changed = |instance: &Instance| match instance.object {
                Object::Group(group) => is_changed.get(group.index as usize) == Some(&true),
                Object::Tree(_) => false,
            };
            if k != at && !self.groups[k].iter().any(contains_changed) {
                continue;
            }
            match self.make(&self.groups[k], k) {
                Ok(made) => before.push((k, core::mem::replace(&mut self.placed.groups[k], made))),
                Err(error) => {
                    for (k, group) in before {
                        self.placed.groups[k] = group;
                    }
                    self.groups[at] = instances_before;
                    return Err(error);
                }
            }
            is_changed[k] = true;
        }
        self.placed.version += 1;
        Ok(())
    }

    /// Returns the unique id of the scene.
    fn id(&self) -> u64 {
        self.placed.trees.owner.id()
    }

    /// Builds the tree over a group, which may contain earlier groups.
    fn make(&self, instances: &[Instance], groups: usize) -> Result<Placing, InstanceError> {
        let items =
            instances.iter().enumerate().map(|(instance, &Instance { object, to_outer })| {
                let target = match object {
                    Object::Tree(tree) if tree < self.placed.trees.parts.len() => {
                        Target::Tree(tree as u32)
                    }
                    Object::Group(Group { scene, index })
                        if scene == self.id() && (index as usize) < groups =>
                    {
                        Target::Group(index)
                    }
                    _ => return Err(InstanceError::NoSuchObject { instance, object }),
                };
                placed::Placement::new(instance, target, to_outer)
            });
        Placing::build(&self.placed, &items.collect::<Result<Vec<_>, _>>()?)
    }

    /// Returns the number of placed trees, counting every copy: one more than the largest
    /// [`Hit::inst_id`].
    pub fn count(&self) -> u32 {
        self.placed.top().map_or(0, |top| top.size)
    }

    /// Returns the number of groups.
    pub fn group_count(&self) -> usize {
        self.groups.len()
    }

    /// Returns the instances of a group.
    ///
    /// # Panics
    ///
    /// If it is a group of another scene.
    pub fn instances_of(&self, group: Group) -> &[Instance] {
        assert_eq!(group.scene, self.id(), "the group belongs to another scene");
        &self.groups[group.index as usize]
    }

    /// Returns the instance that was hit on every level: its index in the outermost group, then its
    /// index in the group placed there, and so on. Empty for a miss.
    pub fn path_of(&self, hit: Hit) -> Vec<usize> {
        let mut path = Vec::new();
        if hit.is_hit {
            self.placed.each_level(hit.inst_id, |index, _| path.push(index));
        }
        path
    }

    /// Returns the index of the tree that holds the hit primitive; `None` for a miss.
    pub fn tree_of(&self, hit: Hit) -> Option<usize> {
        hit.is_hit.then(|| super::list::tree_of(&self.placed.trees.parts, hit.prim_id))
    }

    /// Returns the id of the first primitive of a tree.
    ///
    /// # Panics
    ///
    /// If the scene has no such tree.
    pub fn first_of(&self, tree: usize) -> u32 {
        self.placed.trees.parts[tree].first
    }

    /// Returns an upper bound of the amplification of an object's rounding in the scene: the
    /// largest product of the transforms' condition numbers on a path to a tree. 1 for rigid
    /// transforms and uniform scales.
    pub fn amplification(&self) -> f64 {
        self.placed.top().map_or(1.0, |top| top.condition)
    }

    /// Returns the bounds of the scene, widened for rounding; empty without primitives.
    pub fn bounds(&self) -> Aabb {
        self.placed.top().map_or(Aabb::EMPTY, Placing::bounds)
    }

    /// Returns the size in bytes of the instances and of the trees over them; the application owns
    /// the trees and the primitives.
    pub fn bytes(&self) -> usize {
        let groups = self.groups.iter().map(|group| size_of_val(&group[..]));
        groups.chain(self.placed.groups.iter().map(Placing::bytes)).sum()
    }

    /// Returns the data that the primitives of all trees share.
    pub fn shared(&self) -> SharedSlices<'a, P> {
        self.placed.trees.shared.slices()
    }

    /// Returns the view that kernels query.
    pub fn view(&self) -> SceneView<'_, P> {
        View::instances(&self.placed)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Capture<M> for Instances<'_, P> {
    type On<'c>
        = SceneView<'c, P>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, _: &M, name: &'static str) -> SceneView<'c, P> {
        self.view().named(name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, _: &M) -> SceneView<'c, P> {
        self.view()
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.view().named(name));
    }
}

impl<P: Primitive> Parameter for Instances<'_, P> {
    type On<'a, M: Machine> = SceneView<'a, P>;
}
