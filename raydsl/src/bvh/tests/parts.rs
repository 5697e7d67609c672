//! Trees with split primitives.

use super::*;
use crate::bvh::{Node, Settings, TreeFault, build, validate::check};
use crate::geometry::Aabb;

fn binary(config: BuildConfig) -> Settings {
    Settings { config, is_wide: false }
}

fn best(max_duplication: f32) -> BuildConfig {
    BuildConfig { max_duplication, ..BuildQuality::Best.into() }
}

impl Numbers {
    fn triangle(&mut self, size: f32) -> Triangle {
        let at = self.point();
        let [v0, v1, v2] = [(); 3].map(|()| at + size * self.point());
        Triangle { v0, v1, v2 }
    }

    /// Returns long thin triangles along diagonals, among small ones.
    fn slanted(&mut self, count: usize) -> Vec<Triangle> {
        let mut one = |k: usize| {
            if !k.is_multiple_of(8) {
                return self.triangle(0.02);
            }
            let (v0, width) = (self.point(), 0.01 * self.point());
            let along = self.point().signum() * (1.0 + 0.2 * self.point());
            Triangle { v0, v1: v0 + along, v2: v0 + along + width }
        };
        (0..count).map(&mut one).collect()
    }
}

/// Returns triangles that are hard to cut, or to cut correctly.
fn soups() -> Vec<(&'static str, Vec<Triangle>)> {
    let mut numbers = Numbers::of(21);
    let slanted = numbers.slanted(400);
    let mapped = |change: &dyn Fn(Vec3) -> Vec3| -> Vec<_> {
        let mapped = |t: &Triangle| [t.v0, t.v1, t.v2].map(change);
        slanted.iter().map(mapped).map(|[v0, v1, v2]| Triangle { v0, v1, v2 }).collect()
    };
    let mut giant = slanted.clone();
    giant[7] = Triangle { v0: -100.0 * Vec3::ONE, v1: 100.0 * Vec3::ONE, v2: Vec3::X };
    vec![
        ("random", (0..400).map(|_| numbers.triangle(0.5)).collect()),
        ("twice", [&slanted[..200], &slanted[..200]].concat()),
        ("far away", mapped(&|v| v + 1000.0)),
        ("small", mapped(&|v| v * 1e-10)),
        ("large", mapped(&|v| v * 1e10)),
        ("flat", mapped(&|v| v.with_z(0.25))),
        ("on a lattice", mapped(&|v| (4.0 * v).round() / 4.0)),
        ("on a line", mapped(&|v| Vec3::splat(v.x))),
        ("one giant", giant),
        ("slanted", slanted),
    ]
}

#[test]
fn hits_are_those_of_brute_force() {
    for (name, triangles) in soups() {
        for quality in [best(0.0), best(0.3), best(4.0), BuildQuality::Balanced.into()] {
            let bvh = Bvh::build_with(&triangles, &quality).expect("finite bounds");
            let duplication = bvh.statistics().duplication;
            assert!(duplication <= 1.0 + f64::from(quality.max_duplication), "{name}");
            assert_as_brute_force(&bvh, &triangles);
        }
    }
}

/// Returns rays at points of the triangles, many of them along a triangle, up to rounding.
fn rays_at(triangles: &[Triangle], count: usize) -> Vec<Ray> {
    let mut numbers = Numbers::of(29);
    let mut one = |k: usize| {
        let Triangle { v0, v1, v2 } = triangles[k % triangles.len()];
        let mut on = || {
            let (a, b) = (numbers.next().abs(), numbers.next().abs());
            let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
            v0 + (v1 - v0) * a + (v2 - v0) * b
        };
        let (p, q) = (on(), on());
        let d = match k / triangles.len() % 4 {
            0 => numbers.point() * (v1 - v0).length(),
            1 => (v1 - v0) + numbers.next() * (v2 - v0),
            _ => q - p,
        };
        let ray = Ray::new(p - 2.0 * numbers.next().abs() * d, d);
        if k.is_multiple_of(3) { ray.with_range(0.0, 2.0 * numbers.next().abs()) } else { ray }
    };
    (0..count).map(&mut one).collect()
}

