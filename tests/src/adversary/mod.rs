//! Scenes made of bytes: whatever they say, a tree answers as its primitives asked one by one.
//!
//! The test `adversary` makes the bytes itself, the fuzz target `scenes` is given them by
//! libFuzzer. All that is chosen is chosen from the bytes, and nothing is when they run out, so
//! that a fuzzer can make a case smaller.

mod choices;
mod layout;

use raydsl::bvh::{self, BuildError};
use raydsl::prelude::*;
use raydsl::primitive;

pub use choices::Choices;

use crate::placed;

#[primitive(sphere(center, radius))]
#[derive(Debug, PartialEq)]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// A ball whose test is said to be long: wide trees keep its box.
#[primitive]
#[derive(Debug, PartialEq)]
struct Bead {
    center: Vec3,
    radius: f32,
}

#[primitive]
impl Bead {
    const SLACK: f32 = sphere::SLACK;
    const MAX_CROSSINGS: u32 = sphere::MAX_CROSSINGS;

    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius)
    }
}

/// What adversaries are made of.
trait Subject: Primitive<Hit = Hit, Shared = ()> + std::fmt::Debug {
    /// One around a point, of about this size.
    fn chosen(choices: &mut Choices<'_>, at: Vec3, size: f32) -> Self;
    /// A point that rays may aim at.
    fn target(&self, choices: &mut Choices<'_>) -> Vec3;
}

impl Subject for Ball {
    fn chosen(choices: &mut Choices<'_>, at: Vec3, size: f32) -> Self {
        Self { center: at, radius: size * choices.pick(&[1.0, 0.5, 0.0, 1e-3]) }
    }

    fn target(&self, choices: &mut Choices<'_>) -> Vec3 {
        self.center + choices.axis() * self.radius
    }
}

impl Subject for Bead {
    fn chosen(choices: &mut Choices<'_>, at: Vec3, size: f32) -> Self {
        let Ball { center, radius } = Ball::chosen(choices, at, size);
        Self { center, radius }
    }

    fn target(&self, choices: &mut Choices<'_>) -> Vec3 {
        self.center + choices.axis() * self.radius
    }
}

impl Subject for Triangle {
    fn chosen(choices: &mut Choices<'_>, at: Vec3, size: f32) -> Self {
        let [a, b] = [choices.point() * size, choices.point() * size];
        match choices.below(6) {
            0 => Self { v0: at, v1: at + a, v2: at + a },
            1 => Self { v0: at, v1: at + a, v2: at + a * 0.5 },
            2 => Self { v0: at, v1: at + a, v2: at + a + b * 1e-4 },
            _ => Self { v0: at, v1: at + a, v2: at + b },
        }
    }

    fn target(&self, choices: &mut Choices<'_>) -> Vec3 {
        let Self { v0, v1, v2 } = *self;
        choices.pick(&[v0, v1, 0.5 * (v0 + v1), (v0 + v1 + v2) / 3.0])
    }
}

/// Builds what the bytes say and asks it; how many rays hit.
///
/// # Panics
///
/// Where a tree answers otherwise than its primitives do.
pub fn scene(bytes: &[u8]) -> usize {
    let choices = &mut Choices::new(bytes);
    match choices.below(3) {
        0 => scene_of::<Ball>(choices),
        1 => scene_of::<Bead>(choices),
        _ => scene_of::<Triangle>(choices),
    }
}

fn scene_of<P: Subject>(choices: &mut Choices<'_>) -> usize {
    let way = way(choices);
    let mut prims: Vec<P> = layout::chosen(choices);
    let bvh = match way.build(&prims) {
        Ok(bvh) => bvh,
        Err(error) => {
            assert_deserved(&error, &prims, &way.config);
            return 0;
        }
    };
    bvh::validate(&bvh).expect("a tree that was built is sound");
    let rays = rays(choices, &prims, bvh.bounds());
    let mut hits = assert_as_slice(&bvh, &prims, &rays);
    if choices.below(2) == 1 {
        hits += placed_scene(choices, &prims, &way);
    }
    let tree = bvh.detach();
    layout::move_some(choices, &mut prims);
    match tree.refit(&prims) {
        Ok(moved) => {
            bvh::validate(&moved).expect("a tree that was refitted is sound");
            hits += assert_as_slice(&moved, &prims, &rays);
        }
        Err(error) => assert!(prims.iter().any(|p| !is_finite(p)), "{error}"),
    }
    hits
}

/// How trees are built.
struct Way {
    config: BuildConfig,
    is_wide: bool,
}

impl Way {
    fn build<'p, P: Subject>(&self, prims: &'p [P]) -> Result<Bvh<'p, P>, BuildError> {
        if self.is_wide {
            Bvh::build_wide(prims, &[], &self.config)
        } else {
            Bvh::build_with(prims, &self.config)
        }
    }
}

