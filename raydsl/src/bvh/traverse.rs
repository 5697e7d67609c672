//! Single-ray traversal of binary trees: the reference of every other traversal. `visit` also
//! enters wide trees.

use core::convert::identity;
use core::mem::MaybeUninit;

use super::contract::{
    Padding, SiblingSlabs, Slabs, is_before, is_finite, is_within, limit_behind,
};
use super::instances::Descent;
use super::view::{Branches, Finder};
use super::{Accelerator, MAX_DEPTH, Node, Part, Placed, SceneView};
use crate::Type;
use crate::geometry::{Hit, HitRecord, Primitive, Ray};
use crate::machine::Data;
use crate::run::fibers::NoYield;

/// Entries of a traversal stack: one for each level.
pub(crate) const STACK: usize = MAX_DEPTH + 2;

/// The traversal stack: pending nodes, and their entry distances.
///
/// Left uninitialised: clearing its kilobytes would cost a packet as much as a dozen nodes.
pub(super) struct Stack<E, const SIZE: usize = STACK> {
    top: usize,
    nodes: [MaybeUninit<u32>; SIZE],
    enters: [MaybeUninit<E>; SIZE],
}

impl<E: Copy, const SIZE: usize> Stack<E, SIZE> {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let (nodes, enters) = ([MaybeUninit::uninit(); SIZE], [MaybeUninit::uninit(); SIZE]);
        Self { top: 0, nodes, enters }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, node: u32, enter: E) {
        self.nodes[self.top].write(node);
        self.enters[self.top].write(enter);
        self.top += 1;
    }

    /// Returns the number of entries.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.top
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<(u32, E)> {
        self.top = self.top.checked_sub(1)?;
        // SAFETY: `push` alone raises `top`, after it has written the entry below.
        Some(unsafe { (self.nodes[self.top].assume_init(), self.enters[self.top].assume_init()) })
    }
}

/// A primitive that a ray may hit, and the ray in the space of its tree.
struct Candidate<'c, 'a, P: Primitive> {
    part: &'c Part<'a, P, P::Shared>,
    ray: &'c Ray,
    inst: u32,
    /// The id of the primitive in its part.
    id: u32,
}

impl<P: Primitive> Candidate<'_, '_, P> {
    #[inline(always)]
    fn intersect(&self) -> P::Hit {
        self.part.prims[self.id as usize].intersect(*self.ray, self.part.shared.slices())
    }

    /// Returns the hit with the ids of its primitive and its instance.
    #[inline(always)]
    fn with_ids(&self, hit: Hit) -> Hit {
        Hit { prim_id: self.part.first + self.id, inst_id: self.inst, ..hit }
    }
}

/// The cost of a traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Type)]
#[repr(C)]
pub struct Cost {
    /// Nodes whose box was tested.
    pub nodes: u32,
    /// Primitives that were intersected.
    pub primitives: u32,
}

impl core::ops::Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { nodes: self.nodes + other.nodes, primitives: self.primitives + other.primitives }
    }
}

/// A hit, and the cost of its traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct CountedHit {
    /// The hit.
    pub hit: Hit,
    /// The cost of the traversal.
    pub cost: Cost,
}

/// A counter of a traversal; [`Uncounted`] compiles to nothing.
trait Count {
    fn nodes(&mut self, _: u32) {}
    fn primitive(&mut self) {}
}

struct Uncounted;

impl Count for Uncounted {}

impl Count for Cost {
    fn nodes(&mut self, n: u32) {
        self.nodes += n;
    }

    fn primitive(&mut self) {
        self.primitives += 1;
    }
}

/// Finds the least `(t, id)` hit of `ray` among `prims`.
pub fn closest_hit<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> P::Hit {
    complete(prims, ray, nearest(prims, ray))
}

/// Finds the [`closest_hit`] without the rest of the record.
#[inline]
pub(crate) fn nearest<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> Hit {
    let of_wide = prims.queries().and_then(|queries| (queries.closest_of_one)(prims, ray));
    of_wide.unwrap_or_else(|| nearest_fallback(prims, ray))
}

/// Finds the [`nearest`] hit in binary trees, the fallback where there is no wide tree or the ray
/// is degenerate. A function of its own: packets whose rays are traced one by one share it at all
/// of their levels, and the ray stays in registers, since nothing else takes its address.
#[inline(never)]
fn nearest_fallback<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> Hit {
    closest(prims, ray, &mut Uncounted)
}

/// Completes the record of a hit, since traversals keep only the hit itself.
#[inline(always)]
pub(super) fn complete<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray, hit: Hit) -> P::Hit {
    let again = || {
        let ray = prims.local_ray(hit.inst_id, ray);
        prims.get(hit.prim_id).intersect(ray, prims.stored().slices())
    };
    P::Hit::complete(hit, again)
}