#[test]
fn rays_along_triangles_hit_as_in_brute_force() {
    let count = shared_out(20_000);
    let (mut hits, mut rays_in_all) = (0, 0);
    for (name, triangles) in soups() {
        let mut fans = triangles.clone();
        // A neighbour at each edge: hits of both at almost one distance.
        fans.extend(triangles.iter().map(|t| Triangle { v2: t.v1 + t.v0 - t.v2, ..*t }));
        for triangles in [triangles, fans] {
            let bvh = Bvh::build_with(&triangles, &best(4.0)).expect("finite bounds");
            for ray in rays_at(&triangles, count) {
                let (found, expected) = (bvh.closest_hit(ray), triangles.closest_hit(ray));
                let same = found == expected && found.t.to_bits() == expected.t.to_bits();
                assert!(same, "{name}: {ray:?}: {found:?} for {expected:?}");
                assert_eq!(bvh.any_hit(ray), expected.is_hit, "{name}: {ray:?}");
                hits += usize::from(expected.is_hit);
                rays_in_all += 1;
            }
        }
    }
    assert!(hits * 4 > rays_in_all, "{hits} hits of {rays_in_all}");
}

/// A share of the work of a long test, as of `RAYDSL_TEST_SHARE`.
fn shared_out(full: usize) -> usize {
    let share = std::env::var("RAYDSL_TEST_SHARE").ok().and_then(|share| share.parse().ok());
    (full as f64 * share.unwrap_or(1.0)) as usize
}

#[test]
fn multi_hits_have_each_primitive_once() {
    let triangles = Numbers::of(22).slanted(300);
    let bvh = Bvh::build_with(&triangles, &best(4.0)).expect("finite bounds");
    assert!(bvh.statistics().duplication > 1.2);
    let mut numbers = Numbers::of(23);
    for _ in 0..300 {
        let (origin, target) = (2.0 * numbers.point(), numbers.point());
        let ray = Ray::new(origin, target - origin);
        assert_eq!(bvh.multi_hit::<6>(ray), triangles.multi_hit::<6>(ray));
    }
}

#[test]
fn slanted_triangles_are_cheaper_cut() {
    let triangles = Numbers::of(24).slanted(4000);
    let [balanced, none, few, many] =
        [BuildQuality::Balanced.into(), best(0.0), best(0.1), best(1.0)].map(|config| {
            let bvh = Bvh::build_with(&triangles, &config).expect("finite bounds");
            crate::bvh::validate(&bvh).expect("the tree is sound");
            let statistics = bvh.statistics();
            println!("{config:?}: {statistics:?}");
            assert_eq!(statistics.bytes, 32 * statistics.nodes + 4 * bvh.indices().len());
            statistics
        });
    assert_eq!(none, balanced, "without room nothing is cut");
    assert!(few.duplication > 1.01 && few.duplication <= 1.1);
    assert!(many.duplication > few.duplication && many.duplication <= 2.0);
    assert!(few.sah_cost < balanced.sah_cost);
    assert!(many.sah_cost < 0.8 * balanced.sah_cost);
}

#[test]
fn spheres_of_all_sizes() {
    let mut numbers = Numbers::of(25);
    let mut balls = numbers.balls(500);
    balls.iter_mut().for_each(|ball| ball.radius *= (2.0 * numbers.next()).exp2());
    let bvh = Bvh::build_with(&balls, &best(1.0)).expect("finite bounds");
    assert!(bvh.statistics().duplication > 1.0);
    assert!(assert_as_brute_force(&bvh, &balls) > 200);
}

