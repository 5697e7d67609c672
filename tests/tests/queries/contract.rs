//! The contract of queries, against a loop in plain Rust: of the hits within the ray's range, ends
//! included, the least by `(t, inst_id, prim_id)`, whatever finds them.
//!
//! No traversal of the library takes part in the oracle. Distances are computed without rounding,
//! so copies and neighbours share them, and ranges begin or end at hits; the tests assert that
//! enough rays have both.

use raydsl::bvh::{Accelerated, BuildError};
use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_tests::check::every_variant;
use raydsl_tests::lattice::{Backwards, lattice_rays};
use raydsl_tests::rng::Rng;

/// A rectangle across the z axis. It leaves the ray's range to its caller.
#[primitive]
#[derive(Debug, PartialEq)]
struct Card {
    low: Vec3,
    high: Vec3,
}

#[primitive]
impl Card {
    fn intersect(&self, ray: Ray) -> Hit {
        let t = (self.low.z - ray.origin.z) / ray.direction.z;
        let x = ray.origin.x + t * ray.direction.x;
        let y = ray.origin.y + t * ray.direction.y;
        let is_inside = x >= self.low.x && x <= self.high.x && y >= self.low.y && y <= self.high.y;
        Hit { u: x, v: y, ..Hit::new(is_inside, t) }
    }

    fn get_bounds(&self) -> Aabb {
        Aabb { min: self.low, max: self.high }
    }
}

/// Cards on planes `z = -4, -3, ..`, a third of them copies, in an order of no meaning.
fn cards(rng: &mut Rng, count: usize) -> Vec<Card> {
    let whole = |rng: &mut Rng, n: usize| rng.below(n) as f32;
    let mut all: Vec<Card> = (0..count)
        .map(|_| {
            let low = vec3(whole(rng, 9) - 5.0, whole(rng, 9) - 5.0, whole(rng, 9) - 4.0);
            let size = vec3(1.0 + whole(rng, 4), 1.0 + whole(rng, 4), 0.0);
            Card { low, high: low + size }
        })
        .collect();
    for _ in 0..count / 2 {
        let again = all[rng.below(count)];
        all.push(again);
    }
    let order = rng.permutation(all.len());
    order.into_iter().map(|i| all[i]).collect()
}

/// Cards where they stand in a scene.
struct Placed<'a> {
    cards: &'a [Card],
    /// What the scene adds to their numbers.
    first: u32,
    moved: Vec3,
}

