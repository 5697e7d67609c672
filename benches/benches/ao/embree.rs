//! Embree, if it is there: single rays, and packets of 8 and 16 with both of its flags.

use raydsl::prelude::*;
use raydsl_benches::contest::Cost;
use raydsl_benches::embree::{self, Embree, Mode, Quality, Question, Robustness, Scene, Shape};

use crate::contender::Contender;
use crate::rays::Workload;
use crate::row::Row;

/// The system's name without its robust flag, and with it.
pub(crate) const EMBREE: &str = "embree";
pub(crate) const ROBUST: &str = "embree-robust";

/// A device and what it reads.
pub(crate) struct Device {
    embree: Embree,
    shape: Shape,
    primitives: usize,
}

/// A scene of some quality, with or without the robust flag.
pub(crate) struct Tree<'a> {
    scene: Scene<'a>,
    quality: Quality,
    pub(crate) system: &'static str,
    pub(crate) cost: Cost,
}

impl Tree<'_> {
    pub(crate) fn name(&self) -> &'static str {
        self.quality.name()
    }
}

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

    /// Scenes of the two better qualities; with the robust flag, too, if `with_robust`.
    pub(crate) fn trees(&self, with_robust: bool) -> Vec<Tree<'_>> {
        let tree = |quality, system, robustness| {
            let scene = self.embree.build(&self.shape, quality, robustness);
            let cost = Cost::new(scene.seconds, scene.bytes, self.primitives);
            Tree { scene, quality, system, cost }
        };
        let all = [(EMBREE, Robustness::Off), (ROBUST, Robustness::On)];
        let systems = all.into_iter().take(if with_robust { 2 } else { 1 });
        let of_system = |(system, robustness)| {
            [Quality::Medium, Quality::High].map(|quality| tree(quality, system, robustness))
        };
        systems.flat_map(of_system).collect()
    }
}

/// Every mode of every row, and of rays that are sorted: that they are is not charged, so those
/// figures are limits.
pub(crate) fn contenders<'a>(
    trees: &'a [Tree<'a>],
    work: &'a Workload,
    threads: usize,
) -> Vec<Contender<'a>> {
    let mut all = Vec::new();
    for (tree, mode) in trees.iter().flat_map(|tree| Mode::ALL.map(|mode| (tree, mode))) {
        let rows = rows(work, threads).into_iter();
        let asked = rows.filter(|(row, _)| mode == Mode::SINGLE || *row != Row::SingleClosest);
        all.extend(asked.map(|(row, question)| contender(tree.system, row, tree, mode, question)));
    }
    let unflagged = trees.iter().filter(|tree| tree.system == EMBREE);
    for (tree, mode) in unflagged.flat_map(|tree| Mode::ALL.map(|mode| (tree, mode))) {
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
    mode: Mode,
    question: Question<'a>,
) -> Contender<'a> {
    let run = Box::new(move || question.ask(&tree.scene, mode));
    let (lanes, mode) = (mode.lanes, format!("{} {}", mode.name(), tree.quality.name()));
    Contender { row, system, mode, isa: "embree", lanes, cost: tree.cost, run }
}
