//! Traversal for packets: one stack for all lanes, a mask of those that a node concerns.

use super::slabs::{LEAST, ULP};
use super::traverse::Stack;
use super::{Node, Part, RecordOn, SceneView, View};
use crate::geometry::{HitOn, HitRecord, Primitive, RayOn};
use crate::machine::{
    B, BoolBinary, Compare, Entered, F, F32Binary, F32Unary, Lanes, Packet, Place, U, V3, fill,
};

/// The machine of the loops: its kernels are inlined, so that nothing travels through memory.
type Inner<L> = Packet<Entered<L>>;

#[inline(always)]
fn min<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(F32Binary::Min, a, b)
}

#[inline(always)]
fn max<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(F32Binary::Max, a, b)
}

#[inline(always)]
fn and<L: Lanes>(l: L, a: L::Mask, b: L::Mask) -> L::Mask {
    l.mask_binary(BoolBinary::And, a, b)
}

#[inline(always)]
fn or<L: Lanes>(l: L, a: L::Mask, b: L::Mask) -> L::Mask {
    l.mask_binary(BoolBinary::Or, a, b)
}

#[inline(always)]
fn sub<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(F32Binary::Sub, a, b)
}

#[inline(always)]
fn add<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(F32Binary::Add, a, b)
}

#[inline(always)]
fn mul<L: Lanes>(l: L, a: L::F32, b: L::F32) -> L::F32 {
    l.f32_binary(F32Binary::Mul, a, b)
}

#[inline(always)]
fn abs<L: Lanes>(l: L, a: L::F32) -> L::F32 {
    l.f32_unary(F32Unary::Abs, a)
}

/// `a` without the lanes of `b`.
#[inline(always)]
fn without<L: Lanes>(l: L, a: L::Mask, b: L::Mask) -> L::Mask {
    and(l, a, l.mask_not(b))
}

/// Where a node's bounds are among its eight members.
const MIN: [usize; 3] = [0, 1, 2];
const MAX: [usize; 3] = [4, 5, 6];

/// Rays of a packet, prepared for box tests; see [`super::slabs`].
struct PacketSlabs<L: Lanes> {
    /// From where each axis' first and second plane are measured.
    near_origin: [L::F32; 3],
    far_origin: [L::F32; 3],
    inverse: [L::F32; 3],
    t_min: L::F32,
    /// Where, among a node's members, each axis' first and second plane are.
    near_bound: [usize; 3],
    far_bound: [usize; 3],
    /// All rays go the same way along every axis, so that the same planes come first for all.
    is_aligned: bool,
}

impl<L: Lanes> PacketSlabs<L> {
    #[inline(always)]
    fn new(l: L, ray: &RayOn<Packet<L>>, alive: L::Mask, root: &Node, slack: f32) -> Self {
        let o = ray.origin.array();
        let pad = allowance(l, o, root, slack);
        let inverse = finite_inverse(l, ray.direction.array());
        let alive = l.bits(alive);
        let (mut near_origin, mut far_origin) = (o, o);
        let (mut near_bound, mut far_bound) = (MIN, MAX);
        let mut is_aligned = true;
        for i in 0..3 {
            let negative = l.bits(l.f32_compare(Compare::Lt, inverse[i], l.f32(0.0))) & alive;
            is_aligned &= negative == 0 || negative == alive;
            if negative != 0 {
                (near_bound[i], far_bound[i]) = (MAX[i], MIN[i]);
            }
        }
        for i in 0..3 {
            let pad = add(l, pad, mul(l, abs(l, o[i]), l.f32(ULP)));
            let (lower, upper) = (add(l, o[i], pad), sub(l, o[i], pad));
            let is_reversed = is_aligned && near_bound[i] != MIN[i];
            (near_origin[i], far_origin[i]) =
                if is_reversed { (upper, lower) } else { (lower, upper) };
        }
        Self {
            near_origin,
            far_origin,
            inverse,
            t_min: ray.t_min.0,
            near_bound,
            far_bound,
            is_aligned,
        }
    }

    /// When each lane meets the plane at `bound` of axis `i`.
    #[inline(always)]
    fn plane(&self, l: L, bound: f32, origin: L::F32, i: usize) -> L::F32 {
        mul(l, sub(l, l.f32(bound), origin), self.inverse[i])
    }

