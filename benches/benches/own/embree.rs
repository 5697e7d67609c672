//! Embree's user geometry, if it is there: one ray at a time, and packets of each width that both
//! systems have, with both of Embree's hints and in both of its better qualities.

use raydsl::prelude::*;
use raydsl_benches::contest::Cost;
use raydsl_benches::embree::{self, Embree, Mode, Quality, Question, Robustness, Scene, User};

use crate::contender::{Contender, Query};
use crate::rays::Workload;
use crate::shapes::Shape;

/// A device, and the primitives for each width of packets.
pub(crate) struct Device<'a> {
    embree: Embree,
    users: Vec<User<'a>>,
    primitives: usize,
}

/// A scene, and what asks it.
pub(crate) struct Tree<'a> {
    scene: Scene<'a>,
    quality: Quality,
    user: &'a User<'a>,
    /// Whether single rays are measured with it: once a quality.
    has_single_rays: bool,
    cost: Cost,
}

impl<'a> Device<'a> {
    /// Embree, if it can be loaded; else says why not.
    pub(crate) fn load<P: Shape>(prims: &'a [P], threads: usize) -> Option<Self> {
        match Embree::load(&embree::path()?, threads) {
            Ok(embree) => {
                // The widest first, which single rays are asked with, too.
                let variants = [Variant::Packet16, Variant::Packet8, Variant::Packet4];
                let native = variants.into_iter().filter(|variant| variant.is_native());
                let users = native.filter_map(|variant| User::new(prims, variant));
                let is_asked = |(i, user): &(usize, User<'_>)| *i == 0 || user.lanes >= 8;
                let users = users.enumerate().filter(is_asked).map(|(_, user)| user);
                Some(Self { embree, users: users.collect(), primitives: prims.len() })
            }
            Err(error) => {
                eprintln!("skipped Embree: {error}");
                None
            }
        }
    }

    /// Scenes of the two better qualities for each width.
    pub(crate) fn trees(&self) -> Vec<Tree<'_>> {
        let qualities = [Quality::Medium, Quality::High];
        let of_user = |(i, user)| {
            qualities.map(|quality| {
                let scene = self.embree.build_user(user, quality, Robustness::Off);
                let cost = Cost::new(scene.seconds, scene.bytes, self.primitives);
                Tree { scene, quality, user, has_single_rays: i == 0, cost }
            })
        };
        self.users.iter().enumerate().flat_map(of_user).collect()
    }
}

/// Every mode of both queries.
pub(crate) fn contenders<'a, R>(
    trees: &'a [Tree<'a>],
    work: &'a Workload<R>,
    threads: usize,
) -> Vec<Contender<'a>> {
    let question = |rays, is_closest, t_max| Question { rays, is_closest, t_max, threads };
    let questions = [
        (Query::Primary, question(&work.primary, true, f32::MAX)),
        (Query::Shadow, question(&work.shadow, false, work.short)),
    ];
    let of_tree = |tree: &'a Tree<'a>| {
        let is_asked = |mode: &Mode| match mode.lanes {
            1 => tree.has_single_rays,
            lanes => lanes == tree.user.lanes,
        };
        let modes = Mode::ALL.into_iter().filter(is_asked);
        modes.flat_map(move |mode| questions.map(|(query, q)| contender(tree, query, mode, q)))
    };
    trees.iter().flat_map(of_tree).collect()
}

fn contender<'a>(
    tree: &'a Tree<'a>,
    query: Query,
    mode: Mode,
    question: Question<'a>,
) -> Contender<'a> {
    let run = Box::new(move || question.ask(&tree.scene, mode));
    let (lanes, mode) = (mode.lanes, format!("{} {}", mode.name(), tree.quality.name()));
    Contender { query, system: "embree", mode, isa: tree.user.isa, lanes, cost: tree.cost, run }
}
