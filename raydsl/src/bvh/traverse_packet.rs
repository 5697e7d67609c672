//! SIMD packet traversal of binary trees: one stack for all lanes, with an active mask.

use core::any::Any;
use core::marker::PhantomData;

use super::contract::{Padding, is_finite, is_within, limit_behind, precedes};
use super::instances::PacketDescent;
use super::packet_slabs::{PacketSlabs, and, min, or, without};
use super::traverse::Stack;
use super::view::Branches;
use super::{
    CountedHit, CountedHitOn, Part, Placed, RecordOn, RecordedQueries, SceneView, traverse,
};
use crate::geometry::{Hit, HitOn, HitRecord, Primitive, Ray, RayOn, SharedViews};
use crate::machine::{B, Entered, F, Lanes, Packet, Place, Type, U, V3, Value, op};
use crate::run::{Lanes4, Lanes8, Lanes16};

/// The machine of the inner loops: its kernels are inlined, so that values stay in registers.
type Inner<L> = Packet<Entered<L>>;

/// Converts rays to the machine of the inner loops.
#[inline(always)]
fn inner_ray<L: Lanes>(ray: &RayOn<Packet<L>>) -> RayOn<Inner<L>> {
    RayOn {
        origin: V3::from_array(ray.origin.array()),
        direction: V3::from_array(ray.direction.array()),
        t_min: F(ray.t_min.0),
        t_max: F(ray.t_max.0),
    }
}

/// The least `(t, inst_id, prim_id)` of the hits so far. A lane without one has infinity and the
/// last ids, which every hit precedes.
struct Best<L: Lanes> {
    t: L::F32,
    inst: L::U32,
    id: L::U32,
    u: L::F32,
    v: L::F32,
    found: L::Mask,
    /// The distance beyond which nodes are culled for a lane.
    limit: L::F32,
    /// How far behind a hit nodes are still visited, relative to its distance.
    slack: f32,
}

/// A primitive that some lanes may hit, and the rays in the space of its tree.
struct Candidate<'c, 'a, L: Lanes, P: Primitive> {
    part: &'c Part<'a, P, P::Shared>,
    ray: &'c RayOn<Packet<L>>,
    shared: SharedViews<'a, P>,
    inst: u32,
    /// The id of the primitive in its part.
    id: u32,
}

impl<L: Lanes, P: Primitive> Candidate<'_, '_, L, P> {
    #[inline(always)]
    fn intersect(&self, m: &Packet<L>, mask: L::Mask) -> RecordOn<Packet<L>, P> {
        m.with_active(
            mask,
            #[inline(always)]
            || {
                let prim = &self.part.prims[self.id as usize];
                P::intersect_one_on(m, prim, *self.ray, self.shared)
            },
        )
    }

    /// Returns the hit with the ids of its primitive and its instance.
    #[inline(always)]
    fn with_ids(&self, l: L, hit: HitOn<Packet<L>>) -> HitOn<Packet<L>> {
        let prim_id = U(l.u32(self.part.first + self.id));
        HitOn { prim_id, inst_id: U(l.u32(self.inst)), ..hit }
    }
}

/// Finds the least `(t, id)` hit of every active lane.
///
/// A function of its own for each kind of packet and primitive, so that kernels with many queries
/// stay small.
#[inline(never)]
pub(crate) fn closest_hit<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: RayOn<Packet<L>>,
) -> HitOn<Packet<L>> {
    m.lanes().vectorize(
        #[inline(always)]
        || {
            if prims.is_standing() {
                return each_lane(m, Hit::miss(), ray, |ray| traverse::nearest(prims, ray));
            }
            if let Some(placed) = prims.placed() {
                return match InstanceQueries::<L, P>::of(placed) {
                    Some(queries) => (queries.closest_hit)(m, prims, &ray),
                    None => each_lane(m, Hit::miss(), ray, |ray| traverse::nearest(prims, ray)),
                };
            }
            closest_hit_inside(m, prims, &ray, |_, ray, _| Parts {
                scene: *prims,
                next: 0,
                ray: *ray,
            })
        },
    )
}