/// Finds the [`closest_hit`] and counts the cost.
pub fn closest_hit_with_cost<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> (P::Hit, Cost) {
    let CountedHit { hit, cost } = nearest_counted(prims, ray);
    (complete(prims, ray, hit), cost)
}

/// Does [`closest_hit_with_cost`] without the rest of the record. Packets of all levels share it.
#[inline(never)]
pub(crate) fn nearest_counted<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> CountedHit {
    let mut cost = Cost::default();
    let hit = closest(prims, ray, &mut cost);
    CountedHit { hit, cost }
}

#[inline(always)]
fn closest<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray, count: &mut impl Count) -> Hit {
    let mut best = Hit::miss();
    let slack = prims.padding().slack;
    traverse_all(
        prims,
        ray,
        count,
        #[inline(always)]
        |candidate, limit| {
            let hit = candidate.intersect().hit();
            // Most are misses, whose ids are not needed.
            if is_within(hit, ray) {
                let hit = candidate.with_ids(hit);
                if is_before(true, hit, best) {
                    best = hit;
                    *limit = limit_behind(hit.t, slack, ray.t_max);
                }
            }
            false
        },
    );
    best
}

/// Finds whether `ray` hits any of `prims`.
#[inline]
pub fn any_hit<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> bool {
    let of_wide = prims.queries().and_then(|queries| (queries.any_of_one)(prims, ray));
    of_wide.unwrap_or_else(|| any_fallback(prims, ray))
}

/// Finds whether `ray` hits anything in binary trees, as [`nearest_fallback`].
#[inline(never)]
fn any_fallback<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> bool {
    any(prims, ray, &mut Uncounted)
}

/// Finds [`any_hit`] and counts the cost.
pub fn any_hit_with_cost<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray) -> (bool, Cost) {
    let mut cost = Cost::default();
    let found = any(prims, ray, &mut cost);
    (found, cost)
}

#[inline(always)]
fn any<P: Primitive>(prims: &SceneView<'_, P>, ray: Ray, count: &mut impl Count) -> bool {
    traverse_all(
        prims,
        ray,
        count,
        #[inline(always)]
        |candidate, _| is_within(candidate.intersect().hit(), ray),
    )
}

/// Calls `meet` for every hit within the ray's range until it returns false. It may lower the limit
/// of the distance. Farther hits may come before nearer ones.
#[inline(always)]
pub(crate) fn visit<P: Primitive>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    mut meet: impl FnMut(Hit, P::Hit, &mut f32) -> bool,
) -> bool {
    let mut is_last = |candidate: &Candidate<'_, '_, P>, limit: &mut f32| {
        let record = candidate.intersect();
        let hit = candidate.with_ids(record.hit());
        is_within(hit, ray) && !meet(hit, record.with_hit(hit), limit)
    };
    if let Some(queries) = prims.queries() {
        let (mut limit, mut is_over) = (ray.t_max, false);
        let found = (queries.candidates)(prims, ray, &mut |part, id| {
            is_over = is_last(&Candidate { part, ray: &ray, inst: 0, id }, &mut limit);
            if is_over { f32::NEG_INFINITY } else { limit }
        });
        if found.is_some() {
            return !is_over;
        }
    }
    !traverse_all(prims, ray, &mut Uncounted, is_last)
}

/// Visits the primitives of a scene that the ray may hit, until `visit` returns true; returns
/// whether it did. `visit` may lower the limit of the distance. A ray with a component that is not
/// finite hits nothing.
#[inline(always)]
fn traverse_all<P: Primitive, C: Count>(
    prims: &SceneView<'_, P>,
    ray: Ray,
    count: &mut C,
    mut visit: impl FnMut(&Candidate<'_, '_, P>, &mut f32) -> bool,
) -> bool {
    // Nodes beyond this distance are culled.
    let mut limit = ray.t_max;
    let mut places = Places::new(prims, ray);
    while let Some((part, inst, ray)) = places.next(limit, count) {
        if traverse_part(&part, inst, &ray, &mut limit, count, &mut visit) {
            return true;
        }
    }
    false
}

