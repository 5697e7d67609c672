//! Queries of trees, where rounding leaves open what is hit.
//!
//! Every primitive is asked in all ways in which its own decisions may go. Those that some variant
//! may find the closest are the alternatives of one decision.
//!
//! All but the asking is the same for every type of primitives, and compiled once.

use core::cell::Cell;
use std::rc::Rc;

use super::affine::Form;
use super::beam::Beam;
use super::decisions::Explored;
use super::interval::Interval;
use super::{Bounded, Margin, Truth};
use crate::bvh::{Branches, RecordOn, SceneView};
use crate::geometry::{HitOn, HitRecord, Primitive, RayOn};
use crate::machine::{B, BoolBinary, Compare, F, Machine, U};

/// In how many ways one primitive is asked.
const WAYS: usize = 64;

/// Primitives of any type, the trees over them if there are any, and a ray.
pub(super) struct Scene<'a> {
    ray: RayOn<Margin>,
    parts: Vec<Part<'a>>,
    slack: f64,
    /// Where the ray meets a primitive.
    intersect: &'a dyn Fn(u32) -> HitOn<Margin>,
    /// The bytes of a primitive.
    bytes: &'a dyn Fn(u32) -> Vec<u8>,
}

/// Some of the primitives, and the tree over them if there is one.
struct Part<'a> {
    first: u32,
    len: u32,
    tree: Option<Branches<'a>>,
}