/// Finds the [`closest_hit`] and the cost of each lane, one after another: the nodes that a packet
/// visits are those of all of its lanes.
#[inline(never)]
pub(crate) fn closest_hit_with_cost<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: RayOn<Packet<L>>,
) -> CountedHitOn<Packet<L>> {
    m.lanes().vectorize(
        #[inline(always)]
        || each_lane(m, CountedHit::default(), ray, |ray| traverse::nearest_counted(prims, ray)),
    )
}

/// Does [`closest_hit`] in the lanes of the inner loops. `places` returns the parts of the scene
/// for the rays of some lanes.
#[inline(always)]
fn closest_hit_inside<'a, L: Lanes, P: Primitive, W: Places<'a, Entered<L>, P>>(
    m: &Packet<L>,
    prims: &SceneView<'a, P>,
    ray: &RayOn<Packet<L>>,
    places: impl FnOnce(Entered<L>, &RayOn<Inner<L>>, L::Mask) -> W,
) -> HitOn<Packet<L>> {
    let m = &Packet::with_mask(Entered::new(m.lanes()), m.active());
    let (l, ray) = (m.lanes(), inner_ray(ray));
    let zero = l.f32(0.0);
    let mut best = Best {
        t: l.f32(f32::INFINITY),
        inst: l.u32(if W::HAVE_INSTANCES { u32::MAX } else { 0 }),
        id: l.u32(u32::MAX),
        u: zero,
        v: zero,
        found: l.mask(false),
        limit: ray.t_max.0,
        slack: prims.padding().slack,
    };
    traverse_all(
        m,
        prims,
        &ray,
        places,
        #[inline(always)]
        |candidate, mask, limit| {
            update_best::<_, P, W>(m, candidate, mask, &mut best);
            *limit = best.limit;
            mask
        },
    );
    HitOn {
        is_hit: B(best.found),
        t: F(l.f32_select(best.found, best.t, zero)),
        prim_id: U(l.u32_select(best.found, best.id, l.u32(0))),
        inst_id: U(l.u32_select(best.found, best.inst, l.u32(0))),
        u: F(best.u),
        v: F(best.v),
    }
}

/// Tests one primitive, and updates the best hit of the lanes where it is closer.
#[inline(always)]
fn update_best<'a, L: Lanes, P: Primitive, W: Places<'a, L, P>>(
    m: &Packet<L>,
    candidate: &Candidate<'_, '_, L, P>,
    mask: L::Mask,
    best: &mut Best<L>,
) {
    let (l, ray) = (m.lanes(), *candidate.ray);
    let hit = candidate.with_ids(l, P::Hit::hit_on(candidate.intersect(m, mask)));
    // Intersect, and return early if no lane is hit.
    let t_max = F(min(l, ray.t_max.0, best.t));
    let hits = and(l, mask, is_within::on(m, hit, RayOn { t_max, ..ray }).0);
    if !l.any(hits) {
        return;
    }
    // Update the lanes with a closer hit.
    let before = HitOn { t: F(best.t), prim_id: U(best.id), inst_id: U(best.inst), ..hit };
    let is_closer = and(l, hits, precedes::on(m, W::HAVE_INSTANCES, hit, before).0);
    best.t = l.f32_select(is_closer, hit.t.0, best.t);
    if const { W::HAVE_INSTANCES } {
        best.inst = l.u32_select(is_closer, hit.inst_id.0, best.inst);
    }
    best.id = l.u32_select(is_closer, hit.prim_id.0, best.id);
    best.u = l.f32_select(is_closer, hit.u.0, best.u);
    best.v = l.f32_select(is_closer, hit.v.0, best.v);
    best.found = or(l, best.found, is_closer);
    best.limit = limit_behind::on(m, F(best.t), F(l.f32(best.slack)), ray.t_max).0;
}