    /// Where each lane enters the box, and which do so at or before `limit`.
    #[inline(always)]
    fn enter(&self, l: L, node: &Node, limit: L::F32) -> (L::F32, L::Mask) {
        // Read where it lies: a copy would go through the stack.
        let bounds: &[f32; 8] = bytemuck::cast_ref(node);
        let (mut near, mut far) = (self.near_origin, self.far_origin);
        if self.is_aligned {
            for i in 0..3 {
                near[i] = self.plane(l, bounds[self.near_bound[i] % 8], near[i], i);
                far[i] = self.plane(l, bounds[self.far_bound[i] % 8], far[i], i);
            }
        } else {
            for i in 0..3 {
                let low = self.plane(l, bounds[MIN[i]], near[i], i);
                let high = self.plane(l, bounds[MAX[i]], far[i], i);
                (near[i], far[i]) = (min(l, low, high), max(l, low, high));
            }
        }
        let near = max(l, max(l, near[0], near[1]), max(l, near[2], self.t_min));
        let far = min(l, min(l, far[0], far[1]), min(l, far[2], limit));
        (near, l.f32_compare(Compare::Le, near, far))
    }
}

/// By how much every box is widened for each lane.
#[inline(always)]
fn allowance<L: Lanes>(l: L, origin: [L::F32; 3], root: &Node, slack: f32) -> L::F32 {
    let (low, high) = (root.min.to_array(), root.max.to_array());
    let mut farthest = l.f32(0.0);
    for i in 0..3 {
        farthest = max(l, farthest, abs(l, sub(l, l.f32(low[i]), origin[i])));
        farthest = max(l, farthest, abs(l, sub(l, l.f32(high[i]), origin[i])));
    }
    max(l, mul(l, l.f32(slack), farthest), l.f32(f32::MIN_POSITIVE))
}

/// The reciprocal of every component, finite.
#[inline(always)]
fn finite_inverse<L: Lanes>(l: L, d: [L::F32; 3]) -> [L::F32; 3] {
    let largest = max(l, max(l, abs(l, d[0]), abs(l, d[1])), abs(l, d[2]));
    let least = max(l, mul(l, largest, l.f32(LEAST)), l.f32(f32::MIN_POSITIVE));
    fill(
        #[inline(always)]
        |i| {
            let negative = l.f32_compare(Compare::Lt, d[i], l.f32(0.0));
            let tiny = l.f32_select(negative, l.f32_unary(F32Unary::Neg, least), least);
            let small = l.f32_compare(Compare::Lt, abs(l, d[i]), least);
            l.f32_binary(F32Binary::Div, l.f32(1.0), l.f32_select(small, tiny, d[i]))
        },
    )
}

/// The rays whose every component is a finite number; the others miss.
#[inline(always)]
fn finite<L: Lanes>(l: L, ray: &RayOn<Packet<L>>) -> L::Mask {
    let (o, d) = (ray.origin, ray.direction);
    let mut all = l.mask(true);
    for c in [o.x, o.y, o.z, d.x, d.y, d.z] {
        all = and(l, all, l.f32_compare(Compare::Le, abs(l, c.0), l.f32(f32::MAX)));
    }
    all
}

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

/// The least `(t, id)` of the hits seen so far. A lane without one has infinity and the last id,
/// which every hit beats.
struct Best<L: Lanes> {
    t: L::F32,
    id: L::U32,
    u: L::F32,
    v: L::F32,
    found: L::Mask,
    /// No node beyond this distance is worth a lane's visit.
    limit: L::F32,
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
            let m = Packet::with_mask(Entered(m.lanes()), m.active());
            let hit = closest_hit_inside(&m, prims, inner_ray(&ray));
            HitOn {
                is_hit: B(hit.is_hit.0),
                t: F(hit.t.0),
                prim_id: U(hit.prim_id.0),
                u: F(hit.u.0),
                v: F(hit.v.0),
            }
        },
    )
}

