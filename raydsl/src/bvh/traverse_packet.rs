//! Traversal for packets: one stack for all lanes, a mask of those that a node concerns.

use core::any::Any;
use core::marker::PhantomData;

use super::contract::{Padding, is_finite, is_within, limit_behind, precedes};
use super::instances::PacketDescent;
use super::packet_slabs::{PacketSlabs, and, min, or, without};
use super::traverse::Stack;
use super::view::Branches;
use super::{CountedHit, CountedHitOn, Part, Placed, RecordOn, RecordedWalks, SceneView, traverse};
use crate::geometry::{Hit, HitOn, HitRecord, Primitive, Ray, RayOn};
use crate::machine::{B, Entered, F, Lanes, Packet, Place, Slice, Type, U, V3, Value, op};
use crate::run::{Lanes4, Lanes8, Lanes16};

/// The machine of the loops: its kernels are inlined, so that nothing travels through memory.
type Inner<L> = Packet<Entered<L>>;

/// The same rays on the machine of the loops.
#[inline(always)]
fn inner_ray<L: Lanes>(ray: &RayOn<Packet<L>>) -> RayOn<Inner<L>> {
    RayOn {
        origin: V3::from_array(ray.origin.array()),
        direction: V3::from_array(ray.direction.array()),
        t_min: F(ray.t_min.0),
        t_max: F(ray.t_max.0),
    }
}

/// The least `(t, inst_id, prim_id)` of the hits seen so far. A lane without one has infinity and
/// the last numbers, which every hit beats.
struct Best<L: Lanes> {
    t: L::F32,
    inst: L::U32,
    id: L::U32,
    u: L::F32,
    v: L::F32,
    found: L::Mask,
    /// No node beyond this distance is worth a lane's visit.
    limit: L::F32,
    /// How far behind a hit nodes are still visited, relative to its distance.
    slack: f32,
}

/// A primitive that some lanes may meet, and the rays as its tree is asked about them.
struct Candidate<'c, 'a, L: Lanes, P: Primitive> {
    part: &'c Part<'a, P, P::Shared>,
    ray: &'c RayOn<Packet<L>>,
    shared: Slice<'c, P::Shared>,
    inst: u32,
    /// Its place in its part.
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

    /// The hit under its primitive's number.
    #[inline(always)]
    fn numbered(&self, l: L, hit: HitOn<Packet<L>>) -> HitOn<Packet<L>> {
        let prim_id = U(l.u32(self.part.first + self.id));
        HitOn { prim_id, inst_id: U(l.u32(self.inst)), ..hit }
    }
}

/// The least `(t, id)` hit of every running lane.
///
/// A function of its own for each kind of packet and primitive, so that a kernel may ask often.
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
                return match InstanceWalks::<L, P>::of(placed) {
                    Some(walks) => (walks.closest_hit)(m, prims, &ray),
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

/// [`closest_hit`] of one lane after another, and what it costs each: a packet visits what any of its
/// lanes wants, which says nothing about a lane.
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

/// In the lanes of the loops. `places` are the parts of the scene for a ray of some lanes.
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
    walk_all(
        m,
        prims,
        &ray,
        places,
        #[inline(always)]
        |candidate, mask, limit| {
            meet::<_, P, W>(m, candidate, mask, &mut best);
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

/// Tests one primitive and keeps it in the lanes where it is closer.
#[inline(always)]
fn meet<'a, L: Lanes, P: Primitive, W: Places<'a, L, P>>(
    m: &Packet<L>,
    candidate: &Candidate<'_, '_, L, P>,
    mask: L::Mask,
    best: &mut Best<L>,
) {
    let (l, ray) = (m.lanes(), *candidate.ray);
    let hit = candidate.numbered(l, P::Hit::hit_on(candidate.intersect(m, mask)));
    let t_max = F(min(l, ray.t_max.0, best.t));
    let met = and(l, mask, is_within::on(m, hit, RayOn { t_max, ..ray }).0);
    if !l.any(met) {
        return;
    }
    let before = HitOn { t: F(best.t), prim_id: U(best.id), inst_id: U(best.inst), ..hit };
    let take = and(l, met, precedes::on(m, W::HAVE_INSTANCES, hit, before).0);
    best.t = l.f32_select(take, hit.t.0, best.t);
    if const { W::HAVE_INSTANCES } {
        best.inst = l.u32_select(take, hit.inst_id.0, best.inst);
    }
    best.id = l.u32_select(take, hit.prim_id.0, best.id);
    best.u = l.f32_select(take, hit.u.0, best.u);
    best.v = l.f32_select(take, hit.v.0, best.v);
    best.found = or(l, best.found, take);
    best.limit = limit_behind::on(m, F(best.t), F(l.f32(best.slack)), ray.t_max).0;
}

/// Whether each running lane hits anything. Lanes that have hit retire.
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
                return match InstanceWalks::<L, P>::of(placed) {
                    Some(walks) => (walks.any_hit)(m, prims, &ray),
                    None => each_lane(m, false, ray, |ray| traverse::any_hit(prims, ray)),
                };
            }
            any_hit_inside(m, prims, &ray, |_, ray, _| Parts { scene: *prims, next: 0, ray: *ray })
        },
    )
}

