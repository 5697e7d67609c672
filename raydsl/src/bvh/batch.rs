//! Batched ray queries on the host, in ray packets.

use super::on::{AnyHits, ClosestHits};
use super::wide::trace;
use super::{SceneView, record_on, traverse};
use crate::geometry::{Primitive, Ray};
use crate::machine::{B, Lanes, Machine, Packet, Type, fill};
use crate::run::{LanesTask, Variant};

/// Packets per query: ray streams are faster with more rays.
const PACKETS: usize = 8;

/// Finds the record of the least `(t, id)` hit of each ray.
pub(super) fn closest_hits<P: Primitive>(scene: &SceneView<'_, P>, rays: &[Ray]) -> Vec<P::Hit> {
    if let Some(queries) = scene.queries() {
        let mut hits = Vec::with_capacity(rays.len());
        trace::each_closest((scene, queries), rays, |ray, hit| {
            hits.push(traverse::complete(scene, *ray, hit));
        });
        return hits;
    }
    let hits = Variant::widest().with_lanes(Closest { scene, rays });
    hits.unwrap_or_else(|| rays.iter().map(|ray| traverse::closest_hit(scene, *ray)).collect())
}

/// Returns whether each ray hits anything.
pub(super) fn any_hits<P: Primitive>(scene: &SceneView<'_, P>, rays: &[Ray]) -> Vec<bool> {
    if let Some(queries) = scene.queries() {
        let mut hits = Vec::with_capacity(rays.len());
        trace::each_any((scene, queries), rays, |is_hit| hits.push(is_hit));
        return hits;
    }
    let hits = Variant::widest().with_lanes(Any { scene, rays });
    hits.unwrap_or_else(|| rays.iter().map(|ray| traverse::any_hit(scene, *ray)).collect())
}

struct Closest<'a, 's, P: Primitive> {
    scene: &'a SceneView<'s, P>,
    rays: &'a [Ray],
}

struct Any<'a, 's, P: Primitive> {
    scene: &'a SceneView<'s, P>,
    rays: &'a [Ray],
}

impl<P: Primitive> LanesTask for Closest<'_, '_, P> {
    type Output = Vec<P::Hit>;

    fn run<L: Lanes>(self, lanes: L) -> Vec<P::Hit> {
        let mut hits = Vec::with_capacity(self.rays.len());
        lanes.vectorize(|| {
            let m = Packet::new(lanes);
            for rays in self.rays.chunks(PACKETS * L::N) {
                let packets = packets(&m, rays);
                let found = m.perform(&ClosestHits(self.scene), packets);
                for (i, _) in rays.iter().enumerate().step_by(L::N) {
                    let q = i / L::N;
                    let record = record_on(&m, self.scene, packets[q], found[q]);
                    let left = rays.len() - i;
                    // Not `extend`: its closure, with the lanes in it, is not always inlined.
                    for lane in 0..L::N.min(left) {
                        hits.push(P::Hit::lane(&record, lane));
                    }
                }
            }
        });
        hits
    }
}

impl<P: Primitive> LanesTask for Any<'_, '_, P> {
    type Output = Vec<bool>;

    fn run<L: Lanes>(self, lanes: L) -> Vec<bool> {
        let mut hits = Vec::with_capacity(self.rays.len());
        lanes.vectorize(|| {
            let m = Packet::new(lanes);
            for rays in self.rays.chunks(PACKETS * L::N) {
                let found: [B<Packet<L>>; PACKETS] =
                    m.perform(&AnyHits(self.scene), packets(&m, rays));
                for i in 0..rays.len() {
                    hits.push(L::mask_lane(&found[i / L::N].0, i % L::N));
                }
            }
        });
        hits
    }
}

/// Loads the rays as packets; unused lanes get a ray that hits nothing.
#[inline(always)]
fn packets<L: Lanes>(m: &Packet<L>, rays: &[Ray]) -> [<Ray as Type>::On<Packet<L>>; PACKETS] {
    let none = Ray::new(glam::Vec3::NAN, glam::Vec3::NAN);
    fill(
        #[inline(always)]
        |q| {
            Ray::from_lanes(
                m,
                #[inline(always)]
                |lane| rays.get(q * L::N + lane).copied().unwrap_or(none),
            )
        },
    )
}