#[inline(always)]
fn closest_hit_inside<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: RayOn<Packet<L>>,
) -> HitOn<Packet<L>> {
    let l = m.lanes();
    let zero = l.f32(0.0);
    let mut best = Best {
        t: l.f32(f32::INFINITY),
        id: l.u32(u32::MAX),
        u: zero,
        v: zero,
        found: l.mask(false),
        limit: ray.t_max.0,
    };
    let shared = prims.shared();
    walk_all(
        m,
        prims,
        &ray,
        #[inline(always)]
        |part, mask, id, limit| {
            let prim = &part.prims[id as usize];
            meet(m, prim, shared, &ray, mask, part.first + id, &mut best);
            *limit = best.limit;
            mask
        },
    );
    HitOn {
        is_hit: B(best.found),
        t: F(l.f32_select(best.found, best.t, zero)),
        prim_id: U(l.u32_select(best.found, best.id, l.u32(0))),
        u: F(best.u),
        v: F(best.v),
    }
}

/// Tests one primitive and keeps it in the lanes where it is closer.
#[inline(always)]
fn meet<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prim: &P,
    shared: View<'_, P::Shared>,
    ray: &RayOn<Packet<L>>,
    mask: L::Mask,
    id: u32,
    best: &mut Best<L>,
) {
    let l = m.lanes();
    let hit = m.with_active(
        mask,
        #[inline(always)]
        || P::Hit::hit_on(P::intersect_one_on(m, prim, *ray, shared)),
    );
    let t = hit.t.0;
    let near = l.f32_compare(Compare::Le, t, best.t);
    let candidate = and(l, and(l, mask, accepts(l, &hit, ray)), near);
    if !l.any(candidate) {
        return;
    }
    let id = l.u32(id);
    let nearer = l.f32_compare(Compare::Lt, t, best.t);
    let take = and(l, candidate, or(l, nearer, l.u32_compare(Compare::Lt, id, best.id)));
    best.t = l.f32_select(take, t, best.t);
    best.id = l.u32_select(take, id, best.id);
    best.u = l.f32_select(take, hit.u.0, best.u);
    best.v = l.f32_select(take, hit.v.0, best.v);
    best.found = or(l, best.found, take);
    let slack = mul(l, abs(l, best.t), l.f32(P::SLACK));
    best.limit = min(l, ray.t_max.0, l.f32_binary(F32Binary::Add, best.t, slack));
}

#[inline(always)]
fn accepts<L: Lanes>(l: L, hit: &HitOn<Packet<L>>, ray: &RayOn<Packet<L>>) -> L::Mask {
    let after = l.f32_compare(Compare::Ge, hit.t.0, ray.t_min.0);
    let before = l.f32_compare(Compare::Le, hit.t.0, ray.t_max.0);
    and(l, hit.is_hit.0, and(l, after, before))
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
            let m = Packet::with_mask(Entered(m.lanes()), m.active());
            B(any_hit_inside(&m, prims, inner_ray(&ray)).0)
        },
    )
}

#[inline(always)]
fn any_hit_inside<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: RayOn<Packet<L>>,
) -> B<Packet<L>> {
    let l = m.lanes();
    let mut found = l.mask(false);
    let shared = prims.shared();
    walk_all(
        m,
        prims,
        &ray,
        #[inline(always)]
        |part, mask, id, _| {
            let prim = &part.prims[id as usize];
            let hit = m.with_active(
                mask,
                #[inline(always)]
                || P::Hit::hit_on(P::intersect_one_on(m, prim, ray, shared)),
            );
            found = or(l, found, and(l, mask, accepts(l, &hit, &ray)));
            without(l, mask, found)
        },
    );
    B(found)
}