/// Finds whether each active lane hits anything. Lanes with a hit become inactive.
#[inline(never)]
pub(crate) fn any_hit<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: RayOn<Packet<L>>,
) -> B<Packet<L>> {
    m.lanes().vectorize(
        #[inline(always)]
        || {
            if prims.is_standing() {
                return each_lane(m, false, ray, |ray| traverse::any_hit(prims, ray));
            }
            if let Some(placed) = prims.placed() {
                return match InstanceQueries::<L, P>::of(placed) {
                    Some(queries) => (queries.any_hit)(m, prims, &ray),
                    None => each_lane(m, false, ray, |ray| traverse::any_hit(prims, ray)),
                };
            }
            any_hit_inside(m, prims, &ray, |_, ray, _| Parts { scene: *prims, next: 0, ray: *ray })
        },
    )
}

/// Does [`any_hit`] in the lanes of the inner loops, as [`closest_hit_inside`].
#[inline(always)]
fn any_hit_inside<'a, L: Lanes, P: Primitive, W: Places<'a, Entered<L>, P>>(
    m: &Packet<L>,
    prims: &SceneView<'a, P>,
    ray: &RayOn<Packet<L>>,
    places: impl FnOnce(Entered<L>, &RayOn<Inner<L>>, L::Mask) -> W,
) -> B<Packet<L>> {
    let m = &Packet::with_mask(Entered::new(m.lanes()), m.active());
    let (l, ray) = (m.lanes(), inner_ray(ray));
    let mut found = l.mask(false);
    traverse_all(
        m,
        prims,
        &ray,
        places,
        #[inline(always)]
        |candidate, mask, _| {
            let hit = P::Hit::hit_on(candidate.intersect(m, mask));
            found = or(l, found, and(l, mask, is_within::on(m, hit, ray).0));
            without(l, mask, found)
        },
    );
    B(found)
}

/// Calls `meet` for every hit within a lane's range, in the lanes with that hit, until it returns
/// false there.
#[inline(always)]
pub(crate) fn visit<'a, L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'a, P>,
    ray: RayOn<Packet<L>>,
    limit: impl Fn() -> F<Packet<L>>,
    meet: impl Fn(HitOn<Packet<L>>, RecordOn<Packet<L>, P>) -> B<Packet<L>>,
) {
    if prims.is_standing() || prims.queries().is_some() {
        return visit_each_lane(m, prims, ray, &limit, &meet);
    }
    let l = m.lanes();
    traverse_all(
        m,
        prims,
        &ray,
        #[inline(always)]
        |l, ray, active| match prims.placed() {
            Some(placed) => Either::Placed(Located::new(l, placed, ray, active)),
            None => Either::Parts(Parts { scene: *prims, next: 0, ray: *ray }),
        },
        #[inline(always)]
        |candidate, mask, end| {
            let record = candidate.intersect(m, mask);
            let hit = candidate.with_ids(l, P::Hit::hit_on(record));
            let hits = and(l, mask, is_within::on(m, hit, ray).0);
            if !l.any(hits) {
                return mask;
            }
            let goes_on = m.with_active(
                hits,
                #[inline(always)]
                || meet(hit, P::Hit::with_hit_on(record, hit)).0,
            );
            *end = limit().0;
            without(l, mask, without(l, hits, goes_on))
        },
    );
}

/// Runs a single-ray query for each active lane; the others have the result `other`.
#[inline(always)]
fn each_lane<L: Lanes, T: Type>(
    m: &Packet<L>,
    other: T,
    ray: RayOn<Packet<L>>,
    query: impl Fn(Ray) -> T,
) -> T::On<Packet<L>> {
    m.of_running(
        other,
        #[inline(always)]
        |lane| query(Ray::lane::<Packet<L>>(&ray, lane)),
    )
}

/// Does [`visit`] for one lane after another.
fn visit_each_lane<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: RayOn<Packet<L>>,
    limit: &impl Fn() -> F<Packet<L>>,
    meet: &impl Fn(HitOn<Packet<L>>, RecordOn<Packet<L>, P>) -> B<Packet<L>>,
) {
    let l = m.lanes();
    let active = l.bits(m.active());
    for lane in (0..L::N).filter(|lane| active >> lane & 1 != 0) {
        let mask = l.mask_from_bits(1 << lane);
        traverse::visit::<P>(prims, Ray::lane::<Packet<L>>(&ray, lane), |hit, record, end| {
            let (hit, record) = (Hit::splat(m, hit), P::Hit::splat(m, record));
            l.enter_again(|| {
                let goes_on = m.with_active(mask, || and(l, mask, meet(hit, record).0));
                *end = L::f32_lane(&limit().0, lane);
                l.any(goes_on)
            })
        });
    }
}