fn way(choices: &mut Choices<'_>) -> Way {
    let mut config = BuildConfig {
        quality: choices.pick(&BuildQuality::ALL),
        max_leaf_size: choices.pick(&[4, 1, 2, 16, 0]),
        bins: choices.pick(&[32, 2, 5]),
        traversal_cost: choices.pick(&[1.0, 0.0, 10.0]),
        min_overlap: choices.pick(&[1e-5, 0.0]),
        max_duplication: choices.pick(&[0.3, 0.0, 4.0]),
        min_wide_size: 0,
        ..BuildConfig::default()
    };
    let is_wide = choices.pick(&[false, true]);
    config.traversal = choices.pick(&Traversal::ALL);
    Way { config, is_wide }
}

fn is_finite<P: Subject>(prim: &P) -> bool {
    let bounds = prim.get_bounds(&[]);
    bounds.is_finite() && bounds.is_valid()
}

/// Panics where there is no reason not to build a tree.
fn assert_deserved<P: Subject>(error: &BuildError, prims: &[P], config: &BuildConfig) {
    let is_deserved = match error {
        BuildError::InvalidConfig { .. } => config.max_leaf_size == 0,
        _ => prims.iter().any(|p| !is_finite(p)),
    };
    assert!(is_deserved, "{error}");
}

/// Rays around a scene and at its primitives.
fn rays<P: Subject>(choices: &mut Choices<'_>, prims: &[P], bounds: Aabb) -> Vec<Ray> {
    let bounds = if bounds.is_valid() { bounds } else { Aabb::new(Vec3::ZERO, Vec3::ZERO) };
    let size = bounds.size().max_element().max(1e-6);
    (0..24)
        .map(|_| {
            let origin = bounds.center() + choices.point() * size * choices.pick(&[1.0, 0.1, 30.0]);
            let target = match prims.len() {
                0 => bounds.center(),
                len => prims[choices.below(len)].target(choices),
            };
            let direction = match choices.below(4) {
                0 => choices.axis() * size,
                1 => choices.point(),
                _ => target - origin,
            };
            // Through the target along an axis: in the planes of boxes.
            let origin = if choices.below(5) == 1 { target - direction } else { origin };
            let mut ray = Ray::new(origin, direction * choices.pick(&[1.0, 1e-3, 1e3]));
            match choices.below(8) {
                1 => ray.t_max = choices.number().abs(),
                2 => ray.t_min = choices.number(),
                3 => ray.origin.y = f32::NAN,
                4 => ray.direction.x = f32::INFINITY,
                _ => {}
            }
            ray
        })
        .collect()
}

