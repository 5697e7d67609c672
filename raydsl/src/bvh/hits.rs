//! Ordered multi-hit queries in batches.
//!
//! A query finds the next few hits behind the last one; when those are consumed, another finds the
//! following ones. The crossings of a primitive are a chain: `intersect` of the ray, then of the
//! ray from behind each crossing on. Every query follows it from the beginning, so that batch
//! boundaries make no difference. So no traversal state is kept between two hits, hits come in one
//! order whatever finds them, and a hit in several leaves comes once. (After Amstutz, Gribble,
//! Guenther and Wald, "An Evaluation of Multi-Hit Ray Traversal in a BVH using Existing
//! First-Hit/Any-Hit Kernels", JCGT 4(4), 2015.)

use core::iter::FusedIterator;

use super::contract::{behind, is_before, is_within};
use super::on::{AllHits, LocalRay};
use super::query::{RecordOn, inserted, is_placed, limit_of, record_on, select};
use super::{RayQueryOn, SceneView, View};
use crate::geometry::{Hit, HitOn, HitRecord, Kinds, Primitive, Ray, RayOn};
use crate::machine::{B, Branch, Cursor, F, KernelInfo, Loop, Machine, Scalar, Type, U, Var, op};

/// Number of hits that one query finds.
const BATCH: usize = 4;

/// Iterator over the hits of a ray, in the order of `(t, inst_id, prim_id)`: see
/// [`RecordQuery::hits`](super::RecordQuery::hits).
pub struct Hits<V: RayQueryOn> {
    m: Scalar,
    ray: Ray,
    hits: V::Hits<Scalar>,
    state: <V::Hits<Scalar> as Cursor<Scalar>>::State,
}

impl<V: RayQueryOn> Hits<V> {
    pub(super) fn new(scene: V, ray: Ray) -> Self {
        let m = Scalar::default();
        let hits = scene.hits(&m, Type::splat(&m, ray));
        let state = hits.begin(&m);
        Self { m, ray, hits, state }
    }
}

impl<V: RayQueryOn> core::fmt::Debug for Hits<V> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Hits").field("ray", &self.ray).finish_non_exhaustive()
    }
}

impl<V: RayQueryOn> Iterator for Hits<V> {
    type Item = V::Hit;

    fn next(&mut self) -> Option<V::Hit> {
        let is_there = self.hits.advance(&self.m, &self.state).0;
        is_there.then(|| V::Hit::lane::<Scalar>(&self.hits.item(&self.m, &self.state), 0))
    }
}

impl<V: RayQueryOn> FusedIterator for Hits<V> {}

/// [`Hits`], lifted.
pub struct HitsOn<'a, M: Machine, P: Primitive> {
    pub(super) scene: SceneView<'a, P>,
    pub(super) ray: RayOn<M>,
}

/// A hit, and the `t_min` of the `intersect` call that returned it.
type Crossing<M> = (HitOn<M>, F<M>);

/// State of a loop over hits.
pub struct State<M: Machine> {
    /// Hits found but not yet consumed, in order, followed by misses.
    pending: Var<[Crossing<M>; BATCH]>,
    /// The current hit; a miss before the first.
    last: Var<Crossing<M>>,
    /// Whether there may be hits behind the pending ones.
    has_more: Var<B<M>>,
}

#[inline(always)]
fn miss<M: Machine>(m: &M) -> Crossing<M> {
    (Hit::splat(m, Hit::miss()), F(m.f32(0.0)))
}

