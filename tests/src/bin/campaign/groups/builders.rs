//! Trees over boxes that break builders: time, depth, cost, and the same tree for any threads.

use std::error::Error;

use raydsl::bvh::{BuildError, MAX_DEPTH};
use raydsl::prelude::*;
use raydsl_tests::hard_rays::boxes::Mark;
use raydsl_tests::rng::Rng;

use crate::measure::Run;
use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Group, Row, Unit};
use crate::timing::ratio;

pub(crate) const GROUP: Group = Group {
    name: "builders",
    title: "Building trees: three qualities, binary and wide",
    clauses: &[
        "No boxes take more than 3 times as long as as many small ones all over a cube.",
        "No tree is deeper than the stack of a traversal, and its expected cost is finite.",
        "One, two and seven threads build the same tree.",
        "Boxes that are NaN, infinite or inverted are refused by a typed error that names the \
         first; none, one and two are a tree.",
    ],
    rows,
};

/// Boxes of the largest tree.
const MOST: u64 = 1_000_000;

/// A way to make boxes from small ones all over a unit cube.
struct Kind {
    name: &'static str,
    change: fn(usize, Aabb) -> Aabb,
}

const KINDS: [Kind; 10] = [
    Kind { name: "identical", change: |_, _| Aabb::new(Vec3::ZERO, Vec3::splat(0.01)) },
    Kind { name: "identical centroids", change: |_, b| Aabb::new(-b.max, b.max) },
    Kind { name: "on a line", change: |_, b| Aabb::new(b.min.x * Vec3::X, b.min.x * Vec3::X) },
    Kind { name: "on a slanted line", change: |_, b| at(Vec3::splat(b.min.x)) },
    Kind { name: "on a plane", change: |_, b| Aabb::new(b.min.with_z(0.25), b.max.with_z(0.25)) },
    Kind {
        name: "one giant, many tiny",
        change: |i, b| {
            if i == 77 { Aabb::new(Vec3::splat(-1e30), Vec3::splat(1e30)) } else { b }
        },
    },
    Kind { name: "extent 1e-20", change: |_, b| scaled(b, 1e-20) },
    Kind { name: "extent 1e30", change: |_, b| scaled(b, 1e30) },
    Kind { name: "denormal spacing", change: |_, b| scaled(b, 1e-40) },
    Kind { name: "powers of two", change: |_, b| at((b.min * 200.0 - 100.0).exp2()) },
];

fn at(point: Vec3) -> Aabb {
    Aabb::new(point, point)
}

fn scaled(b: Aabb, by: f32) -> Aabb {
    Aabb::new(b.min * by, b.max * by)
}

fn mark(b: Aabb) -> Mark {
    Mark { min: b.min, key: 0, max: b.max, padding: 0 }
}

/// Small boxes all over a unit cube, changed.
fn boxes(count: usize, change: impl Fn(usize, Aabb) -> Aabb) -> Vec<Mark> {
    let mut rng = Rng::new(3);
    let mut one = |i: usize| {
        let min = (rng.point(1.0) + 1.0) * 0.5;
        mark(change(i, Aabb::new(min, min + Vec3::splat(0.002 + 0.004 * rng.unit()))))
    };
    (0..count).map(&mut one).collect()
}

/// A quality and a storage.
#[derive(Clone, Copy)]
struct Builder {
    name: &'static str,
    quality: BuildQuality,
    is_wide: bool,
}

const BUILDERS: [Builder; 6] = [
    Builder { name: "fast", quality: BuildQuality::Fast, is_wide: false },
    Builder { name: "balanced", quality: BuildQuality::Balanced, is_wide: false },
    Builder { name: "best", quality: BuildQuality::Best, is_wide: false },
    Builder { name: "fast, wide", quality: BuildQuality::Fast, is_wide: true },
    Builder { name: "balanced, wide", quality: BuildQuality::Balanced, is_wide: true },
    Builder { name: "best, wide", quality: BuildQuality::Best, is_wide: true },
];

impl Builder {
    fn build<'a>(&self, boxes: &'a [Mark]) -> Result<Bvh<'a, Mark>, BuildError> {
        let config =
            BuildConfig { quality: self.quality, min_wide_size: 0, ..BuildConfig::default() };
        if self.is_wide {
            Bvh::build_wide(boxes, &[], &config)
        } else {
            Bvh::build_with(boxes, &config)
        }
    }
}

fn rows() -> Vec<Row> {
    let mut all: Vec<Row> = KINDS.iter().map(time).collect();
    all.extend([
        Row::new("depth and cost of all of these", 2, Unit::Faults, Bound::NONE, sound).share(0.1),
        Row::new("threads, all of these", 3, Unit::Faults, Bound::NONE, threads).share(0.1),
        Row::new("NaN, infinite, inverted", 4, Unit::Faults, Bound::NONE, refused),
        Row::new("none, one and two", 4, Unit::Faults, Bound::NONE, few),
    ]);
    all
}

fn count(run: &Run) -> usize {
    run.count.clamp(100, MOST) as usize
}

