//! Tree queries under rounding: all hits that some rounding may select.
//!
//! Every primitive is intersected in all ways in which its own decisions may go. The hits that may
//! be the closest in some variant are the alternatives of one decision.
//!
//! Only the intersection depends on the type of primitives; the rest is compiled once.

use core::cell::Cell;
use std::rc::Rc;

use glam::Vec3;

use super::beam::Beam;
use crate::bvh::contract::is_within;
use crate::bvh::{Branches, Padding, Placing, RecordOn, SceneView, Target, View};
use crate::geometry::{HitOn, HitRecord, Primitive, Ray, RayOn, Shared, transform_ray};
use crate::machine::margin::{Explored, Form, Interval, Known, Margin, Truth};
use crate::machine::{B, Data, F, Machine, Type, U, V3};

/// Maximum number of variants in which one primitive is intersected.
const WAYS: usize = 64;

/// Primitives of any type, the trees over them if there are any, and a ray.
pub(super) struct Scene<'a> {
    ray: RayOn<Margin>,
    parts: Vec<Part<'a>>,
    /// Groups in which the parts are placed, if they are.
    groups: Option<&'a [Placing]>,
    /// Padding of the trees that are parts.
    padding: Padding,
    /// Intersects the ray with a primitive.
    intersect: &'a dyn Fn(Name) -> HitOn<Margin>,
    /// Identifies a primitive: its bytes, and its placement.
    bytes: &'a dyn Fn(Name) -> Vec<u8>,
}

/// Identity of a primitive. The order is that of hits at one distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Name {
    inst: u32,
    prim: u32,
}

/// Some of the primitives, and the tree over them if there is one.
struct Part<'a> {
    first: u32,
    len: u32,
    tree: Option<Branches<'a>>,
}

