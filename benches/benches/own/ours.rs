//! The library itself: kernels as users write them, on the widest packets.

use raydsl::geometry::HitRecord;
use raydsl::prelude::*;
use raydsl_benches::clock::seconds_on;
use raydsl_benches::contest::{Cost, Outcome};

use crate::contender::{Contender, Query, Run};
use crate::rays::{GROUP, SAMPLES, Workload};
use crate::shapes::Shape;

/// A tree, and how it was built.
pub(crate) struct Tree<'a, P: Shape> {
    pub(crate) bvh: Bvh<'a, P>,
    name: String,
    cost: Cost,
}

/// How a tree is built.
#[derive(Clone, Copy)]
struct Setting {
    /// Behind the variant in the names of modes.
    name: &'static str,
    quality: BuildQuality,
    is_wide: bool,
    /// The default, or one primitive as in Embree's trees over user geometry: for primitives that take
    /// longer than a box. Wide trees have eight.
    max_leaf_size: u32,
}

impl Setting {
    const fn new(name: &'static str, quality: BuildQuality, is_wide: bool, leaf: u32) -> Self {
        Self { name, quality, is_wide, max_leaf_size: leaf }
    }
}

/// All trees.
const SETTINGS: [Setting; 5] = [
    Setting::new("", BuildQuality::Balanced, false, 4),
    Setting::new(" best", BuildQuality::Best, false, 4),
    Setting::new(" best leaf 1", BuildQuality::Best, false, 1),
    Setting::new(" wide", BuildQuality::Balanced, true, 4),
    Setting::new(" best wide", BuildQuality::Best, true, 4),
];

/// Builds each tree.
pub(crate) fn trees<'a, P: Shape>(
    prims: &'a [P],
    threads: usize,
    traversals: &[Traversal],
) -> Vec<Tree<'a, P>> {
    let tree = |Setting { name, quality, is_wide, max_leaf_size }: Setting,
                traversal: Traversal| {
        let config = BuildConfig { quality, max_leaf_size, traversal, ..BuildConfig::default() };
        let build = || match is_wide {
            true => Bvh::build_wide(prims, &[], &config),
            false => Bvh::build_with(prims, &config),
        };
        let (bvh, seconds) = seconds_on(threads, build);
        let bvh = bvh.expect("the scene has finite bounds");
        let cost = Cost::new(seconds, bvh.bytes(), prims.len());
        let name = match traversal {
            Traversal::Auto => name.to_owned(),
            _ => format!("{name} {}", traversal.name()),
        };
        Tree { bvh, name, cost }
    };
    // Binary trees have one traversal.
    let of = |setting: &Setting| if setting.is_wide { traversals } else { &[Traversal::Auto] };
    let all = SETTINGS.iter().flat_map(|setting| of(setting).iter().map(move |&t| (*setting, t)));
    all.map(|(setting, traversal)| tree(setting, traversal)).collect()
}

/// Every mode of both queries. Shadow rays are asked in two ways: one a lane, and eight a lane at once.
pub(crate) fn contenders<'a, P: Shape>(
    trees: &'a [Tree<'a, P>],
    work: &'a Workload<P::Hit>,
    threads: usize,
) -> Vec<Contender<'a>> {
    let variant = Variant::widest();
    let (isa, lanes) = variant.isa();
    let contender = |tree: &Tree<'a, P>, query, ending: &str, run| {
        let mode = format!("{}{}{ending}", variant.name(), tree.name);
        Contender { query, system: "raydsl", mode, isa, lanes, cost: tree.cost, run }
    };
    let of_tree = |tree: &'a Tree<'a, P>| {
        let ask = Ask { bvh: &tree.bvh, work, threads };
        [
            contender(tree, Query::Primary, "", ask.closest()),
            contender(tree, Query::Shadow, "", ask.any()),
            contender(tree, Query::Shadow, " x8", ask.any_of_eight()),
        ]
    };
    trees.iter().flat_map(of_tree).collect()
}

/// Who asks a tree, and about what.
#[derive(Clone, Copy)]
struct Ask<'a, P: Shape> {
    bvh: &'a Bvh<'a, P>,
    work: &'a Workload<P::Hit>,
    threads: usize,
}

impl<'a, P: Shape> Ask<'a, P> {
    fn batch<A: Type, R: Type>(self, kernel: &Kernel<'_, A, R>, all: &[A], found: &mut [R]) -> f64 {
        let scheduler = TiledScheduler::new().variant(Variant::widest());
        seconds_on(self.threads, || scheduler.batch(kernel, all, found)).1
    }

    /// The closest hits of the camera's rays.
    fn closest(self) -> Run<'a> {
        let rays: Vec<(Ray,)> = self.work.primary.iter().map(|ray| (*ray,)).collect();
        let missed = |record: &P::Hit| record.with_hit(Hit::miss());
        let mut found: Vec<P::Hit> = self.work.hits.iter().map(missed).collect();
        Box::new(move || {
            let bvh = self.bvh;
            let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
            let seconds = self.batch(&kernel, &rays, &mut found);
            let hits = found.iter().map(|record| record.hit()).filter(|hit| hit.is_hit);
            let distance = hits.clone().map(|hit| f64::from(hit.t)).sum();
            Outcome { seconds, hits: hits.count(), distance }
        })
    }

    /// Whether shadow rays hit something, one a lane.
    fn any(self) -> Run<'a> {
        let rays: Vec<(Ray,)> = self.work.shadow.iter().map(|ray| (*ray,)).collect();
        let mut found = vec![false; rays.len()];
        Box::new(move || {
            let bvh = self.bvh;
            let kernel = kernel!(|ray: Ray| bvh.any_hit(ray));
            let seconds = self.batch(&kernel, &rays, &mut found);
            let hits = found.iter().filter(|is_hit| **is_hit).count();
            Outcome { seconds, hits, distance: 0.0 }
        })
    }

    /// How many shadow rays of each place hit something.
    fn any_of_eight(self) -> Run<'a> {
        let places: Vec<(u32,)> =
            (0..self.work.shadow.len() as u32 / SAMPLES).map(|place| (place,)).collect();
        let mut found = vec![0u32; places.len()];
        Box::new(move || {
            let (bvh, rays) = (self.bvh, &self.work.shadow[..]);
            let kernel = kernel!(|place: u32| {
                let first = place / GROUP * (GROUP * SAMPLES) + place % GROUP;
                let hits = bvh.any_hit_each::<8>(|i: u32| rays[(first + i * GROUP) as usize]);
                let mut count = 0u32;
                for hit in hits {
                    count += hit as u32;
                }
                count
            });
            let seconds = self.batch(&kernel, &places, &mut found);
            let hits = found.iter().map(|n| *n as usize).sum();
            Outcome { seconds, hits, distance: 0.0 }
        })
    }
}