/// As [`closest_hit_inside`].
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
    walk_all(
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

/// Calls `meet` for every hit within each lane's range, in the lanes that have it, until it returns
/// false there.
#[inline(always)]
pub(crate) fn visit<'a, L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'a, P>,
    ray: RayOn<Packet<L>>,
    limit: impl Fn() -> F<Packet<L>>,
    meet: impl Fn(HitOn<Packet<L>>, RecordOn<Packet<L>, P>) -> B<Packet<L>>,
) {
    if prims.is_standing() || prims.walks().is_some() {
        return visit_each_lane(m, prims, ray, &limit, &meet);
    }
    let l = m.lanes();
    walk_all(
        m,
        prims,
        &ray,
        #[inline(always)]
        |l, ray, alive| match prims.placed() {
            Some(placed) => Either::Placed(Located::new(l, placed, ray, alive)),
            None => Either::Parts(Parts { scene: *prims, next: 0, ray: *ray }),
        },
        #[inline(always)]
        |candidate, mask, end| {
            let record = candidate.intersect(m, mask);
            let hit = candidate.numbered(l, P::Hit::hit_on(record));
            let met = and(l, mask, is_within::on(m, hit, ray).0);
            if !l.any(met) {
                return mask;
            }
            let goes_on = m.with_active(
                met,
                #[inline(always)]
                || meet(hit, P::Hit::with_hit_on(record, hit)).0,
            );
            *end = limit().0;
            without(l, mask, without(l, met, goes_on))
        },
    );
}

/// What a query of one ray gives for the ray of each running lane; `other` in the rest.
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

/// [`visit`] for one lane after another, all hits of each.
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

/// What counters show for a walk; it has no place in the user's source.
const NODES: Place = Place { what: "nodes of trees", file: "", line: 0 };
const PRIMITIVES: Place = Place { what: "primitives in leaves", file: "", line: 0 };

/// Visits the primitives of a scene that some running lane may meet. `visit` is given the lanes
/// concerned, may lower their limits, and returns those that stay interested. Rays with a component
/// that is no finite number meet nothing.
#[inline(always)]
fn walk_all<'a, L: Lanes, P: Primitive, W: Places<'a, L, P>>(
    m: &Packet<L>,
    prims: &SceneView<'a, P>,
    ray: &RayOn<Packet<L>>,
    places: impl FnOnce(L, &RayOn<Packet<L>>, L::Mask) -> W,
    mut visit: impl FnMut(&Candidate<'_, '_, L, P>, L::Mask, &mut L::F32) -> L::Mask,
) {
    let l = m.lanes();
    let shared = prims.shared();
    let mut limit = ray.t_max.0;
    let mut alive = and(l, m.active(), is_finite::on(m, *ray).0);
    let mut places = places(l, ray, alive);
    while l.any(alive)
        && let Some((part, inst, ray, mask)) = places.next(l, alive, limit)
    {
        let mut here = mask;
        walk_part(
            m,
            &part,
            &ray,
            &mut here,
            &mut limit,
            #[inline(always)]
            |id, mask, limit| {
                visit(&Candidate { part: &part, ray: &ray, shared, inst, id }, mask, limit)
            },
        );
        alive = without(l, alive, without(l, mask, here));
    }
}