/// Runs `query` on `prims` of any type. `found` receives the record of each intersected primitive.
pub(super) fn query<P: Primitive, R>(
    m: &Margin,
    prims: &SceneView<'_, P>,
    ray: RayOn<Margin>,
    found: impl Fn(RecordOn<Margin, P>),
    query: impl FnOnce(&Margin, &Scene<'_>) -> R,
) -> R {
    let bytes = |name: Name| {
        let mut bytes = vec![0; P::SCHEMA.size()];
        prims.get(name.prim).write(&mut bytes);
        if let Some(placed) = prims.placed() {
            // Include every level: different maps may have one product.
            placed.each_level(name.inst, |_, item| {
                bytes.extend(item.to_object.to_cols_array().into_iter().flat_map(f32::to_le_bytes));
            });
        }
        bytes
    };
    let intersect = |name: Name| {
        let ray = local_ray(m, prims, name.inst, ray);
        let record = P::intersect_one_on(m, &prims.get(name.prim), ray, prims.stored().views());
        found(record);
        P::Hit::hit_on(record)
    };
    let parts = prims.parts();
    let scene = Scene {
        ray,
        parts: parts
            .map(|p| Part { first: p.first, len: p.prims.len() as u32, tree: p.tree() })
            .collect(),
        groups: prims.placed().map(|placed| &placed.groups[..]),
        padding: Padding::of::<P>(),
        intersect: &intersect,
        bytes: &bytes,
    };
    query(m, &scene)
}

/// Returns the ray in the space of an instance's tree.
pub(super) fn local_ray<T, S: Shared>(
    m: &Margin,
    scene: &View<'_, T, S>,
    inst: u32,
    ray: RayOn<Margin>,
) -> RayOn<Margin> {
    let mut ray = ray;
    if let Some(placed) = scene.placed() {
        placed.each_level(inst, |_, item| {
            ray = transform_ray::on(m, ray, Type::splat(m, item.to_object));
        });
    }
    ray
}

/// A float that outlives its run, with the form of its errors.
type Kept = (Known, Option<Rc<Form>>);

/// Possible hit of a primitive.
#[derive(Clone, Copy)]
struct Found {
    name: Name,
    t: Known,
    u: Known,
    v: Known,
    /// Whether it is hit in every variant.
    is_certain: bool,
    /// Whether the `f64` reference hits it.
    is_reference: bool,
}

/// Returns the ray with only its own components rounded.
pub(super) fn rounded(m: &Margin, ray: RayOn<Margin>) -> Ray {
    let number = |v: F<Margin>| m.get(v.0).value as f32;
    let vector = |v: V3<Margin>| Vec3::new(number(v.x), number(v.y), number(v.z));
    Ray {
        origin: vector(ray.origin),
        direction: vector(ray.direction),
        t_min: number(ray.t_min),
        t_max: number(ray.t_max),
    }
}

/// Returns the least `(t, id)` hit.
pub(super) fn closest_hit(m: &Margin, scene: &Scene<'_>) -> HitOn<Margin> {
    let mut found = Vec::new();
    let fate = fate(m, scene.ray);
    let limit = Cell::new(m.get(scene.ray.t_max.0).range.high);
    // Collect all possible hits; certain ones lower the limit.
    if fate != Fate::Misses {
        scene.traverse(m, &limit, &mut |name| {
            let hits = scene.ask(m, name);
            for hit in hits.iter().filter(|h| h.is_certain) {
                limit.set(limit.get().min(hit.t.range.high));
            }
            found.extend(hits);
            false
        });
    }
    let may_miss = fate != Fate::Runs || !found.iter().any(|h| h.is_certain);
    let candidates = scene.candidates(found);
    // Put the reference's hit first among the candidates.
    let by_t = |a: &&Found, b: &&Found| a.t.value.total_cmp(&b.t.value).then(a.name.cmp(&b.name));
    let reference = candidates.iter().filter(|h| h.is_reference).min_by(by_t).map(|h| h.name);
    let mut hits: Vec<Option<Found>> = candidates.into_iter().map(Some).collect();
    if may_miss {
        hits.push(None);
    }
    let is_first = |h: &Option<Found>| match h {
        Some(h) => h.is_reference && Some(h.name) == reference,
        None => reference.is_none(),
    };
    if let Some(at) = hits.iter().position(is_first) {
        hits.swap(0, at);
    }
    // The closest hit is no farther than any certain one.
    let near = Interval::new(f64::NEG_INFINITY, limit.get(), false);
    let cut = |h: Found| Found { t: Known { range: h.t.range.narrowed(near), ..h.t }, ..h };
    hit_on(m, m.one_of(None, &hits).map(cut))
}

/// Returns whether anything is hit.
pub(super) fn any_hit(m: &Margin, scene: &Scene<'_>) -> Truth {
    let fate = fate(m, scene.ray);
    if fate == Fate::Misses {
        return Truth::certain(false);
    }
    let (mut may_be, mut is_certain, mut is_reference) = (false, false, false);
    let limit = Cell::new(m.get(scene.ray.t_max.0).range.high);
    scene.traverse(m, &limit, &mut |name| {
        for hit in scene.ask(m, name) {
            may_be = true;
            is_certain |= hit.is_certain && fate == Fate::Runs;
            is_reference |= hit.is_reference;
        }
        is_certain
    });
    m.truth(is_reference, may_be, !is_certain)
}

/// Calls `meet` for every hit of the current variant, until it returns false.
pub(super) fn visit(
    m: &Margin,
    scene: &Scene<'_>,
    limit: &dyn Fn() -> f64,
    meet: &dyn Fn(HitOn<Margin>) -> bool,
) {
    let runs = match fate(m, scene.ray) {
        Fate::Misses => false,
        Fate::Runs => true,
        Fate::MayMiss => m.decided(m.truth(true, true, true)),
    };
    if !runs {
        return;
    }
    let end = Cell::new(m.get(scene.ray.t_max.0).range.high);
    scene.traverse(m, &end, &mut |name| {
        let (floats, forms) = (m.floats.mark(), m.forms.len());
        let hit = (scene.intersect)(name);
        let is_accepted = m.decided(scene.accepts(m, &hit));
        let mut goes_on = true;
        if is_accepted {
            goes_on = meet(HitOn { prim_id: U(name.prim), inst_id: U(name.inst), ..hit });
            end.set(limit());
        } else {
            m.forms.truncate(forms);
        }
        // Kept data of a hit is in variables.
        m.floats.drop_since(floats);
        !goes_on
    });
}

fn hit_on(m: &Margin, found: Option<Found>) -> HitOn<Margin> {
    let number = |v: Option<Known>| F(v.map_or_else(|| m.f32(0.0), |v| m.put(v)));
    HitOn {
        is_hit: B(m.bool(found.is_some())),
        t: number(found.map(|h| h.t)),
        prim_id: U(found.map_or(0, |h| h.name.prim)),
        inst_id: U(found.map_or(0, |h| h.name.inst)),
        u: number(found.map(|h| h.u)),
        v: number(found.map(|h| h.v)),
    }
}

/// Fate of a ray, which misses everything if a component is not finite.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Runs,
    MayMiss,
    Misses,
}

