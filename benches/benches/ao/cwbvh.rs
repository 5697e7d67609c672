//! The compressed wide tree of obvhs, asked ray by ray.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray as TheirRay, RayHit};
use obvhs::triangle::Triangle as TheirTriangle;
use raydsl::prelude::*;
use raydsl_benches::clock::seconds_on;
use raydsl_benches::contest::{Cost, Outcome, in_parts};

use crate::contender::{Contender, Run};
use crate::rays::Workload;
use crate::row::Row;

/// A tree, and the triangles in the order of its leaves.
pub(crate) struct Tree {
    bvh: CwBvh,
    leaves: Vec<TheirTriangle>,
    pub(crate) cost: Cost,
}

impl Tree {
    /// The best tree that there is a setting for.
    pub(crate) fn new(triangles: &[Triangle], threads: usize) -> Self {
        let wide =
            |t: &Triangle| TheirTriangle { v0: t.v0.into(), v1: t.v1.into(), v2: t.v2.into() };
        let theirs: Vec<TheirTriangle> = triangles.iter().map(wide).collect();
        let params = BvhBuildParams::very_slow_build();
        let build = || build_cwbvh_from_tris(&theirs, params, &mut Default::default());
        let (bvh, seconds) = seconds_on(threads, build);
        let leaves: Vec<TheirTriangle> =
            bvh.primitive_indices.iter().map(|i| theirs[*i as usize]).collect();
        let bytes = size_of_val(&bvh.nodes[..]) + size_of_val(&leaves[..]);
        Self { bvh, leaves, cost: Cost::new(seconds, bytes, triangles.len()) }
    }

    fn closest(&self, ray: TheirRay) -> Option<f32> {
        let mut hit = RayHit::none();
        let meet = |ray: &TheirRay, i: usize| self.leaves[i].intersect(ray);
        self.bvh.ray_traverse(ray, &mut hit, meet).then_some(hit.t)
    }

    fn any(&self, ray: TheirRay) -> bool {
        !self.bvh.ray_traverse_miss(ray, |ray, i| self.leaves[i].intersect(ray))
    }
}

/// Every row.
pub(crate) fn contenders<'a>(
    tree: &'a Tree,
    work: &'a Workload,
    threads: usize,
) -> Vec<Contender<'a>> {
    let closest = |rays| closest(tree, rays, threads);
    let any = |t_max| any(tree, &work.shadow, t_max, threads);
    let runs = [
        (Row::Primary, closest(&work.primary)),
        (Row::AoShort, any(work.short)),
        (Row::AoUnbounded, any(f32::MAX)),
        (Row::Bounce, closest(&work.shadow)),
        (Row::SingleClosest, closest(&work.single)),
    ];
    let contender = |(row, run)| {
        let (mode, cost) = ("cwbvh".to_owned(), tree.cost);
        Contender { row, system: "obvhs", mode, isa: "sse2", lanes: 1, cost, run }
    };
    runs.into_iter().map(contender).collect()
}

fn theirs(ray: &Ray, t_max: f32) -> TheirRay {
    TheirRay::new(Vec3A::from(ray.origin), Vec3A::from(ray.direction), ray.t_min, t_max)
}

fn closest<'a>(tree: &'a Tree, rays: &'a [Ray], threads: usize) -> Run<'a> {
    Box::new(move || {
        in_parts(rays, threads, |found: &mut Vec<Option<f32>>, part| {
            found.clear();
            let ask = || found.extend(part.iter().map(|ray| tree.closest(theirs(ray, ray.t_max))));
            let ((), seconds) = seconds_on(threads, ask);
            let distances = || found.iter().flatten().map(|t| f64::from(*t));
            Outcome { seconds, hits: distances().count(), distance: distances().sum() }
        })
    })
}

fn any<'a>(tree: &'a Tree, rays: &'a [Ray], t_max: f32, threads: usize) -> Run<'a> {
    Box::new(move || {
        in_parts(rays, threads, |(): &mut (), part| {
            let ask = || part.iter().filter(|ray| tree.any(theirs(ray, t_max))).count();
            let (hits, seconds) = seconds_on(threads, ask);
            Outcome { seconds, hits, distance: 0.0 }
        })
    })
}