/// Calls `meet` for every hit within each lane's range, in the lanes that have it, until it returns
/// false there.
#[inline(always)]
pub(crate) fn visit<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: RayOn<Packet<L>>,
    limit: impl Fn() -> F<Packet<L>>,
    meet: impl Fn(HitOn<Packet<L>>, RecordOn<Packet<L>, P>) -> B<Packet<L>>,
) {
    let l = m.lanes();
    let shared = prims.shared();
    walk_all(
        m,
        prims,
        &ray,
        #[inline(always)]
        |part, mask, id, end| {
            let record = m.with_active(
                mask,
                #[inline(always)]
                || P::intersect_one_on(m, &part.prims[id as usize], ray, shared),
            );
            let hit = P::Hit::hit_on(record);
            let met = and(l, mask, accepts(l, &hit, &ray));
            if !l.any(met) {
                return mask;
            }
            let hit = HitOn { prim_id: U(l.u32(part.first + id)), ..hit };
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

/// What counters show for a walk; it has no place in the user's source.
const NODES: Place = Place { what: "nodes of trees", file: "", line: 0 };
const PRIMITIVES: Place = Place { what: "primitives in leaves", file: "", line: 0 };

/// [`walk`] through one part after another, by the rays whose components are finite.
#[inline(always)]
fn walk_all<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    prims: &SceneView<'_, P>,
    ray: &RayOn<Packet<L>>,
    mut visit: impl FnMut(&Part<'_, P, P::Shared>, L::Mask, u32, &mut L::F32) -> L::Mask,
) {
    let l = m.lanes();
    let mut limit = ray.t_max.0;
    let mut alive = and(l, m.active(), finite(l, ray));
    for part in prims.parts() {
        if !l.any(alive) {
            return;
        }
        walk(
            m,
            &part,
            ray,
            &mut alive,
            &mut limit,
            #[inline(always)]
            |mask, id, limit| visit(&part, mask, id, limit),
        );
    }
}

/// Visits primitives that any lane of `alive` may meet. `visit` is given the lanes concerned, may
/// lower their limits, and returns those that stay interested; the walk ends when none is.
#[inline(always)]
fn walk<L: Lanes, P: Primitive>(
    m: &Packet<L>,
    part: &Part<'_, P, P::Shared>,
    ray: &RayOn<Packet<L>>,
    alive: &mut L::Mask,
    limit: &mut L::F32,
    mut visit: impl FnMut(L::Mask, u32, &mut L::F32) -> L::Mask,
) {
    let l = m.lanes();
    let Some(tree) = part.tree else {
        for id in 0..part.prims.len() as u32 {
            *alive = visit(*alive, id, limit);
            if !l.any(*alive) {
                return;
            }
        }
        return;
    };
    let Some(root) = tree.nodes.first() else { return };
    let slabs = PacketSlabs::new(l, ray, *alive, root, P::SLACK);
    // Where a lane does not enter, it has infinity.
    let mut stack = Stack::<L::F32>::new();
    let mut node = root;
    let mut mask = and(l, *alive, slabs.enter(l, root, *limit).1);
    if !l.any(mask) {
        return;
    }
    loop {
        l.at(NODES, mask);
        if node.is_leaf() {
            let (first, count) = (node.first as usize, node.count as usize);
            for &id in &tree.indices[first..first + count] {
                l.at(PRIMITIVES, mask);
                let stay = visit(mask, id, limit);
                // A lane that lost interest leaves the walk.
                *alive = without(l, *alive, without(l, mask, stay));
                mask = stay;
                if !l.any(mask) {
                    break;
                }
            }
            if !l.any(*alive) {
                return;
            }
        } else {
            let children = &tree.nodes[node.first as usize..node.first as usize + 2];
            let (t0, hit0) = slabs.enter(l, &children[0], *limit);
            let (t1, hit1) = slabs.enter(l, &children[1], *limit);
            let (hit0, hit1) = (and(l, mask, hit0), and(l, mask, hit1));
            match (l.any(hit0), l.any(hit1)) {
                (true, true) => {
                    let both = and(l, hit0, hit1);
                    let left = and(l, both, l.f32_compare(Compare::Le, t0, t1));
                    let far = l.f32(f32::INFINITY);
                    if 2 * l.bits(left).count_ones() >= l.bits(both).count_ones() {
                        stack.push(node.first + 1, l.f32_select(hit1, t1, far));
                        (node, mask) = (&children[0], hit0);
                    } else {
                        stack.push(node.first, l.f32_select(hit0, t0, far));
                        (node, mask) = (&children[1], hit1);
                    }
                    continue;
                }
                (true, false) => {
                    (node, mask) = (&children[0], hit0);
                    continue;
                }
                (false, true) => {
                    (node, mask) = (&children[1], hit1);
                    continue;
                }
                (false, false) => {}
            }
        }
        // Back to the last subtree that some lane enters before its best hit.
        loop {
            let Some((index, enter)) = stack.pop() else { return };
            mask = and(l, *alive, l.f32_compare(Compare::Le, enter, *limit));
            if l.any(mask) {
                node = &tree.nodes[index as usize];
                break;
            }
        }
    }
}