/// The places of traversals in reports of utilisation, which are not in the user's source.
const NODES: Place = Place { what: "nodes of trees", file: "", line: 0 };
const PRIMITIVES: Place = Place { what: "primitives in leaves", file: "", line: 0 };

/// Visits the primitives of a scene that some active lane may hit. `visit` takes the active mask,
/// may lower the limits of lanes, and returns the lanes that stay active. Rays with a component
/// that is not finite hit nothing.
#[inline(always)]
fn traverse_all<'a, L: Lanes, P: Primitive, W: Places<'a, L, P>>(
    m: &Packet<L>,
    prims: &SceneView<'a, P>,
    ray: &RayOn<Packet<L>>,
    places: impl FnOnce(L, &RayOn<Packet<L>>, L::Mask) -> W,
    mut visit: impl FnMut(&Candidate<'_, '_, L, P>, L::Mask, &mut L::F32) -> L::Mask,
) {
    let l = m.lanes();
    let shared = prims.stored().views();
    let mut limit = ray.t_max.0;
    let mut active = and(l, m.active(), is_finite::on(m, *ray).0);
    let mut places = places(l, ray, active);
    while l.any(active)
        && let Some((part, inst, ray, mask)) = places.next(l, active, limit)
    {
        let mut still_active = mask;
        traverse_part(
            m,
            &part,
            &ray,
            &mut still_active,
            &mut limit,
            #[inline(always)]
            |id, mask, limit| {
                visit(&Candidate { part: &part, ray: &ray, shared, inst, id }, mask, limit)
            },
        );
        active = without(l, active, without(l, mask, still_active));
    }
}

/// Iterates over the parts of a scene, each with its instance id, the rays in its space, and the
/// active mask.
trait Places<'a, L: Lanes, P: Primitive> {
    /// Whether primitives have instance ids.
    const HAVE_INSTANCES: bool;

    /// Returns the next part that active lanes may enter within their limits.
    fn next(&mut self, l: L, active: L::Mask, limit: L::F32) -> Option<PacketPart<'a, L, P>>;
}

/// An item of [`Places`].
type PacketPart<'a, L, P> =
    (Part<'a, P, <P as Primitive>::Shared>, u32, RayOn<Packet<L>>, <L as Lanes>::Mask);

/// The parts of a scene without instances.
struct Parts<'a, L: Lanes, P: Primitive> {
    scene: SceneView<'a, P>,
    next: usize,
    ray: RayOn<Packet<L>>,
}

impl<'a, L: Lanes, P: Primitive> Places<'a, L, P> for Parts<'a, L, P> {
    const HAVE_INSTANCES: bool = false;

    #[inline(always)]
    fn next(&mut self, _: L, active: L::Mask, _: L::F32) -> Option<PacketPart<'a, L, P>> {
        let part = self.scene.part(self.next)?;
        self.next += 1;
        Some((part, 0, self.ray, active))
    }
}

/// The trees of a scene of instances.
struct Located<'a, L: Lanes, P: Primitive> {
    placed: &'a Placed<'a, P, P::Shared>,
    descent: Box<PacketDescent<'a, L>>,
}

impl<'a, L: Lanes, P: Primitive> Located<'a, L, P> {
    #[inline(always)]
    fn new(
        l: L,
        placed: &'a Placed<'a, P, P::Shared>,
        ray: &RayOn<Packet<L>>,
        active: L::Mask,
    ) -> Self {
        Self { placed, descent: PacketDescent::new(l, &placed.groups, ray, active) }
    }
}