fn fate(m: &Margin, ray: RayOn<Margin>) -> Fate {
    let (o, d) = (ray.origin, ray.direction);
    let all = [o.x, o.y, o.z, d.x, d.y, d.z].map(|c| m.get(c.0).range);
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
    /// Returns whether there is a hit within the ray's range.
    fn accepts(&self, m: &Margin, hit: &HitOn<Margin>) -> Truth {
        is_within::on(m, *hit, self.ray).0
    }

    /// Explores all variants of intersecting one primitive. Forms are kept for the results alone.
    fn ways(&self, m: &Margin, name: Name) -> Explored<Option<[Kept; 3]>> {
        m.each_way(WAYS, &|| {
            let mark = m.forms.len();
            let hit = (self.intersect)(name);
            let accepted = m.decided(self.accepts(m, &hit));
            let results = [hit.t.0, hit.u.0, hit.v.0].map(|v| {
                let v = m.get(v);
                (v, m.forms.get(v.form, v.range))
            });
            m.forms.truncate(mark);
            accepted.then_some(results)
        })
    }

    /// Returns the hits of one primitive; variants within rounding of each other are merged.
    fn ask(&self, m: &Margin, name: Name) -> Vec<Found> {
        // Most primitives are certain misses, which intervals alone can tell.
        let quick = m.forms.without(|| self.ways(m, name));
        if quick.is_complete && quick.results.iter().all(Option::is_none) {
            return Vec::new();
        }
        let ways = self.ways(m, name);
        if !ways.is_complete && m.is_running() {
            m.lose();
        }
        let (t_min, t_max) = (m.get(self.ray.t_min.0).range, m.get(self.ray.t_max.0).range);
        let is_certain = ways.is_complete && ways.results.iter().all(Option::is_some);
        let mut found: Vec<Found> = Vec::new();
        for (way, result) in ways.results.into_iter().enumerate() {
            let Some(results) = result else { continue };
            let [t, u, v] =
                results.map(|(v, form)| Known { form: m.forms.put(form), parts: None, ..v });
            // An accepted hit is a number within the range of the ray.
            let first = t_min.low.max(t.range.low);
            let last = t_max.high.min(t.range.high);
            let t = Known { range: Interval::new(first, last, false), ..t };
            // Merge it with a hit found before if their ranges overlap.
            let near = found.iter_mut().find(|f| {
                [(f.t, t), (f.u, u), (f.v, v)].iter().all(|(a, b)| a.range.overlaps(b.range))
            });
            match near {
                Some(f) => {
                    let join = |a: Known, b: Known| m.bounded(a.value, a.range.hull(b.range));
                    (f.t, f.u, f.v) = (join(f.t, t), join(f.u, u), join(f.v, v));
                }
                None => {
                    found.push(Found { name, t, u, v, is_certain: false, is_reference: way == 0 });
                }
            }
        }
        // Of several different hits none is certain.
        if let ([only], true) = (&mut found[..], is_certain) {
            only.is_certain = true;
        }
        found
    }

    /// Returns the hits that may be the closest.
    fn candidates(&self, found: Vec<Found>) -> Vec<Found> {
        let certain: Vec<Found> = found.iter().copied().filter(|h| h.is_certain).collect();
        let loses = |h: &Found, to: &Found| {
            let is_first = to.name < h.name;
            to.t.range.high < h.t.range.low || is_first && to.t.range.high <= h.t.range.low
        };
        let near: Vec<Found> =
            found.into_iter().filter(|h| !certain.iter().any(|c| loses(h, c))).collect();
        if near.len() < 2 {
            return near;
        }
        // Copies of a primitive have equal hits, and the first one wins.
        let bytes: Vec<Vec<u8>> = near.iter().map(|h| (self.bytes)(h.name)).collect();
        let is_copy = |(h, own): &(&Found, &Vec<u8>)| {
            near.iter().zip(&bytes).any(|(other, b)| other.name < h.name && b == *own)
        };
        near.iter().zip(&bytes).filter(|h| !is_copy(h)).map(|(h, _)| *h).collect()
    }

    /// Visits the primitives that some variant may hit at or before `limit`, until `visit` returns
    /// true.
    fn traverse(&self, m: &Margin, limit: &Cell<f64>, visit: &mut dyn FnMut(Name) -> bool) {
        match self.groups {
            None => {
                let each = |part| self.traverse_part(m, part, 0, self.ray, limit, visit);
                let _ = self.parts.iter().any(each);
            }
            Some(groups) => {
                if let Some(top) = groups.last() {
                    self.traverse_group(m, top, 0, self.ray, limit, visit);
                }
            }
        }
    }

    /// Runs [`Scene::traverse`] in a group whose first tree has the index `first`.
    fn traverse_group(
        &self,
        m: &Margin,
        group: &Placing,
        first: u32,
        ray: RayOn<Margin>,
        limit: &Cell<f64>,
        visit: &mut dyn FnMut(Name) -> bool,
    ) -> bool {
        if fate(m, ray) == Fate::Misses {
            return false;
        }
        traverse_tree(m, group.branches(), ray, group.padding, limit, &mut |index| {
            let item = &group.items[index as usize];
            let first = first + item.first;
            let mark = m.floats.mark();
            let ray = transform_ray::on(m, ray, Type::splat(m, item.to_object));
            let ends = match item.target {
                // Coordinates that overflow in the transform miss.
                Target::Tree(_) if fate(m, ray) == Fate::Misses => false,
                Target::Tree(tree) => {
                    self.traverse_part(m, &self.parts[tree as usize], first, ray, limit, visit)
                }
                Target::Group(group) => {
                    let groups = self.groups.unwrap_or(&[]);
                    self.traverse_group(m, &groups[group as usize], first, ray, limit, visit)
                }
            };
            m.floats.drop_since(mark);
            ends
        })
    }

    fn traverse_part(
        &self,
        m: &Margin,
        part: &Part<'_>,
        inst: u32,
        ray: RayOn<Margin>,
        limit: &Cell<f64>,
        visit: &mut dyn FnMut(Name) -> bool,
    ) -> bool {
        let mut visit = |id| visit(Name { inst, prim: part.first + id });
        match part.tree {
            Some(tree) => traverse_tree(m, tree, ray, self.padding, limit, &mut visit),
            None => (0..part.len).any(visit),
        }
    }
}