/// The parts of a scene, one after another: each with the number of its instance, the rays as it
/// sees them, and the lanes that it concerns.
trait Places<'a, L: Lanes, P: Primitive> {
    /// Whether primitives have numbers of instances.
    const HAVE_INSTANCES: bool;

    /// The next part that lanes of `alive` may meet before their limits.
    fn next(&mut self, l: L, alive: L::Mask, limit: L::F32) -> Option<PacketPart<'a, L, P>>;
}

/// What [`Places`] gives.
type PacketPart<'a, L, P> =
    (Part<'a, P, <P as Primitive>::Shared>, u32, RayOn<Packet<L>>, <L as Lanes>::Mask);

/// The parts of a scene where nothing is placed.
struct Parts<'a, L: Lanes, P: Primitive> {
    scene: SceneView<'a, P>,
    next: usize,
    ray: RayOn<Packet<L>>,
}

impl<'a, L: Lanes, P: Primitive> Places<'a, L, P> for Parts<'a, L, P> {
    const HAVE_INSTANCES: bool = false;

    #[inline(always)]
    fn next(&mut self, _: L, alive: L::Mask, _: L::F32) -> Option<PacketPart<'a, L, P>> {
        let part = self.scene.part(self.next)?;
        self.next += 1;
        Some((part, 0, self.ray, alive))
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
        alive: L::Mask,
    ) -> Self {
        Self { placed, descent: PacketDescent::new(l, &placed.groups, ray, alive) }
    }
}

impl<'a, L: Lanes, P: Primitive> Places<'a, L, P> for Located<'a, L, P> {
    const HAVE_INSTANCES: bool = true;

    #[inline(always)]
    fn next(&mut self, l: L, alive: L::Mask, limit: L::F32) -> Option<PacketPart<'a, L, P>> {
        let place = self.descent.next(l, alive, limit)?;
        let part = self.placed.trees.parts[place.tree as usize];
        Some((part, place.inst, place.ray, place.mask))
    }
}

/// Those of any scene.
enum Either<'a, L: Lanes, P: Primitive> {
    Parts(Parts<'a, L, P>),
    Placed(Located<'a, L, P>),
}

impl<'a, L: Lanes, P: Primitive> Places<'a, L, P> for Either<'a, L, P> {
    const HAVE_INSTANCES: bool = true;

    #[inline(always)]
    fn next(&mut self, l: L, alive: L::Mask, limit: L::F32) -> Option<PacketPart<'a, L, P>> {
        match self {
            Self::Parts(parts) => parts.next(l, alive, limit),
            Self::Placed(located) => located.next(l, alive, limit),
        }
    }
}

/// The walks of packets through scenes of instances, for one kind of lanes.
///
/// They are as long as those through single trees. So nothing refers to them but the tables that
/// [`Instances`](super::Instances) are made with: what makes none is compiled without them.
struct InstanceWalks<L: Lanes, P: Primitive> {
    closest_hit: InstanceQuery<L, P, HitOn<Packet<L>>>,
    any_hit: InstanceQuery<L, P, B<Packet<L>>>,
}

type InstanceQuery<L, P, R> = fn(&Packet<L>, &SceneView<'_, P>, &RayOn<Packet<L>>) -> R;

/// [`InstanceWalks`] of some kinds of lanes, and [`RecordedWalks`].
pub(crate) type InstanceTable = &'static [&'static (dyn Any + Send + Sync)];

/// Those of the lanes that kernels have, and of recorders.
pub(crate) fn instance_table<P: Primitive>() -> InstanceTable {
    struct Of<P>(PhantomData<P>);
    impl<P: Primitive> Of<P> {
        const TABLE: InstanceTable = &[
            &InstanceWalks::<Lanes4, P>::NEW,
            &InstanceWalks::<Lanes8, P>::NEW,
            &InstanceWalks::<Lanes16, P>::NEW,
            &RecordedWalks::<P>::NEW,
        ];
    }
    Of::<P>::TABLE
}