/// All hits in order.
fn hits(scene: &[Placed<'_>], ray: Ray) -> Vec<Hit> {
    let mut all: Vec<Hit> = Vec::new();
    if !ray.origin.is_finite() || !ray.direction.is_finite() {
        return all;
    }
    for (inst, placed) in scene.iter().enumerate() {
        for (id, card) in placed.cards.iter().enumerate() {
            // Whole numbers: the sum is exact, and so is the move of the ray that a scene makes.
            let local = Ray { origin: ray.origin - placed.moved, ..ray };
            let hit = card.intersect(local);
            if hit.is_hit && ray.t_min <= hit.t && hit.t <= ray.t_max {
                all.push(Hit { inst_id: inst as u32, prim_id: placed.first + id as u32, ..hit });
            }
        }
    }
    all.sort_by(|a, b| {
        let nearer = a.t.partial_cmp(&b.t).expect("a hit within a range has a distance");
        nearer.then((a.inst_id, a.prim_id).cmp(&(b.inst_id, b.prim_id)))
    });
    all
}

/// The results of the kernels' queries: the closest hit, whether there is any, the first three, and
/// of those with odd primitive ids the closest, whether there is any, and the first two.
type Answer = (Hit, bool, [Hit; 3], Hit, bool, [Hit; 2]);

fn is_odd(hit: Hit) -> bool {
    hit.prim_id % 2 == 1
}

fn expected(scene: &[Placed<'_>], ray: Ray) -> Answer {
    let all = hits(scene, ray);
    let odd: Vec<Hit> = all.iter().copied().filter(|hit| is_odd(*hit)).collect();
    let at = |hits: &[Hit], i: usize| hits.get(i).copied().unwrap_or(Hit::miss());
    (
        at(&all, 0),
        !all.is_empty(),
        [0, 1, 2].map(|i| at(&all, i)),
        at(&odd, 0),
        !odd.is_empty(),
        [0, 1].map(|i| at(&odd, i)),
    )
}

/// Compares what a scene answers on the host and in every variant with the oracle.
#[track_caller]
fn assert_contract(
    who: &str,
    kernel: &Kernel<'_, (Ray,), Answer>,
    scene: &[Placed<'_>],
    rays: &[(Ray,)],
) {
    let (mut tied, mut at_an_end) = (0, 0);
    for (ray,) in rays {
        let expected = expected(scene, *ray);
        let found = kernel.call((*ray,));
        assert_eq!(found, expected, "{who}: {ray:?}");
        let [first, second, _] = expected.2;
        tied += usize::from(second.is_hit && first.t == second.t);
        at_an_end += usize::from(first.is_hit && (first.t == ray.t_min || first.t == ray.t_max));
    }
    assert!(tied * 4 > rays.len(), "{who}: {tied} of {} rays have a tie", rays.len());
    assert!(at_an_end * 10 > rays.len(), "{who}: {at_an_end} of {} end at a hit", rays.len());
    every_variant(kernel, rays);
}

/// A kernel that asks everything of a scene.
macro_rules! asked {
    ($scene:ident) => {
        kernel!(|ray: Ray| {
            let odd = $scene.multi_hit_where::<2>(ray, |hit: Hit| hit.prim_id % 2 == 1);
            (
                $scene.closest_hit(ray),
                $scene.any_hit(ray),
                $scene.multi_hit::<3>(ray),
                $scene.closest_hit_where(ray, |hit: Hit| hit.prim_id % 2 == 1),
                $scene.any_hit_where(ray, |hit: Hit| hit.prim_id % 2 == 1),
                odd,
            )
        })
    };
}

const RAYS: usize = 1000;
const HERE: Vec3 = Vec3::ZERO;

#[test]
fn slices() {
    let mut rng = Rng::of("slices");
    let cards = cards(&mut rng, 120);
    let all = &cards[..];
    let scene = [Placed { cards: all, first: 0, moved: HERE }];
    assert_contract("a slice", &asked!(all), &scene, &lattice_rays(&mut rng, RAYS));
}

#[test]
fn trees() -> Result<(), BuildError> {
    let mut rng = Rng::of("trees");
    let cards = cards(&mut rng, 120);
    let scene = [Placed { cards: &cards, first: 0, moved: HERE }];
    let rays = lattice_rays(&mut rng, RAYS);
    let check = |who: &str, tree: &Bvh<'_, Card>| {
        assert_contract(who, &asked!(tree), &scene, &rays);
    };
    for quality in [BuildQuality::Fast, BuildQuality::Balanced, BuildQuality::Best] {
        let config = BuildConfig { quality, min_wide_size: 0, ..BuildConfig::default() };
        check(&format!("{quality:?}"), &Bvh::build_with(&cards, &config)?);
        check(&format!("{quality:?}, wide"), &Bvh::build_wide(&cards, &[], &config)?);
    }
    Ok(())
}

#[test]
fn lists_of_trees() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Rng::of("lists");
    let cards = cards(&mut rng, 120);
    let rays = lattice_rays(&mut rng, RAYS);
    let (front, back) = cards.split_at(50);
    // One number after the other, as of one slice.
    let scene = [Placed { cards: &cards, first: 0, moved: HERE }];
    let config = BuildConfig { min_wide_size: 0, ..BuildConfig::default() };
    let binary = [Bvh::build(front)?, Bvh::build(back)?];
    let wide = [Bvh::build_wide(front, &[], &config)?, Bvh::build_wide(back, &[], &config)?];
    let check = |who: &str, list: &BvhList<'_, Card>| {
        assert_contract(who, &asked!(list), &scene, &rays);
    };
    check("a list", &BvhList::new(&binary)?);
    check("a list of wide trees", &BvhList::new(&wide)?);
    Ok(())
}

/// One tree in two places and twice in one of them: of a tie the first instance comes first.
#[test]
fn instances() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Rng::of("instances");
    let cards = cards(&mut rng, 60);
    let (one, two) = cards.split_at(40);
    let trees = [Bvh::build(one)?, Bvh::build(two)?];
    let places =
        [(0, HERE), (1, vec3(1.0, 0.0, -2.0)), (0, HERE), (0, vec3(0.0, -2.0, 1.0)), (1, HERE)];
    let placed = places.map(|(tree, moved)| Instance::new(tree, Affine3::from_translation(moved)));
    let scene = Instances::build(&trees, &placed)?;
    let firsts = [0, one.len() as u32];
    let oracle: Vec<Placed<'_>> = places
        .iter()
        .map(|(tree, moved)| Placed {
            cards: [one, two][*tree],
            first: firsts[*tree],
            moved: *moved,
        })
        .collect();
    assert_contract("instances", &asked!(scene), &oracle, &lattice_rays(&mut rng, RAYS));
    Ok(())
}

#[test]
fn accelerators_of_the_application() {
    let mut rng = Rng::of("accelerators");
    let cards = cards(&mut rng, 120);
    let scene = [Placed { cards: &cards, first: 0, moved: HERE }];
    let standing = Accelerated::new(&cards, Backwards(cards.len() as u32));
    assert_contract("an accelerator", &asked!(standing), &scene, &lattice_rays(&mut rng, RAYS));
}