fn time(kind: &'static Kind) -> Row {
    let name = format!("time, {}", kind.name);
    let row = Row::new(name, 1, Unit::Times, Bound::all(3.0), |run| {
        // Few boxes are built so fast that a round says little.
        let rounds = if run.count > 100_000 { 5 } else { 7 };
        let (hard, easy) = (boxes(count(run), kind.change), boxes(count(run), |_, b| b));
        let time = |builder: &Builder| {
            builder.build(&hard)?;
            // Building was just seen to succeed, and is a function of the boxes.
            let build = |boxes: &[Mark]| drop(std::hint::black_box(builder.build(boxes)));
            let ratio = ratio(rounds, || build(&hard), || build(&easy));
            Ok(Found::whole(builder.name, hard.len(), ratio))
        };
        let found: Result<Vec<Found>, BuildError> = BUILDERS.iter().map(time).collect();
        Ok(Outcome::of_figures(found?))
    });
    row.share(0.2)
}

type Measured = Result<Outcome, Box<dyn Error>>;

/// Judges the trees of every builder over every kind of boxes.
fn every_tree(
    run: &Run,
    fault: impl Fn(&Builder, &[Mark]) -> Result<Option<String>, BuildError>,
) -> Measured {
    let mut all = Found::new("host");
    for kind in &KINDS {
        let boxes = boxes(count(run), kind.change);
        for builder in &BUILDERS {
            let fault = fault(builder, &boxes)?;
            all.add(run.unit, f64::from(u8::from(fault.is_some())), || {
                format!("{}, {}: {}", kind.name, builder.name, fault.unwrap_or_default())
            });
        }
    }
    Ok(Outcome::host(all))
}

fn sound(run: &Run) -> Measured {
    every_tree(run, |builder, boxes| {
        let found = builder.build(boxes)?.statistics();
        let is_sound = found.depth <= MAX_DEPTH && found.sah_cost.is_finite();
        Ok((!is_sound).then(|| format!("{found:?}")))
    })
}

fn threads(run: &Run) -> Measured {
    let pools: Result<Vec<_>, _> = [1, 2, 7]
        .map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build())
        .into_iter()
        .collect();
    let pools = pools?;
    every_tree(run, |builder, boxes| {
        let trees: Result<Vec<_>, BuildError> =
            pools.iter().map(|pool| pool.install(|| builder.build(boxes))).collect();
        let trees = trees?;
        let differs = |tree: &Bvh<'_, Mark>| {
            tree.nodes() != trees[0].nodes() || tree.indices() != trees[0].indices()
        };
        let others = trees.iter().filter(|tree| differs(tree)).count();
        Ok((others > 0).then(|| format!("{others} trees differ")))
    })
}

/// What the first bad box of some is, by the error that the builder must give.
fn refused(run: &Run) -> Measured {
    let mut all = Found::new("host");
    let mut rng = Rng::new(run.seed);
    for _ in 0..run.count.clamp(1, 10_000) {
        let mut boxes = boxes(1 + rng.below(40), |_, b| b);
        let (first, second) = (rng.below(boxes.len()), rng.below(boxes.len()));
        let kind = rng.below(3);
        for index in [first, second] {
            let (axis, is_lower) = (rng.below(3), rng.below(2) == 0);
            let one = &mut boxes[index];
            match (kind, is_lower) {
                (0, true) => one.min[axis] = f32::NAN,
                (0, false) => one.max[axis] = f32::NAN,
                // The other way round the box is inverted as well.
                (1, true) => one.min[axis] = f32::NEG_INFINITY,
                (1, false) => one.max[axis] = f32::INFINITY,
                (_, true) => one.min[axis] = 2.0,
                (_, false) => one.max[axis] = -2.0,
            }
        }
        let index = first.min(second);
        for builder in &BUILDERS {
            let error = builder.build(&boxes).err();
            let is_right = match (kind, &error) {
                (0, Some(BuildError::NanBounds { index: found }))
                | (1, Some(BuildError::InfiniteBounds { index: found }))
                | (2, Some(BuildError::InvertedBounds { index: found })) => *found == index,
                _ => false,
            };
            all.add(run.unit, f64::from(u8::from(!is_right)), || {
                format!("{}: {error:?} for box {index}", builder.name)
            });
        }
    }
    Ok(Outcome::host(all))
}

/// Every box of the smallest trees is found.
fn few(run: &Run) -> Measured {
    let mut all = Found::new("host");
    for count in 0..=2 {
        for kind in &KINDS {
            let mut boxes = boxes(count, kind.change);
            (0..).zip(&mut boxes).for_each(|(id, one)| one.key = f32::MAX.to_bits() - id);
            for builder in &BUILDERS {
                let tree = builder.build(&boxes)?;
                let mut found = 0;
                for (id, one) in (0..).zip(&boxes) {
                    let middle = one.min * 0.5 + one.max * 0.5;
                    let ray = Ray::new(middle, Vec3::X).with_range(0.0, f32::from_bits(one.key));
                    let hit = tree.closest_hit(ray);
                    found += usize::from(hit.is_hit && hit.prim_id == id);
                }
                let nothing = Ray::new(Vec3::splat(-3.0), Vec3::X).with_range(0.0, 1.0);
                let is_wrong = found != count || tree.closest_hit(nothing).is_hit;
                all.add(run.unit, f64::from(u8::from(is_wrong)), || {
                    format!("{count} {}, {}: {found} found", kind.name, builder.name)
                });
            }
        }
    }
    Ok(Outcome::host(all))
}