#[test]
fn refitted_trees_hold_whole_primitives() {
    let triangles = Numbers::of(26).slanted(500);
    let bvh = Bvh::build_with(&triangles, &best(1.0)).expect("finite bounds");
    let copy = triangles.clone();
    let bvh = bvh.refit(&copy).expect("finite bounds");
    assert!(bvh.cost_growth() > 1.0, "boxes of parts become those of whole triangles");
    assert_as_brute_force(&bvh, &copy);
}

#[test]
fn a_part_that_is_lost_is_found() {
    let triangles = Numbers::of(27).slanted(300);
    let bvh = Bvh::build_with(&triangles, &best(1.0)).expect("finite bounds");
    let source = build::Primitives { prims: &triangles[..], shared: &[] };
    let entries = |primitive: u32| bvh.indices().iter().filter(|&&k| k == primitive).count();
    let cut = (0..300).find(|&k| entries(k) > 1).expect("a triangle that is cut");
    // Its leaves shrink to a point.
    let mut nodes = bvh.nodes().to_vec();
    let has_it = |leaf: &Node| {
        leaf.is_leaf() && bvh.indices()[leaf.first as usize..][..leaf.count as usize].contains(&cut)
    };
    for leaf in nodes.iter_mut().filter(|leaf| has_it(leaf)) {
        leaf.max = leaf.min;
    }
    let fault = check(&nodes, bvh.indices(), 300, &source).expect_err("a part is lost");
    assert!(
        matches!(fault, TreeFault::PartMissing { .. } | TreeFault::PrimitiveOutside { .. }),
        "{fault}"
    );
}

/// Answer of a [`Liar`] to a cut.
#[derive(Clone, Copy)]
enum Lie {
    NotNumbers,
    Nothing,
    Elsewhere,
    Inverted,
    Everything,
}

/// Source with invalid parts.
struct Liar {
    boxes: Vec<Aabb>,
    lie: Lie,
}

impl build::Source for Liar {
    fn bounds(&self, index: usize) -> Aabb {
        self.boxes[index]
    }

    fn split(&self, index: usize, _: usize, _: f32) -> (Aabb, Aabb) {
        let own = self.boxes[index];
        let nan = Vec3::NAN;
        match self.lie {
            Lie::NotNumbers => (Aabb { min: nan, max: nan }, Aabb { min: own.min, max: nan }),
            Lie::Nothing => (Aabb::EMPTY, Aabb::EMPTY),
            Lie::Elsewhere => (Aabb::new(own.max + 7.0, own.max + 9.0), Aabb::EMPTY),
            Lie::Inverted => (Aabb::new(own.max, own.min), Aabb::new(own.max, own.min)),
            Lie::Everything => {
                let all = Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY);
                (all, all)
            }
        }
    }
}

#[test]
fn parts_that_are_none_lose_no_primitive() {
    let mut numbers = Numbers::of(28);
    let boxes: Vec<_> = numbers.slanted(1000).iter().map(|t| t.get_bounds()).collect();
    for lie in [Lie::NotNumbers, Lie::Nothing, Lie::Elsewhere, Lie::Inverted, Lie::Everything] {
        let liar = Liar { boxes: boxes.clone(), lie };
        let tree =
            build::build_watched(&liar, 1000, &binary(best(1.0)), None).expect("finite bounds");
        // The parts of the boxes themselves contain the primitive.
        let source = build::Boxes(|k: usize| boxes[k]);
        assert_eq!(check(&tree.nodes, &tree.indices, 1000, &source), Ok(()));
    }
}

/// A device keeps the list: another order, or fewer entries, would not match its leaves.
#[test]
fn refitting_leaves_the_index_list() {
    let (before, after) = (Numbers::of(23).slanted(400), Numbers::of(24).slanted(400));
    let bvh = Bvh::build_wide(&before, &[], &best(4.0)).expect("finite bounds");
    let indices = bvh.indices().to_vec();
    assert!(indices.len() > before.len(), "some are cut");
    let bvh = bvh.refit(&after).expect("finite bounds");
    assert!(bvh.indices() == indices);
    assert_as_brute_force(&bvh, &after);
}
