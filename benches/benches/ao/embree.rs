//! Embree, if it is there: single rays, and packets of 8 and 16 with both of its flags.

use raydsl::prelude::*;
use raydsl_benches::clock::seconds_on;
use raydsl_benches::embree::{
    self, Coherence, Embree, Lanes, Quality, RayHits, Rays, Scene, Shape, Width,
};

use crate::contender::{Contender, Cost, Outcome, Run, in_parts};
use crate::rays::Workload;
use crate::row::Row;

/// A device and what it reads.
pub(crate) struct Device {
    embree: Embree,
    shape: Shape,
    primitives: usize,
}

/// A scene of some quality.
pub(crate) struct Tree<'a> {
    scene: Scene<'a>,
    quality: Quality,
    cost: Cost,
}

/// A number of lanes, and the flag. Of single rays Embree does not ask for it.
type Mode = (usize, Coherence);

const SINGLE: Mode = (1, Coherence::Incoherent);
const MODES: [Mode; 5] = [
    SINGLE,
    (8, Coherence::Incoherent),
    (8, Coherence::Coherent),
    (16, Coherence::Incoherent),
    (16, Coherence::Coherent),
];

impl Device {
    /// Embree, if it can be loaded; else says why not.
    pub(crate) fn load(triangles: &[Triangle], threads: usize) -> Option<Self> {
        match Embree::load(&embree::path()?, threads) {
            Ok(embree) => {
                let shape = Shape::triangles(triangles);
                Some(Self { embree, shape, primitives: triangles.len() })
            }
            Err(error) => {
                eprintln!("skipped Embree: {error}");
                None
            }
        }
    }

    /// Scenes of the two better qualities.
    pub(crate) fn trees(&self) -> Vec<Tree<'_>> {
        let tree = |quality| {
            let scene = self.embree.build(&self.shape, quality);
            let cost = Cost::new(scene.seconds, scene.bytes, self.primitives);
            Tree { scene, quality, cost }
        };
        [Quality::Medium, Quality::High].into_iter().map(tree).collect()
    }
}

/// What some rays are asked.
#[derive(Clone, Copy)]
struct Question<'a> {
    rays: &'a [Ray],
    /// Whether they want to know what is closest, or if there is anything.
    is_closest: bool,
    /// Where they end.
    t_max: f32,
    threads: usize,
}

/// Every mode of every row. With rays that are sorted only the better tree is asked: that they are
/// is not charged, so these figures are limits.
pub(crate) fn contenders<'a>(
    trees: &'a [Tree<'a>],
    work: &'a Workload,
    threads: usize,
) -> Vec<Contender<'a>> {
    let mut all = Vec::new();
    for (tree, mode) in trees.iter().flat_map(|tree| MODES.map(|mode| (tree, mode))) {
        let rows = rows(work, threads).into_iter();
        let asked = rows.filter(|(row, _)| mode == SINGLE || *row != Row::SingleClosest);
        all.extend(asked.map(|(row, question)| contender("embree", row, tree, mode, question)));
    }
    let best = trees.iter().filter(|tree| tree.quality == Quality::High);
    for (tree, mode) in best.flat_map(|tree| MODES.map(|mode| (tree, mode))) {
        let rows = sorted_rows(work, threads).into_iter();
        all.extend(rows.map(|(row, q)| contender("embree-sorted", row, tree, mode, q)));
    }
    all
}

fn rows(work: &Workload, threads: usize) -> [(Row, Question<'_>); 5] {
    let question = |rays, is_closest, t_max| Question { rays, is_closest, t_max, threads };
    [
        (Row::Primary, question(&work.primary, true, f32::MAX)),
        (Row::AoShort, question(&work.shadow, false, work.short)),
        (Row::AoUnbounded, question(&work.shadow, false, f32::MAX)),
        (Row::Bounce, question(&work.shadow, true, f32::MAX)),
        (Row::SingleClosest, question(&work.single, true, f32::MAX)),
    ]
}

fn sorted_rows(work: &Workload, threads: usize) -> Vec<(Row, Question<'_>)> {
    let sorted = |(row, question)| (row, Question { rays: &work.sorted, ..question });
    let of_shadows = |row: &Row| matches!(row, Row::AoShort | Row::AoUnbounded | Row::Bounce);
    rows(work, threads).into_iter().filter(|(row, _)| of_shadows(row)).map(sorted).collect()
}

fn contender<'a>(
    system: &'static str,
    row: Row,
    tree: &'a Tree<'a>,
    (lanes, coherence): Mode,
    question: Question<'a>,
) -> Contender<'a> {
    let flag = match (lanes, coherence) {
        (1, _) => "",
        (_, Coherence::Incoherent) => " incoherent",
        (_, Coherence::Coherent) => " coherent",
    };
    let mode = format!("{lanes}{flag} {}", tree.quality.name());
    let run: Run<'a> = match lanes {
        1 => question.run::<1>(&tree.scene, coherence),
        8 => question.run::<8>(&tree.scene, coherence),
        _ => question.run::<16>(&tree.scene, coherence),
    };
    Contender { row, system, mode, isa: "embree", lanes, cost: tree.cost, run }
}

impl<'a> Question<'a> {
    fn run<const N: usize>(self, scene: &'a Scene<'a>, coherence: Coherence) -> Run<'a>
    where
        Lanes<N>: Width,
        RayHits<N>: Send,
        Rays<N>: Send,
    {
        match self.is_closest {
            true => Box::new(move || self.closest::<N>(scene, coherence)),
            false => Box::new(move || self.any::<N>(scene, coherence)),
        }
    }

    fn closest<const N: usize>(self, scene: &Scene<'_>, coherence: Coherence) -> Outcome
    where
        Lanes<N>: Width,
        RayHits<N>: Send,
    {
        in_parts(self.rays, self.threads, |packets: &mut Vec<RayHits<N>>, part| {
            packets.clear();
            packets.extend(part.chunks(N).map(|rays| RayHits::of(self.ending(rays))));
            let ask = || scene.intersect(packets, coherence);
            let ((), seconds) = seconds_on(self.threads, ask);
            let distances = || packets.iter().flat_map(RayHits::distances).map(f64::from);
            Outcome { seconds, hits: distances().count(), distance: distances().sum() }
        })
    }

    fn any<const N: usize>(self, scene: &Scene<'_>, coherence: Coherence) -> Outcome
    where
        Lanes<N>: Width,
        Rays<N>: Send,
    {
        in_parts(self.rays, self.threads, |packets: &mut Vec<Rays<N>>, part| {
            packets.clear();
            packets.extend(part.chunks(N).map(|rays| Rays::of(self.ending(rays))));
            let ask = || scene.occluded(packets, coherence);
            let ((), seconds) = seconds_on(self.threads, ask);
            let hits = packets.iter().map(Rays::occluded).sum();
            Outcome { seconds, hits, distance: 0.0 }
        })
    }

    fn ending(self, rays: &[Ray]) -> impl Iterator<Item = Ray> {
        rays.iter().map(move |ray| ray.with_range(0.0, self.t_max))
    }
}