impl<M: Machine, P: Primitive> Cursor<M> for HitsOn<'_, M, P> {
    type Item = RecordOn<M, P>;
    type State = State<M>;

    #[inline(always)]
    fn begin(&self, m: &M) -> State<M> {
        State {
            pending: Var::new(m, "pending", [miss(m); BATCH]),
            last: Var::new(m, "last", miss(m)),
            has_more: Var::new(m, "has_more", B(m.bool(true))),
        }
    }

    #[inline(always)]
    fn advance(&self, m: &M, state: &State<M>) -> B<M> {
        let [first, ..] = state.pending.get(m);
        // Refill the batch when it is empty.
        let is_due = m.bool_binary(op::And, m.bool_not(first.0.is_hit.0), state.has_more.get(m).0);
        let is_due = Branch::new(m, B(is_due));
        if is_due.then(m) {
            let found = next_hits(m, &self.scene, self.ray, state.last.get(m).0);
            state.pending.set(m, found);
            state.has_more.set(m, found[BATCH - 1].0.is_hit);
        }
        is_due.end(m);
        // Shift the first pending hit into `last`.
        let [first, others @ ..] = state.pending.get(m);
        let mut pending = [miss(m); BATCH];
        pending[..BATCH - 1].copy_from_slice(&others);
        state.last.set(m, first);
        state.pending.set(m, pending);
        first.0.is_hit
    }

    #[inline(always)]
    fn item(&self, m: &M, state: &State<M>) -> RecordOn<M, P> {
        let (hit, t_min) = state.last.get(m);
        record_on(m, &self.scene, RayOn { t_min, ..self.ray }, hit)
    }
}

static NEXT_HITS: KernelInfo = KernelInfo {
    name: "next_hits",
    file: file!(),
    line: line!(),
    params: &["ray", "last"],
    known: None,
};

/// Returns the first hits behind `last`, or the first of all if that is a miss, followed by misses.
/// Always compiled as a function of its own.
#[inline(always)]
fn next_hits<M: Machine, P: Primitive>(
    m: &M,
    scene: &SceneView<'_, P>,
    ray: RayOn<M>,
    last: HitOn<M>,
) -> [Crossing<M>; BATCH] {
    m.call_apart(
        &NEXT_HITS,
        (ray, last),
        #[inline(always)]
        |m, (ray, last)| {
            let found = Var::new(m, "found", [miss(m); BATCH]);
            let search = Search { m, scene, ray, last, found };
            m.visit(
                &AllHits(scene),
                ray,
                #[inline(always)]
                || limit_of(m, scene, search.farthest(), ray),
                #[inline(always)]
                |(hit, _)| {
                    search.keep_crossings(hit);
                    B(m.bool(true))
                },
            );
            search.found.get(m)
        },
    )
}

/// Search for the next hits.
struct Search<'s, 'a, M: Machine, P: Primitive> {
    m: &'s M,
    scene: &'s SceneView<'a, P>,
    ray: RayOn<M>,
    last: HitOn<M>,
    found: Var<[Crossing<M>; BATCH]>,
}

impl<M: Machine, P: Primitive> Search<'_, '_, M, P> {
    /// Returns the last of the hits found.
    #[inline(always)]
    fn farthest(&self) -> HitOn<M> {
        self.found.get(self.m)[BATCH - 1].0
    }

    /// Keeps the crossings of a primitive whose first is `hit`.
    #[inline(always)]
    fn keep_crossings(&self, hit: HitOn<M>) {
        let m = self.m;
        self.keep((hit, self.ray.t_min));
        let most = if M::RUNS { P::MAX_CROSSINGS } else { P::limits_of(self.scene.kinds()).1 };
        if most < 2 {
            return;
        }
        if most == 2 {
            let goes_on = Branch::new(m, B(self.goes_on(hit)));
            if goes_on.then(m) {
                self.keep(self.next_crossing(hit));
            }
            goes_on.end(m);
            return;
        }
        let at = Var::new(m, "crossing", hit);
        let left = Var::new(m, "left", U(m.u32(most - 1)));
        let repeat = Loop::new(m);
        loop {
            let some_left = m.u32_compare(op::Gt, left.get(m).0, m.u32(0));
            let goes_on = m.bool_binary(op::And, some_left, self.goes_on(at.get(m)));
            if !repeat.test(m, B(goes_on)) {
                break;
            }
            let next = self.next_crossing(at.get(m));
            self.keep(next);
            at.set(m, next.0);
            left.set(m, U(m.u32_binary(op::WrappingSub, left.get(m).0, m.u32(1))));
            repeat.continuing(m);
            if !repeat.again(m) {
                break;
            }
        }
        repeat.end(m);
    }