/// How many rays hit.
fn assert_as_slice<P: Subject>(bvh: &Bvh<'_, P>, prims: &[P], rays: &[Ray]) -> usize {
    let mut hits = 0;
    for ray in rays {
        let hit = prims.closest_hit(*ray);
        hits += usize::from(hit.is_hit);
        assert_eq!(bvh.closest_hit(*ray), hit, "{ray:?}");
        assert_eq!(bvh.any_hit(*ray), hit.is_hit, "{ray:?}");
        assert_eq!(bvh.multi_hit::<3>(*ray), prims.multi_hit::<3>(*ray), "{ray:?}");
        let odd = |hit: Hit| hit.prim_id % 2 == 1;
        assert_eq!(bvh.closest_hit_where(*ray, odd), prims.closest_hit_where(*ray, odd), "{ray:?}");
    }
    assert_packets(bvh, rays);
    hits
}

/// Packets find what single rays do.
fn assert_packets<Q: RecordQuery<Hit = Hit> + ?Sized>(scene: &Q, rays: &[Ray])
where
    for<'a> Queried<'a, Q>: Ask,
{
    let expected: Vec<(Hit, bool)> =
        rays.iter().map(|ray| (scene.closest_hit(*ray), scene.any_hit(*ray))).collect();
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        assert_eq!(Queried(scene).ask(variant, rays), expected, "{variant:?}");
    }
}

/// A scene that kernels may be made of.
struct Queried<'a, Q: ?Sized>(&'a Q);

/// Asks a scene in a kernel.
trait Ask {
    fn ask(&self, variant: Variant, rays: &[Ray]) -> Vec<(Hit, bool)>;
}

macro_rules! ask {
    ($($scene:ident),+) => {
        $(
            impl<P: Subject> Ask for Queried<'_, $scene<'_, P>> {
                fn ask(&self, variant: Variant, rays: &[Ray]) -> Vec<(Hit, bool)> {
                    let scene = self.0;
                    let kernel = kernel!(|ray: Ray| (scene.closest_hit(ray), scene.any_hit(ray)));
                    let inputs: Vec<(Ray,)> = rays.iter().map(|ray| (*ray,)).collect();
                    let mut outputs = vec![(Hit::miss(), false); rays.len()];
                    kernel.run(variant, &inputs, &mut outputs);
                    outputs
                }
            }
        )+
    };
}

ask!(Bvh, Instances);

/// The same primitives, placed a few times; how many rays hit.
fn placed_scene<P: Subject>(choices: &mut Choices<'_>, prims: &[P], way: &Way) -> usize {
    let (front, back) = prims.split_at(choices.below(prims.len() + 1));
    let trees = [front, back].map(|prims| way.build(prims));
    let [Ok(front), Ok(back)] = trees else { return 0 };
    let trees = [front, back];
    let Ok(mut scene) = Instances::new(&trees) else { unreachable!("few primitives") };
    let (mut top, mut last) = (Vec::new(), None);
    for _ in 0..1 + choices.below(3) {
        let instances: Vec<Instance> = (0..1 + choices.below(4))
            .map(|_| {
                let map = choices.map();
                match (last, choices.below(3)) {
                    (Some(group), 0) => Instance::new(group, map),
                    (_, tree) => Instance::new(tree % 2, map),
                }
            })
            .collect();
        // A transform may have no inverse, or the scene reach too far.
        let Ok(group) = scene.group(&instances) else { break };
        (top, last) = (instances, Some(group));
    }
    let all = placed::unfold(&scene, &trees, &top);
    let rays = rays(choices, prims, scene.bounds());
    let mut met = 0;
    for ray in &rays {
        let hits = placed::brute_force(&all, *ray);
        let first = hits.first().copied().unwrap_or(Hit::miss());
        met += usize::from(first.is_hit);
        assert_eq!(scene.closest_hit(*ray), first, "{ray:?}");
        assert_eq!(scene.any_hit(*ray), first.is_hit, "{ray:?}");
        let second = hits.get(1).copied().unwrap_or(Hit::miss());
        assert_eq!(scene.multi_hit::<2>(*ray), [first, second], "{ray:?}");
    }
    assert_packets(&scene, &rays);
    met
}
