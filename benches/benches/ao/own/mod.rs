//! The library itself: kernels as users write them, in every variant.

mod kernels;

use raydsl::prelude::*;
use raydsl_benches::clock::seconds_on;
use raydsl_benches::contest::{Cost, Outcome, in_parts};

use crate::contender::{Contender, Run};
use crate::rays::Workload;
use crate::row::Row;
use kernels::{Ask, Engine};

/// A tree, and how it was built.
pub(crate) struct Tree<'a> {
    pub(crate) bvh: Bvh<'a, Triangle>,
    pub(crate) cost: Cost,
    setting: &'static Setting,
    traversal: Traversal,
    /// Whether single-ray queries are measured with it: once a setting, since `traversal` has no
    /// effect on them.
    has_single_rays: bool,
}

/// A setting of trees, and who asks them.
struct Setting {
    /// Behind the variant in the names of modes.
    name: &'static str,
    quality: BuildQuality,
    is_wide: bool,
    is_asked_by: fn(Variant) -> bool,
}

/// All modes: these trees, each asked by some variants.
static SETTINGS: [Setting; 3] = [
    Setting {
        name: "",
        quality: BuildQuality::Balanced,
        is_wide: false,
        is_asked_by: |v| !v.is_native() || v.isa().1 <= 16,
    },
    Setting {
        name: " wide",
        quality: BuildQuality::Balanced,
        is_wide: true,
        is_asked_by: |v| v == Variant::Wgsl || v.is_native() && v.isa().1 >= 8,
    },
    Setting {
        name: " best",
        quality: BuildQuality::Best,
        is_wide: true,
        is_asked_by: |v| v == Variant::widest() || v == Variant::Wgsl,
    },
];

impl Tree<'_> {
    /// What the tree is called where builds are compared.
    pub(crate) fn name(&self) -> String {
        let setting = match self.setting.name.trim_start() {
            "" => "balanced",
            name => name,
        };
        format!("{setting}{}", ending(self.traversal))
    }
}

/// What names of modes say of a traversal.
fn ending(traversal: Traversal) -> String {
    match traversal {
        Traversal::Auto => String::new(),
        other => format!(" {}", other.name()),
    }
}

impl Setting {
    fn variants(&self) -> impl Iterator<Item = Variant> {
        Variant::ALL.into_iter().filter(|v| (self.is_asked_by)(*v))
    }
}

/// Builds one tree for each setting, and for each traversal of trees with copies.
pub(crate) fn trees<'a>(
    triangles: &'a [Triangle],
    threads: usize,
    traversals: &[Traversal],
) -> Vec<Tree<'a>> {
    let tree = |setting: &'static Setting, traversal, has_single_rays| {
        let Setting { quality, is_wide, .. } = *setting;
        let config = BuildConfig { quality, traversal, ..BuildConfig::default() };
        let build = || match is_wide {
            true => Bvh::build_wide(triangles, &[], &config),
            false => Bvh::build_with(triangles, &config),
        };
        let (bvh, seconds) = seconds_on(threads, build);
        let bvh = bvh.expect("the scene has finite bounds");
        let cost = Cost::new(seconds, bvh.bytes(), triangles.len());
        Tree { bvh, cost, setting, traversal, has_single_rays }
    };
    let of_setting = |setting: &'static Setting| {
        let traversals = if setting.is_wide { traversals } else { &[Traversal::Auto] };
        traversals.iter().enumerate().map(move |(i, traversal)| tree(setting, *traversal, i == 0))
    };
    SETTINGS.iter().flat_map(of_setting).collect()
}

/// Every mode of every row; WGSL where there is a device.
pub(crate) fn contenders<'a>(
    trees: &'a [Tree<'a>],
    work: &'a Workload,
    threads: usize,
    device: Option<&'a GpuScheduler>,
) -> Vec<Contender<'a>> {
    let engine = |variant: Variant| match variant.is_native() {
        true => Some(Engine::Cpu(TiledScheduler::new().variant(variant), threads)),
        false => device.map(Engine::Device),
    };
    let ask = |tree: &'a Tree<'a>, engine| Ask { bvh: &tree.bvh, work, engine };
    let widest = Variant::widest();
    let on_widest = Engine::Cpu(TiledScheduler::new().variant(widest), threads);
    let charges = charges(ask(&trees[0], on_widest)).into_iter();
    let mut all: Vec<_> =
        charges.map(|(row, run)| contender(row, widest, &trees[0], run)).collect();
    for tree in trees {
        for variant in tree.setting.variants() {
            let Some(engine) = engine(variant) else { continue };
            let runs = runs(ask(tree, engine)).into_iter();
            all.extend(runs.map(|(row, run)| contender(row, variant, tree, run)));
        }
        if tree.has_single_rays {
            let run = one_by_one(&tree.bvh, work, threads);
            let single = contender(Row::SingleClosest, Variant::Scalar, tree, run);
            // A single ray tests the eight children of a node with the widest level of the machine.
            let (isa, lanes) = match tree.setting.is_wide {
                true => (widest.isa().0, 8),
                false => (single.isa, single.lanes),
            };
            all.push(Contender { isa, lanes, ..single });
        }
    }
    all
}