/// Visits the contents of leaves that the ray may hit at or before `limit`, until `visit` returns
/// true.
fn traverse_tree(
    m: &Margin,
    tree: Branches<'_>,
    ray: RayOn<Margin>,
    padding: Padding,
    limit: &Cell<f64>,
    visit: &mut dyn FnMut(u32) -> bool,
) -> bool {
    let Some(root) = tree.nodes.first() else { return false };
    let beam = Beam::new(m, ray, root, padding);
    let mut stack = vec![root];
    while let Some(node) = stack.pop() {
        if !beam.meets(node, limit.get()) {
            continue;
        }
        let (first, count) = (node.first as usize, node.count as usize);
        if !node.is_leaf() {
            let children = &tree.nodes[first..first + 2];
            // Push the farther child first, so that the nearer one is popped first.
            let is_left_near = beam.enters(&children[0]) <= beam.enters(&children[1]);
            let order = if is_left_near { [1, 0] } else { [0, 1] };
            stack.extend(order.map(|i| &children[i]));
            continue;
        }
        if tree.indices[first..first + count].iter().any(|id| visit(*id)) {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel;
    use crate::machine::{Capture, Outcomes, Rounding};
    use crate::prelude::{Bvh, Hit, RecordQuery, primitive, vec3};

    #[primitive(sphere(center, radius))]
    #[derive(Debug)]
    struct Ball {
        center: Vec3,
        radius: f32,
    }

    #[kernel]
    fn met(balls: &Bvh<'_, Ball>, ray: Ray) -> (f32, f32) {
        let nearest = balls.closest_hit_where(ray, |hit: Hit| {
            let mut t = hit.t;
            for _ in 0..3u32 {
                t *= 0.5;
                if t < 0.125 {
                    return false;
                }
            }
            t > 0.25
        });
        let last = balls.multi_hit_by::<2>(ray, |a: Hit, b: Hit| a.t > b.t);
        (nearest.t, last[0].t + last[1].t)
    }

    /// Data that a query keeps of one primitive is freed before the next one.
    #[test]
    fn many_hits_take_little_memory() {
        let most = |count: u16| {
            let ball = |i| Ball { center: vec3(0.0, 0.0, 4.0 + 4.0 * f32::from(i)), radius: 1.0 };
            let balls: Vec<Ball> = (0..count).map(ball).collect();
            let bvh = Bvh::build(&balls).expect("finite bounds");
            let ray = Ray::new(Vec3::ZERO, Vec3::Z);
            let most = Cell::new(0);
            let outcomes = Outcomes::of(Rounding::IEEE, 1, |m| {
                let scene = Capture::<Margin>::capture(&bvh, m, "scene");
                let result = met::on(m, scene, Type::splat(m, ray));
                most.set(m.floats.most());
                result
            });
            let found: Vec<f64> = outcomes.reference().iter().map(|leaf| leaf.value()).collect();
            let last = 3.0 + 4.0 * f32::from(count - 1);
            let expected = (3.0, last + (last - 4.0));
            assert_eq!(met(&bvh, ray), expected);
            assert_eq!(found, [expected.0, expected.1].map(f64::from));
            most.get()
        };
        assert_eq!(most(64), most(1000));
    }
}