impl<'a, L: Lanes, P: Primitive> Places<'a, L, P> for Located<'a, L, P> {
    const HAVE_INSTANCES: bool = true;

    #[inline(always)]
    fn next(&mut self, l: L, active: L::Mask, limit: L::F32) -> Option<PacketPart<'a, L, P>> {
        let place = self.descent.next(l, active, limit)?;
        let part = self.placed.trees.parts[place.tree as usize];
        Some((part, place.inst, place.ray, place.mask))
    }
}

/// The parts of any scene.
enum Either<'a, L: Lanes, P: Primitive> {
    Parts(Parts<'a, L, P>),
    Placed(Located<'a, L, P>),
}

impl<'a, L: Lanes, P: Primitive> Places<'a, L, P> for Either<'a, L, P> {
    const HAVE_INSTANCES: bool = true;

    #[inline(always)]
    fn next(&mut self, l: L, active: L::Mask, limit: L::F32) -> Option<PacketPart<'a, L, P>> {
        match self {
            Self::Parts(parts) => parts.next(l, active, limit),
            Self::Placed(located) => located.next(l, active, limit),
        }
    }
}

/// The packet traversals of scenes of instances, for one kind of lanes.
///
/// They are as much code as those of single trees. Only the tables of
/// [`Instances`](super::Instances) refer to them: a program without instances is compiled without
/// them.
struct InstanceQueries<L: Lanes, P: Primitive> {
    closest_hit: InstanceQuery<L, P, HitOn<Packet<L>>>,
    any_hit: InstanceQuery<L, P, B<Packet<L>>>,
}

type InstanceQuery<L, P, R> = fn(&Packet<L>, &SceneView<'_, P>, &RayOn<Packet<L>>) -> R;

/// The [`InstanceQueries`] of some kinds of lanes, and [`RecordedQueries`].
pub(crate) type InstanceTable = &'static [&'static (dyn Any + Send + Sync)];

/// Returns the traversals for all lanes of kernels, and for recorders.
pub(crate) fn instance_table<P: Primitive>() -> InstanceTable {
    struct Of<P>(PhantomData<P>);
    impl<P: Primitive> Of<P> {
        const TABLE: InstanceTable = &[
            &InstanceQueries::<Lanes4, P>::NEW,
            &InstanceQueries::<Lanes8, P>::NEW,
            &InstanceQueries::<Lanes16, P>::NEW,
            &RecordedQueries::<P>::NEW,
        ];
    }
    Of::<P>::TABLE
}

impl<L: Lanes, P: Primitive> InstanceQueries<L, P> {
    const NEW: Self =
        Self { closest_hit: closest_hit_placed::<L, P>, any_hit: any_hit_placed::<L, P> };

    /// Returns the traversals for these lanes; none where no kernel is lifted for them.
    #[inline(always)]
    fn of<'w>(placed: &Placed<'w, P, P::Shared>) -> Option<&'w Self> {
        if const { L::HAS_TABLES } {
            placed.queries.iter().find_map(|queries| queries.downcast_ref())
        } else {
            Some(const { &Self::NEW })
        }
    }
}

fn closest_hit_placed<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: &RayOn<Packet<L>>,
) -> HitOn<Packet<L>> {
    m.lanes().vectorize(
        #[inline(always)]
        || {
            let Some(placed) = prims.placed() else { return HitOn::zero(m) };
            closest_hit_inside(m, prims, ray, |l, ray, active| Located::new(l, placed, ray, active))
        },
    )
}

fn any_hit_placed<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: &RayOn<Packet<L>>,
) -> B<Packet<L>> {
    m.lanes().vectorize(
        #[inline(always)]
        || {
            let Some(placed) = prims.placed() else { return B::zero(m) };
            any_hit_inside(m, prims, ray, |l, ray, active| Located::new(l, placed, ray, active))
        },
    )
}