/// Does `query` with `prims` of any type. `found` is shown what the last primitive gave.
pub(super) fn query<P: Primitive, R>(
    m: &Margin,
    prims: &SceneView<'_, P>,
    ray: RayOn<Margin>,
    found: impl Fn(RecordOn<Margin, P>),
    query: impl FnOnce(&Margin, &Scene<'_>) -> R,
) -> R {
    let bytes = |id| {
        let mut bytes = vec![0; P::SCHEMA.size()];
        prims.get(id).write(&mut bytes);
        bytes
    };
    let intersect = |id| {
        let record = P::intersect_one_on(m, &prims.get(id), ray, prims.shared());
        found(record);
        P::Hit::hit_on(record)
    };
    let parts = prims.parts();
    let scene = Scene {
        ray,
        parts: parts
            .map(|p| Part { first: p.first, len: p.prims.len() as u32, tree: p.tree })
            .collect(),
        slack: f64::from(P::SLACK),
        intersect: &intersect,
        bytes: &bytes,
    };
    query(m, &scene)
}

/// A value that outlives the forms of its run, with its own.
type Kept = (Bounded, Option<Rc<Form>>);

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
pub(super) fn closest_hit(m: &Margin, scene: &Scene<'_>) -> HitOn<Margin> {
    let mut found = Vec::new();
    let fate = fate(scene.ray);
    let limit = Cell::new(scene.ray.t_max.0.range.high);
    if fate != Fate::Misses {
        scene.walk(&limit, &mut |id| {
            let hits = scene.ask(m, id);
            for hit in hits.iter().filter(|h| h.is_certain) {
                limit.set(limit.get().min(hit.t.range.high));
            }
            found.extend(hits);
            false
        });
    }
    let may_miss = fate != Fate::Runs || !found.iter().any(|h| h.is_certain);
    let candidates = scene.candidates(found);
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
    // The closest hit is no farther than any that is certain.
    let near = Interval::new(f64::NEG_INFINITY, limit.get(), false);
    let cut = |h: Found| Found { t: Bounded { range: h.t.range.narrowed(near), ..h.t }, ..h };
    hit_on(m, m.one_of(None, &hits).map(cut))
}

/// Whether anything is hit.
pub(super) fn any_hit(m: &Margin, scene: &Scene<'_>) -> Truth {
    let fate = fate(scene.ray);
    if fate == Fate::Misses {
        return Truth::certain(false);
    }
    let (mut may_be, mut is_certain, mut is_reference) = (false, false, false);
    let limit = Cell::new(scene.ray.t_max.0.range.high);
    scene.walk(&limit, &mut |id| {
        for hit in scene.ask(m, id) {
            may_be = true;
            is_certain |= hit.is_certain && fate == Fate::Runs;
            is_reference |= hit.is_reference;
        }
        is_certain
    });
    m.truth(is_reference, may_be, !is_certain)
}

/// Calls `meet` for every hit of the way that is followed, until it returns false.
pub(super) fn visit(
    m: &Margin,
    scene: &Scene<'_>,
    limit: &dyn Fn() -> f64,
    meet: &dyn Fn(HitOn<Margin>) -> bool,
) {
    let runs = match fate(scene.ray) {
        Fate::Misses => false,
        Fate::Runs => true,
        Fate::MayMiss => m.decided(m.truth(true, true, true)),
    };
    if !runs {
        return;
    }
    let end = Cell::new(scene.ray.t_max.0.range.high);
    scene.walk(&end, &mut |id| {
        let mark = m.forms.len();
        let hit = (scene.intersect)(id);
        if !m.decided(scene.accepts(m, &hit)) {
            m.forms.truncate(mark);
            return false;
        }
        let goes_on = meet(HitOn { prim_id: U(id), ..hit });
        end.set(limit());
        !goes_on
    });
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

impl Scene<'_> {
    /// Whether there is a hit, within the ray's range.
    fn accepts(&self, m: &Margin, hit: &HitOn<Margin>) -> Truth {
        let late = m.f32_compare(Compare::Ge, hit.t.0, self.ray.t_min.0);
        let early = m.f32_compare(Compare::Le, hit.t.0, self.ray.t_max.0);
        let inside = m.bool_binary(BoolBinary::And, late, early);
        m.bool_binary(BoolBinary::And, hit.is_hit.0, inside)
    }

    /// Every way in which one primitive is hit. Forms are kept for the results alone.
    fn ways(&self, m: &Margin, id: u32) -> Explored<Option<[Kept; 3]>> {
        m.each_way(WAYS, &|| {
            let mark = m.forms.len();
            let hit = (self.intersect)(id);
            let accepted = m.decided(self.accepts(m, &hit));
            let results = [hit.t.0, hit.u.0, hit.v.0].map(|v| (v, m.forms.get(v.form, v.range)));
            m.forms.truncate(mark);
            accepted.then_some(results)
        })
    }

    /// The hits of one primitive; ways that rounding cannot tell apart are one.
    fn ask(&self, m: &Margin, id: u32) -> Vec<Found> {
        // Most are missed for certain, which intervals can tell.
        let quick = m.forms.without(|| self.ways(m, id));
        if quick.is_complete && quick.results.iter().all(Option::is_none) {
            return Vec::new();
        }
        let ways = self.ways(m, id);
        if !ways.is_complete && m.is_running() {
            m.decisions.lose();
        }
        let is_certain = ways.is_complete && ways.results.iter().all(Option::is_some);
        let mut found: Vec<Found> = Vec::new();
        for (way, result) in ways.results.into_iter().enumerate() {
            let Some(results) = result else { continue };
            let [t, u, v] =
                results.map(|(v, form)| Bounded { form: m.forms.put(form), parts: None, ..v });
            // What was accepted is a number between the ends of the ray.
            let first = self.ray.t_min.0.range.low.max(t.range.low);
            let last = self.ray.t_max.0.range.high.min(t.range.high);
            let t = Bounded { range: Interval::new(first, last, false), ..t };
            let near = found.iter_mut().find(|f| {
                [(f.t, t), (f.u, u), (f.v, v)].iter().all(|(a, b)| a.range.overlaps(b.range))
            });
            match near {
                Some(f) => {
                    let join = |a: Bounded, b: Bounded| m.bounded(a.value, a.range.hull(b.range));
                    (f.t, f.u, f.v) = (join(f.t, t), join(f.u, u), join(f.v, v));
                }
                None => {
                    found.push(Found { id, t, u, v, is_certain: false, is_reference: way == 0 });
                }
            }
        }
        // Of several hits that differ none is certain.
        if let ([only], true) = (&mut found[..], is_certain) {
            only.is_certain = true;
        }
        found
    }

    /// The hits that may be the closest.
    fn candidates(&self, found: Vec<Found>) -> Vec<Found> {
        let certain: Vec<Found> = found.iter().copied().filter(|h| h.is_certain).collect();
        let loses = |h: &Found, to: &Found| {
            to.t.range.high < h.t.range.low || to.id < h.id && to.t.range.high <= h.t.range.low
        };
        let near: Vec<Found> =
            found.into_iter().filter(|h| !certain.iter().any(|c| loses(h, c))).collect();
        if near.len() < 2 {
            return near;
        }
        // Copies of a primitive are hit alike, and the first one wins.
        let bytes: Vec<Vec<u8>> = near.iter().map(|h| (self.bytes)(h.id)).collect();
        let is_copy = |(h, own): &(&Found, &Vec<u8>)| {
            near.iter().zip(&bytes).any(|(other, b)| other.id < h.id && b == *own)
        };
        near.iter().zip(&bytes).filter(|h| !is_copy(h)).map(|(h, _)| *h).collect()
    }

    /// Visits the primitives that some variant may hit at or before `limit`, until `visit` returns
    /// true.
    fn walk(&self, limit: &Cell<f64>, visit: &mut dyn FnMut(u32) -> bool) {
        let _ = self.parts.iter().any(|part| self.walk_part(part, limit, visit));
    }

    fn walk_part(
        &self,
        part: &Part<'_>,
        limit: &Cell<f64>,
        visit: &mut dyn FnMut(u32) -> bool,
    ) -> bool {
        let Some(tree) = part.tree else {
            return (part.first..part.first + part.len).any(visit);
        };
        let Some(root) = tree.nodes.first() else { return false };
        let beam = Beam::new(self.ray, root, self.slack);
        let mut stack = vec![root];
        while let Some(node) = stack.pop() {
            if !beam.meets(node, limit.get()) {
                continue;
            }
            let (first, count) = (node.first as usize, node.count as usize);
            if !node.is_leaf() {
                let children = &tree.nodes[first..first + 2];
                // The nearer one comes off the stack first.
                let is_left_near = beam.enters(&children[0]) <= beam.enters(&children[1]);
                let order = if is_left_near { [1, 0] } else { [0, 1] };
                stack.extend(order.map(|i| &children[i]));
                continue;
            }
            if tree.indices[first..first + count].iter().any(|id| visit(part.first + id)) {
                return true;
            }
        }
        false
    }
}