    /// Returns whether a crossing behind this one may be among the next hits.
    #[inline(always)]
    fn goes_on(&self, hit: HitOn<M>) -> M::Bool {
        let is_near = is_before::on(self.m, is_placed(self.scene), hit, self.farthest());
        self.m.bool_binary(op::And, hit.is_hit.0, is_near.0)
    }

    /// Returns where the ray crosses the primitive next, behind `hit`.
    #[inline(always)]
    fn next_crossing(&self, hit: HitOn<M>) -> Crossing<M> {
        let (m, scene) = (self.m, self.scene);
        let t_min = behind::on(m, hit.t);
        let ray = RayOn { t_min, ..self.ray };
        let local = match scene.placed() {
            Some(_) => m.perform(&LocalRay(scene), (ray, hit.inst_id)),
            None => ray,
        };
        let kinds = if M::RUNS { Kinds::ALL } else { scene.kinds() };
        let prim = m.fetch(scene, hit.prim_id);
        let found = P::intersect_among_on(m, kinds, prim, local, View::shared(scene));
        let next = HitOn { prim_id: hit.prim_id, inst_id: hit.inst_id, ..P::Hit::hit_on(found) };
        (HitOn { is_hit: is_within::on(m, next, ray), ..next }, t_min)
    }

    /// Keeps a hit if it is behind the last one and before one already kept.
    #[inline(always)]
    fn keep(&self, crossing: Crossing<M>) {
        let (is_placed, found) = (is_placed(self.scene), self.found.get(self.m));
        let kept = self.m.call(
            &WITH_HIT,
            (found, self.last, crossing),
            #[inline(always)]
            |m, (found, last, crossing)| with_hit(m, is_placed, found, last, crossing),
        );
        self.found.set(self.m, kept);
    }
}

static WITH_HIT: KernelInfo = KernelInfo {
    name: "with_hit",
    file: file!(),
    line: line!(),
    params: &["found", "last", "crossing"],
    known: None,
};

/// Inserts a hit into `found` if it is behind `last` and before one already there.
#[inline(always)]
fn with_hit<M: Machine>(
    m: &M,
    is_placed: bool,
    found: [Crossing<M>; BATCH],
    last: HitOn<M>,
    crossing: Crossing<M>,
) -> [Crossing<M>; BATCH] {
    let and = |a, b| m.bool_binary(op::And, a, b);
    let or = |a, b| m.bool_binary(op::Or, a, b);
    let before = |a, b| is_before::on(m, is_placed, a, b);
    let hit = crossing.0;
    let is_behind = or(m.bool_not(last.is_hit.0), before(last, hit).0);
    let is_new = and(is_behind, m.bool_not(is_among(m, is_placed, hit, &found)));
    let fits = and(hit.is_hit.0, and(is_new, before(hit, found[BATCH - 1].0).0));
    let all = Var::new(m, "all", found);
    let fits = Branch::new(m, B(fits));
    if fits.then(m) {
        let is_first = |a: Crossing<M>, b: Crossing<M>| before(a.0, b.0);
        let chosen = |c: B<M>, a: Crossing<M>, b: Crossing<M>| {
            (select(m, c, a.0, b.0), F(m.f32_select(c.0, a.1.0, b.1.0)))
        };
        all.set(m, inserted(m, is_first, chosen, crossing, found));
    }
    fits.end(m);
    all.get(m)
}

/// Returns whether the hit is already found: a tree with spatial splits refers to primitives more
/// than once.
#[inline(always)]
fn is_among<M: Machine>(
    m: &M,
    is_placed: bool,
    hit: HitOn<M>,
    found: &[Crossing<M>; BATCH],
) -> M::Bool {
    let and = |a, b| m.bool_binary(op::And, a, b);
    found.iter().fold(m.bool(false), |any, (h, _)| {
        let same_t = m.f32_compare(op::Eq, h.t.0, hit.t.0);
        let mut same = and(same_t, m.u32_compare(op::Eq, h.prim_id.0, hit.prim_id.0));
        if is_placed {
            same = and(same, m.u32_compare(op::Eq, h.inst_id.0, hit.inst_id.0));
        }
        m.bool_binary(op::Or, any, and(same, h.is_hit.0))
    })
}