/// Does [`traverse_all`] in one part: visits the primitives in the leaves that some active lane enters,
/// until no lane is active.
#[inline(always)]
fn traverse_part<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    part: &Part<'_, P, P::Shared>,
    ray: &RayOn<Packet<L>>,
    active: &mut L::Mask,
    limit: &mut L::F32,
    mut visit: impl FnMut(u32, L::Mask, &mut L::F32) -> L::Mask,
) {
    let l = m.lanes();
    let mut stack = Stack::new();
    // A slice is one leaf, which every ray enters.
    let mut leaf = Leaf { begin: 0, end: part.prims.len(), mask: *active };
    let mut descent = None;
    if let Some(tree) = part.tree() {
        let Some(root) = tree.nodes.first() else { return };
        let slabs = PacketSlabs::new(l, ray, *active, root, Padding::of::<P>());
        let (enter, hit) = slabs.enter(l, root, *limit);
        push(l, &mut stack, 0, enter, hit);
        (leaf, descent) = (Leaf { end: 0, ..leaf }, Some(Descent { tree, slabs }));
    }
    loop {
        // Visit the primitives of the leaf, until no lane in it is active.
        for place in leaf.begin..leaf.end {
            let id = match &descent {
                Some(descent) => {
                    l.at(PRIMITIVES, leaf.mask);
                    descent.tree.indices[place]
                }
                None => place as u32,
            };
            let stay = visit(id, leaf.mask, limit);
            // A lane that is done becomes inactive.
            *active = without(l, *active, without(l, leaf.mask, stay));
            leaf.mask = stay;
            if !l.any(leaf.mask) {
                break;
            }
        }
        let Some(descent) = descent.as_ref().filter(|_| l.any(*active)) else { return };
        let Some(next) = descent.next_leaf(l, &mut stack, *active, *limit) else { return };
        leaf = next;
    }
}

/// A range of a list of primitives, and the lanes that may hit them.
struct Leaf<L: Lanes> {
    begin: usize,
    end: usize,
    mask: L::Mask,
}

/// The descent through one tree.
struct Descent<'t, L: Lanes> {
    tree: Branches<'t>,
    slabs: PacketSlabs<L>,
}

/// The stack of pending nodes, and the entry distances of each lane.
type Pending<L> = Stack<<L as Lanes>::F32>;

/// Pushes a node. Lanes that do not enter it have the entry distance NaN, which is within no limit.
#[inline(always)]
fn push<L: Lanes>(l: L, stack: &mut Pending<L>, node: u32, enter: L::F32, hit: L::Mask) {
    stack.push(node, l.f32_select(hit, enter, l.f32(f32::NAN)));
}

impl<L: Lanes> Descent<'_, L> {
    /// Returns the next leaf that some active lane enters within its limit.
    #[inline(always)]
    fn next_leaf(
        &self,
        l: L,
        stack: &mut Pending<L>,
        active: L::Mask,
        limit: L::F32,
    ) -> Option<Leaf<L>> {
        loop {
            let (index, enter) = stack.pop()?;
            let mut mask = and(l, active, l.f32_compare(op::Le, enter, limit));
            if !l.any(mask) {
                continue;
            }
            let mut node = &self.tree.nodes[index as usize];
            loop {
                l.at(NODES, mask);
                if node.is_leaf() {
                    let begin = node.first as usize;
                    return Some(Leaf { begin, end: begin + node.count as usize, mask });
                }
                let children = &self.tree.nodes[node.first as usize..node.first as usize + 2];
                // Test both children.
                let (t0, hit0) = self.slabs.enter(l, &children[0], limit);
                let (t1, hit1) = self.slabs.enter(l, &children[1], limit);
                let (hit0, hit1) = (and(l, mask, hit0), and(l, mask, hit1));
                let is_first = match (l.any(hit0), l.any(hit1)) {
                    (true, true) => {
                        // Visit first the child that most lanes enter first.
                        let both = and(l, hit0, hit1);
                        let left = and(l, both, l.f32_compare(op::Le, t0, t1));
                        let is_first = 2 * l.bits(left).count_ones() >= l.bits(both).count_ones();
                        if is_first {
                            push(l, stack, node.first + 1, t1, hit1);
                        } else {
                            push(l, stack, node.first, t0, hit0);
                        }
                        is_first
                    }
                    (false, false) => break,
                    (is_first, _) => is_first,
                };
                (node, mask) = if is_first { (&children[0], hit0) } else { (&children[1], hit1) };
            }
        }
    }
}