fn contender<'a>(row: Row, variant: Variant, tree: &Tree<'_>, run: Run<'a>) -> Contender<'a> {
    let (isa, lanes) = if variant.is_native() { variant.isa() } else { ("device", 0) };
    let mode = format!("{}{}{}", variant.name(), tree.setting.name, ending(tree.traversal));
    Contender { row, system: "raydsl", mode, isa, lanes, cost: tree.cost, run }
}

/// What others are charged with.
fn charges(ask: Ask<'_>) -> [(Row, Run<'_>); 3] {
    let none = |_: &[f32]| (0, 0.0);
    [
        (Row::PrimaryGeneration, picture(ask, 0.0, Ask::make_primary, none)),
        (Row::Generation, batch(ask, Ask::make_shadow, none)),
        (Row::FrameGeneration, frame_generation(ask)),
    ]
}

/// The rows that kernels run.
fn runs(ask: Ask<'_>) -> [(Row, Run<'_>); 6] {
    [
        (Row::Frame, picture(ask, 0, Ask::picture, of_counts)),
        (Row::Primary, picture(ask, Hit::miss(), Ask::primary, of_hits)),
        (Row::AoShort, batch(ask, Ask::short, of_counts)),
        (Row::AoUnbounded, batch(ask, Ask::unbounded, of_counts)),
        (Row::AoShortUnbatched, batch(ask, Ask::unbatched, of_counts)),
        (Row::Bounce, batch(ask, Ask::bounce, of_bounces)),
    ]
}

/// A frame: `run` makes it, and `count` says how many hits it shows, and the sum of their
/// distances.
fn picture<'a, R: Type + 'a>(
    ask: Ask<'a>,
    blank: R,
    run: fn(Ask<'a>, &mut Image<R>) -> f64,
    count: fn(&[R]) -> (usize, f64),
) -> Run<'a> {
    let mut image = Image::filled(ask.work.size, ask.work.size, blank);
    Box::new(move || {
        let seconds = run(ask, &mut image);
        let (hits, distance) = count(image.pixels());
        Outcome { seconds, hits, distance }
    })
}

/// The same for all places from which shadow rays leave.
fn batch<'a, R: Clone + Default + Send + 'a>(
    ask: Ask<'a>,
    run: fn(Ask<'a>, &mut [R]) -> f64,
    count: fn(&[R]) -> (usize, f64),
) -> Run<'a> {
    let mut found = vec![R::default(); ask.work.places.len()];
    Box::new(move || {
        let seconds = run(ask, &mut found);
        let (hits, distance) = count(&found);
        Outcome { seconds, hits, distance }
    })
}

fn frame_generation(ask: Ask<'_>) -> Run<'_> {
    let mut found = vec![0.0; ask.work.hits.len()];
    Box::new(move || Outcome { seconds: ask.make_frame(&mut found), ..Outcome::default() })
}

/// Traces single rays on the host.
fn one_by_one<'a>(bvh: &'a Bvh<'a, Triangle>, work: &'a Workload, threads: usize) -> Run<'a> {
    Box::new(move || {
        in_parts(&work.single, threads, |hits: &mut Vec<Hit>, rays| {
            hits.clear();
            let ask = || hits.extend(rays.iter().map(|ray| bvh.closest_hit(*ray)));
            let ((), seconds) = seconds_on(threads, ask);
            let (hits, distance) = of_hits(hits);
            Outcome { seconds, hits, distance }
        })
    })
}

/// How many hits there are, and the sum of their distances.
fn of_hits(hits: &[Hit]) -> (usize, f64) {
    let hits = hits.iter().filter(|hit| hit.is_hit);
    (hits.clone().count(), hits.map(|hit| f64::from(hit.t)).sum())
}

fn of_counts(counts: &[u32]) -> (usize, f64) {
    (counts.iter().map(|n| *n as usize).sum(), 0.0)
}

fn of_bounces(found: &[(u32, f32)]) -> (usize, f64) {
    (found.iter().map(|f| f.0 as usize).sum(), found.iter().map(|f| f64::from(f.1)).sum())
}