impl<L: Lanes, P: Primitive> InstanceWalks<L, P> {
    const NEW: Self =
        Self { closest_hit: closest_hit_placed::<L, P>, any_hit: any_hit_placed::<L, P> };

    /// Those of the lanes; none where no kernel is lifted for them.
    #[inline(always)]
    fn of<'w>(placed: &Placed<'w, P, P::Shared>) -> Option<&'w Self> {
        if const { L::HAS_TABLES } {
            placed.walks.iter().find_map(|walks| walks.downcast_ref())
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
            closest_hit_inside(m, prims, ray, |l, ray, alive| Located::new(l, placed, ray, alive))
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
            any_hit_inside(m, prims, ray, |l, ray, alive| Located::new(l, placed, ray, alive))
        },
    )
}

/// [`walk_all`] in one part, by the rays of `alive`: visits what is in the leaves that some lane may
/// meet, until none is interested.
#[inline(always)]
fn walk_part<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    part: &Part<'_, P, P::Shared>,
    ray: &RayOn<Packet<L>>,
    alive: &mut L::Mask,
    limit: &mut L::F32,
    mut visit: impl FnMut(u32, L::Mask, &mut L::F32) -> L::Mask,
) {
    let l = m.lanes();
    let mut stack = Stack::new();
    // A slice is one leaf, which every ray meets.
    let mut leaf = Leaf { begin: 0, end: part.prims.len(), mask: *alive };
    let mut descent = None;
    if let Some(tree) = part.tree() {
        let Some(root) = tree.nodes.first() else { return };
        let slabs = PacketSlabs::new(l, ray, *alive, root, Padding::of::<P>());
        let (enter, hit) = slabs.enter(l, root, *limit);
        push(l, &mut stack, 0, enter, hit);
        (leaf, descent) = (Leaf { end: 0, ..leaf }, Some(Descent { tree, slabs }));
    }
    loop {
        for place in leaf.begin..leaf.end {
            let id = match &descent {
                Some(descent) => {
                    l.at(PRIMITIVES, leaf.mask);
                    descent.tree.indices[place]
                }
                None => place as u32,
            };
            let stay = visit(id, leaf.mask, limit);
            // A lane that lost interest leaves the walk.
            *alive = without(l, *alive, without(l, leaf.mask, stay));
            leaf.mask = stay;
            if !l.any(leaf.mask) {
                break;
            }
        }
        let Some(descent) = descent.as_ref().filter(|_| l.any(*alive)) else { return };
        let Some(next) = descent.next_leaf(l, &mut stack, *alive, *limit) else { return };
        leaf = next;
    }
}

/// Some places in a list of primitives, and the lanes that may meet what is there.
struct Leaf<L: Lanes> {
    begin: usize,
    end: usize,
    mask: L::Mask,
}

/// What a walk down a tree asks.
struct Descent<'t, L: Lanes> {
    tree: Branches<'t>,
    slabs: PacketSlabs<L>,
}

/// Subtrees to come, and where each lane enters them.
type Pending<L> = Stack<<L as Lanes>::F32>;

/// Where a lane does not enter a subtree, it has NaN, which is at or before no limit.
#[inline(always)]
fn push<L: Lanes>(l: L, stack: &mut Pending<L>, node: u32, enter: L::F32, hit: L::Mask) {
    stack.push(node, l.f32_select(hit, enter, l.f32(f32::NAN)));
}

impl<L: Lanes> Descent<'_, L> {
    /// The next leaf that some lane of `alive` enters before its limit.
    #[inline(always)]
    fn next_leaf(
        &self,
        l: L,
        stack: &mut Pending<L>,
        alive: L::Mask,
        limit: L::F32,
    ) -> Option<Leaf<L>> {
        loop {
            let (index, enter) = stack.pop()?;
            let mut mask = and(l, alive, l.f32_compare(op::Le, enter, limit));
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
                let (t0, hit0) = self.slabs.enter(l, &children[0], limit);
                let (t1, hit1) = self.slabs.enter(l, &children[1], limit);
                let (hit0, hit1) = (and(l, mask, hit0), and(l, mask, hit1));
                let is_first = match (l.any(hit0), l.any(hit1)) {
                    (true, true) => {
                        // What most lanes enter first comes first.
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