/// Iterates over the parts of a scene, each with its instance id and the ray in its space.
enum Places<'a, P: Primitive> {
    Parts { scene: SceneView<'a, P>, next: usize, ray: Ray },
    Instances { placed: &'a Placed<'a, P, P::Shared>, descent: Box<Descent<'a>> },
}

impl<'a, P: Primitive> Places<'a, P> {
    #[inline(always)]
    fn new(scene: &SceneView<'a, P>, ray: Ray) -> Self {
        match scene.placed() {
            Some(placed) => Self::Instances { placed, descent: Descent::new(&placed.groups, ray) },
            None => {
                // A ray that is not finite begins after the last part.
                let next = if is_finite(ray) { 0 } else { usize::MAX };
                Self::Parts { scene: *scene, next, ray }
            }
        }
    }

    #[inline(always)]
    fn next(
        &mut self,
        limit: f32,
        count: &mut impl Count,
    ) -> Option<(Part<'a, P, P::Shared>, u32, Ray)> {
        match self {
            Self::Parts { scene, next, ray } => {
                let part = scene.part(*next)?;
                *next += 1;
                Some((part, 0, *ray))
            }
            Self::Instances { placed, descent } => {
                let place = descent.next(limit);
                count.nodes(core::mem::take(&mut descent.nodes));
                let place = place?;
                Some((placed.trees.parts[place.tree as usize], place.inst, place.ray))
            }
        }
    }
}

/// Does [`traverse_all`] in one part.
#[inline(always)]
fn traverse_part<P: Primitive, C: Count>(
    part: &Part<'_, P, P::Shared>,
    inst: u32,
    ray: &Ray,
    limit: &mut f32,
    count: &mut C,
    visit: &mut impl FnMut(&Candidate<'_, '_, P>, &mut f32) -> bool,
) -> bool {
    // A closure has an attribute only as an argument.
    let mut visit = identity(
        #[inline(always)]
        |id, limit: &mut f32, count: &mut C| {
            count.primitive();
            visit(&Candidate { part, ray, inst, id }, limit)
        },
    );
    let len = part.prims.len();
    match part.finder {
        Finder::Trees(trees) => {
            traverse(trees.branches(), ray, Padding::of::<P>(), limit, count, visit)
        }
        Finder::Accelerator(accelerator) => find(accelerator, len, ray, limit, count, visit),
        Finder::Nothing => (0..len as u32).any(|id| visit(id, limit, count)),
    }
}

/// Visits the candidates of an accelerator among `len` primitives, until `visit` returns true;
/// returns whether it did.
fn find<C: Count>(
    accelerator: &dyn Accelerator,
    len: usize,
    ray: &Ray,
    limit: &mut f32,
    count: &mut C,
    mut visit: impl FnMut(u32, &mut f32, &mut C) -> bool,
) -> bool {
    let mut stopped = false;
    // The queries of an accelerator are answered at once.
    let _no_yield = NoYield::begin();
    accelerator.candidates(ray, *limit, &mut |id| {
        // It may ignore the limit, or pass an id that does not exist.
        if !stopped && (id as usize) < len {
            stopped = visit(id, limit, count);
        }
        if stopped { f32::NEG_INFINITY } else { *limit }
    });
    stopped
}

/// Visits the primitives in the leaves that the ray enters, nearer children first, until `visit`
/// returns true; returns whether it did.
#[inline(always)]
fn traverse<C: Count>(
    tree: Branches<'_>,
    ray: &Ray,
    padding: Padding,
    limit: &mut f32,
    count: &mut C,
    mut visit: impl FnMut(u32, &mut f32, &mut C) -> bool,
) -> bool {
    let Some(root) = tree.nodes.first() else { return false };
    let slabs = Slabs::of(ray, root, padding);
    // Test the root.
    count.nodes(1);
    if slabs.enter(root, ray.t_min, *limit).is_none() {
        return false;
    }
    let slabs = SiblingSlabs::of(&slabs);
    let mut stack = Stack::<f32>::new();
    let mut node: &Node = root;
    loop {
        // Visit the primitives of a leaf.
        if node.is_leaf() {
            let (first, len) = (node.first as usize, node.count as usize);
            for &id in &tree.indices[first..first + len] {
                if visit(id, limit, count) {
                    return true;
                }
            }
        } else {
            // Test both children of an inner node.
            let children = &tree.nodes[node.first as usize..node.first as usize + 2];
            count.nodes(2);
            let pair = [&children[0], &children[1]];
            let [enters, leaves] = slabs.spans(pair, ray.t_min, *limit);
            match (enters[0] <= leaves[0], enters[1] <= leaves[1]) {
                (true, true) => {
                    // Push the farther child.
                    let near = usize::from(enters[1] < enters[0]);
                    stack.push(node.first + 1 - near as u32, enters[1 - near]);
                    node = &children[near];
                    continue;
                }
                (true, false) => {
                    node = &children[0];
                    continue;
                }
                (false, true) => {
                    node = &children[1];
                    continue;
                }
                (false, false) => {}
            }
        }
        // Pop the next node within the limit.
        node = loop {
            let Some((index, enter)) = stack.pop() else { return false };
            if enter <= *limit {
                break &tree.nodes[index as usize];
            }
        };
    }
}
