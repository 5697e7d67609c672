//! Queries of trees, where rounding leaves open what is hit.
//!
//! Every primitive is asked in all ways in which its own decisions may go. Those that some variant
//! may find the closest are the alternatives of one decision.

use core::cell::Cell;

use super::interval::Interval;
use super::{Bounded, Margin, Truth};
use crate::bvh::{Node, On};
use crate::geometry::{HitOn, Primitive, RayOn};
use crate::machine::{B, BoolBinary, Compare, F, Machine, U};

/// In how many ways one primitive is asked.
const WAYS: usize = 64;

/// How a primitive may be hit.
#[derive(Clone, Copy)]
struct Found {
    id: u32,
    t: Bounded,
    u: Bounded,
    v: Bounded,
    /// Whether it is hit in every way.
    is_certain: bool,
    /// Whether `f64` hits it.
    is_reference: bool,
}

/// The least `(t, id)` hit.
pub(super) fn closest_hit<P: Primitive>(
    m: &Margin,
    prims: &On<'_, P>,
    ray: RayOn<Margin>,
) -> HitOn<Margin> {
    let mut found = Vec::new();
    let fate = fate(ray);
    if fate != Fate::Misses {
        let limit = Cell::new(ray.t_max.0.range.high);
        walk(prims, ray, &limit, |id| {
            let hits = ask(m, prims.get(id), ray, id);
            for hit in hits.iter().filter(|h| h.is_certain) {
                limit.set(limit.get().min(hit.t.range.high));
            }
            found.extend(hits);
            false
        });
    }
    let may_miss = fate != Fate::Runs || !found.iter().any(|h| h.is_certain);
    let candidates = candidates(prims, found);
    let by_t = |a: &&Found, b: &&Found| a.t.value.total_cmp(&b.t.value).then(a.id.cmp(&b.id));
    let reference = candidates.iter().filter(|h| h.is_reference).min_by(by_t).map(|h| h.id);
    let mut hits: Vec<Option<Found>> = candidates.into_iter().map(Some).collect();
    if may_miss {
        hits.push(None);
    }
    let is_first = |h: &Option<Found>| match h {
        Some(h) => h.is_reference && Some(h.id) == reference,
        None => reference.is_none(),
    };
    if let Some(at) = hits.iter().position(is_first) {
        hits.swap(0, at);
    }
    hit_on(m, m.one_of(&hits))
}

/// Whether anything is hit.
pub(super) fn any_hit<P: Primitive>(m: &Margin, prims: &On<'_, P>, ray: RayOn<Margin>) -> Truth {
    let fate = fate(ray);
    if fate == Fate::Misses {
        return Truth::certain(false);
    }
    let (mut may_be, mut is_certain, mut is_reference) = (false, false, false);
    let limit = Cell::new(ray.t_max.0.range.high);
    walk(prims, ray, &limit, |id| {
        for hit in ask(m, prims.get(id), ray, id) {
            may_be = true;
            is_certain |= hit.is_certain && fate == Fate::Runs;
            is_reference |= hit.is_reference;
        }
        is_certain
    });
    m.truth(is_reference, may_be, !is_certain)
}

fn hit_on(m: &Margin, found: Option<Found>) -> HitOn<Margin> {
    let number = |v: Option<Bounded>| F(v.unwrap_or_else(|| m.f32(0.0)));
    HitOn {
        is_hit: B(m.bool(found.is_some())),
        t: number(found.map(|h| h.t)),
        prim_id: U(found.map_or(0, |h| h.id)),
        u: number(found.map(|h| h.u)),
        v: number(found.map(|h| h.v)),
    }
}

/// What becomes of a ray, which misses everything if a component is no finite number.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Runs,
    MayMiss,
    Misses,
}

fn fate(ray: RayOn<Margin>) -> Fate {
    let (o, d) = (ray.origin, ray.direction);
    let all = [o.x, o.y, o.z, d.x, d.y, d.z].map(|c| c.0.range);
    let no_number = |r: &Interval| r.is_nan() || r.low == f64::INFINITY || r.high == -f64::INFINITY;
    if all.iter().any(no_number) {
        Fate::Misses
    } else if all.iter().any(|r| r.may_break()) {
        Fate::MayMiss
    } else {
        Fate::Runs
    }
}

/// The hits of one primitive; ways that rounding cannot tell apart are one.
fn ask<P: Primitive>(m: &Margin, prim: P, ray: RayOn<Margin>, id: u32) -> Vec<Found> {
    let ways = m.each_way(WAYS, || {
        let hit = P::intersect_on(m, P::splat(m, prim), ray);
        let late = m.f32_compare(Compare::Ge, hit.t.0, ray.t_min.0);
        let early = m.f32_compare(Compare::Le, hit.t.0, ray.t_max.0);
        let inside = m.bool_binary(BoolBinary::And, late, early);
        let accepted = m.decided(m.bool_binary(BoolBinary::And, hit.is_hit.0, inside));
        accepted.then_some([hit.t.0, hit.u.0, hit.v.0])
    });
    if !ways.is_complete && m.is_running() {
        m.decisions.lose();
    }
    let is_certain = ways.is_complete && ways.results.iter().all(Option::is_some);
    let mut found: Vec<Found> = Vec::new();
    for (way, result) in ways.results.into_iter().enumerate() {
        let Some([t, u, v]) = result else { continue };
        // What was accepted is a number between the ends of the ray.
        let first = ray.t_min.0.range.low.max(t.range.low);
        let last = ray.t_max.0.range.high.min(t.range.high);
        let t = m.bounded(t.value, Interval::new(first, last, false));
        let near = found.iter_mut().find(|f| {
            [(f.t, t), (f.u, u), (f.v, v)].iter().all(|(a, b)| a.range.overlaps(b.range))
        });
        match near {
            Some(f) => {
                let join = |a: Bounded, b: Bounded| m.bounded(a.value, a.range.hull(b.range));
                (f.t, f.u, f.v) = (join(f.t, t), join(f.u, u), join(f.v, v));
            }
            None => found.push(Found { id, t, u, v, is_certain: false, is_reference: way == 0 }),
        }
    }
    // Several hits that differ: one of them is certain, which bounds nothing but the farthest.
    if let ([only], true) = (&mut found[..], is_certain) {
        only.is_certain = true;
    }
    found
}

/// The hits that may be the closest.
fn candidates<P: Primitive>(prims: &On<'_, P>, found: Vec<Found>) -> Vec<Found> {
    let certain: Vec<Found> = found.iter().copied().filter(|h| h.is_certain).collect();
    let limit = certain.iter().map(|h| h.t.range.high).fold(f64::INFINITY, f64::min);
    let near: Vec<Found> = found.into_iter().filter(|h| h.t.range.low <= limit).collect();
    let loses = |h: &Found, to: &Found| {
        to.t.range.high < h.t.range.low || to.id < h.id && to.t.range.high <= h.t.range.low
    };
    // Copies of a primitive are hit alike, and the first one wins.
    let bytes = |id: u32| {
        let mut bytes = vec![0; P::SCHEMA.size()];
        prims.get(id).write(&mut bytes);
        bytes
    };
    let is_copy = |h: &Found| {
        near.iter().any(|other| other.id < h.id) && {
            let own = bytes(h.id);
            near.iter().any(|other| other.id < h.id && bytes(other.id) == own)
        }
    };
    near.iter()
        .filter(|h| !certain.iter().any(|c| loses(h, c)) && !is_copy(h))
        .copied()
        .collect()
}

/// Visits the primitives that some variant may hit at or before `limit`, until `visit` returns
/// true.
fn walk<P: Primitive>(
    prims: &On<'_, P>,
    ray: RayOn<Margin>,
    limit: &Cell<f64>,
    mut visit: impl FnMut(u32) -> bool,
) {
    if !prims.has_tree() {
        let _ = (0..prims.len() as u32).any(visit);
        return;
    }
    let Some(root) = prims.nodes.first() else { return };
    let beam = Beam::new(ray, root, f64::from(P::SLACK));
    let mut stack = vec![root];
    while let Some(node) = stack.pop() {
        if !beam.meets(node, limit.get()) {
            continue;
        }
        let (first, count) = (node.first as usize, node.count as usize);
        if !node.is_leaf() {
            let children = &prims.nodes[first..first + 2];
            // The nearer one comes off the stack first.
            let is_left_near = beam.enters(&children[0]) <= beam.enters(&children[1]);
            let order = if is_left_near { [1, 0] } else { [0, 1] };
            stack.extend(order.map(|i| &children[i]));
        } else if prims.indices[first..first + count].iter().any(|id| visit(*id)) {
            return;
        }
    }
}

/// A ray as wide as rounding makes it.
struct Beam {
    /// Where it may start, moved apart by the allowance.
    origin: [Interval; 3],
    direction: [f64; 3],
    t_min: f64,
}

impl Beam {
    fn new(ray: RayOn<Margin>, root: &Node, slack: f64) -> Self {
        let origin = [ray.origin.x, ray.origin.y, ray.origin.z].map(|c| c.0.range);
        let direction = [ray.direction.x, ray.direction.y, ray.direction.z].map(|c| c.0.range);
        let (low, high) = (root.min.as_dvec3().to_array(), root.max.as_dvec3().to_array());
        let mut reach = 0f64;
        for axis in 0..3 {
            let (near, far) = (low[axis] - origin[axis].high, high[axis] - origin[axis].low);
            reach = reach.max(near.abs()).max(far.abs());
        }
        // How far the ray may lie aside at the far end of the scene.
        let width = direction.iter().map(|d| d.high - d.low).fold(0.0, f64::max);
        let length = direction.iter().map(|d| d.abs().low).fold(0.0, f64::max);
        let aside = width * 2.0 * reach / length;
        let ulp = f64::from(f32::EPSILON);
        let widest = origin.map(|o| {
            let pad = 2.0 * slack * reach + o.abs().high * 2.0 * ulp + aside;
            // Without a direction, or with one that is not known, everything is met.
            let pad = if pad.is_nan() { f64::INFINITY } else { pad };
            Interval::new(o.low - pad, o.high + pad, false)
        });
        let middle = direction.map(|d| 0.5 * (d.low + d.high));
        Self { origin: widest, direction: middle, t_min: ray.t_min.0.range.low }
    }

    /// Where the beam enters and leaves a box.
    fn slab(&self, node: &Node) -> (f64, f64) {
        let (low, high) = (node.min.as_dvec3().to_array(), node.max.as_dvec3().to_array());
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in 0..3 {
            let (o, d) = (self.origin[axis], self.direction[axis]);
            let (first, last) = (low[axis] - o.high, high[axis] - o.low);
            // Across the axis, within the allowance, or without a limit: this axis says nothing.
            if d == 0.0 || !(first / d).is_finite() || !(last / d).is_finite() {
                if first > 0.0 || last < 0.0 {
                    return (f64::INFINITY, f64::NEG_INFINITY);
                }
                continue;
            }
            near = near.max((first / d).min(last / d));
            far = far.min((first / d).max(last / d));
        }
        (near, far)
    }

    fn enters(&self, node: &Node) -> f64 {
        self.slab(node).0
    }

    fn meets(&self, node: &Node, limit: f64) -> bool {
        let (near, far) = self.slab(node);
        // So written that a NaN means a visit.
        !(near > far || far < self.t_min || near > limit)
    }
}
