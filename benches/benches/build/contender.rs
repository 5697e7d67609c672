//! Who builds: the library's qualities, obvhs from its fastest to its best, Embree if it is there.

use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use raydsl::bvh::{BuildConfig, BuildQuality, Node};
use raydsl::prelude::*;
use raydsl_benches::clock::seconds_on;
use raydsl_benches::embree::{self, Embree, Quality, Robustness, Shape};

/// What was built, and how long it took: see [`seconds_on`].
pub(crate) struct Tree {
    pub(crate) seconds: f64,
    pub(crate) sah_cost: Option<f64>,
    pub(crate) nodes: Option<usize>,
    /// Nodes and indices; of Embree all that it holds, with its copies of the triangles.
    pub(crate) bytes: Option<usize>,
    pub(crate) refit_seconds: Option<f64>,
}

/// Builds once.
type Build<'a> = Box<dyn FnMut() -> Result<Tree, String> + Send + 'a>;

/// Builds a tree over the triangles of one scene.
pub(crate) struct Contender<'a> {
    pub(crate) system: &'static str,
    pub(crate) builder: &'static str,
    pub(crate) build: Build<'a>,
}

/// The library's builders.
const QUALITIES: [(&str, BuildQuality); 3] = [
    ("balanced", BuildQuality::Balanced),
    ("fast", BuildQuality::Fast),
    ("best", BuildQuality::Best),
];

/// Those of obvhs.
const PRESETS: [(&str, BvhBuildParams); 6] = [
    ("fastest", BvhBuildParams::fastest_build()),
    ("very fast", BvhBuildParams::very_fast_build()),
    ("fast", BvhBuildParams::fast_build()),
    ("medium", BvhBuildParams::medium_build()),
    ("slow", BvhBuildParams::slow_build()),
    ("very slow", BvhBuildParams::very_slow_build()),
];

/// Everyone; the first one is what the others are compared with.
pub(crate) fn contenders(triangles: &[Triangle], threads: usize) -> Vec<Contender<'_>> {
    let mut all: Vec<Contender<'_>> = QUALITIES
        .into_iter()
        .map(|(builder, quality)| Contender {
            system: "raydsl",
            builder,
            build: Box::new(move || own(triangles, quality, threads)),
        })
        .collect();
    let wide = glam::Vec3A::from;
    let theirs: Vec<obvhs::triangle::Triangle> = triangles
        .iter()
        .map(|t| obvhs::triangle::Triangle { v0: wide(t.v0), v1: wide(t.v1), v2: wide(t.v2) })
        .collect();
    let theirs: &'static [obvhs::triangle::Triangle] = theirs.leak();
    all.extend(PRESETS.into_iter().map(|(builder, params)| Contender {
        system: "obvhs",
        builder,
        build: Box::new(move || Ok(obvhs_tree(theirs, params, threads))),
    }));
    all.extend(embree(triangles, threads));
    all
}

fn own(triangles: &[Triangle], quality: BuildQuality, threads: usize) -> Result<Tree, String> {
    let config = BuildConfig::from(quality);
    let (bvh, seconds) = seconds_on(threads, || Bvh::build_with(triangles, &config));
    let bvh = bvh.map_err(|error| error.to_string())?;
    let statistics = bvh.statistics();
    let (refitted, refit_seconds) = seconds_on(threads, || bvh.detach().refit(triangles));
    refitted.map_err(|error| error.to_string())?;
    Ok(Tree {
        seconds,
        sah_cost: Some(statistics.sah_cost),
        nodes: Some(statistics.nodes),
        bytes: Some(statistics.bytes),
        refit_seconds: Some(refit_seconds),
    })
}

fn obvhs_tree(
    triangles: &[obvhs::triangle::Triangle],
    params: BvhBuildParams,
    threads: usize,
) -> Tree {
    let build = || build_bvh2_from_tris(triangles, params, &mut Default::default());
    let (bvh, seconds) = seconds_on(threads, build);
    let nodes: Vec<Node> = bvh
        .nodes
        .iter()
        .map(|node| Node {
            min: node.aabb.min.into(),
            first: node.first_index,
            max: node.aabb.max.into(),
            count: node.prim_count,
        })
        .collect();
    let bytes = size_of_val(&bvh.nodes[..]) + size_of_val(&bvh.primitive_indices[..]);
    Tree {
        seconds,
        sah_cost: Some(sah_cost(&nodes)),
        nodes: Some(nodes.len()),
        bytes: Some(bytes),
        refit_seconds: None,
    }
}

/// [`raydsl::bvh::Statistics::sah_cost`] of someone else's nodes, with the costs that the library
/// builds with.
fn sah_cost(nodes: &[Node]) -> f64 {
    let config = BuildConfig::default();
    let area = |node: &Node| {
        let d = (node.max - node.min).as_dvec3();
        d.x * d.y + d.y * d.z + d.z * d.x
    };
    let cost = |node: &Node| match node.count {
        0 => f64::from(config.traversal_cost) * area(node),
        count => f64::from(config.intersection_cost) * f64::from(count) * area(node),
    };
    nodes.iter().map(cost).sum::<f64>() / nodes.first().map_or(1.0, area)
}

/// Embree's three qualities, if `RAYDSL_EMBREE` names its library.
fn embree(triangles: &[Triangle], threads: usize) -> Vec<Contender<'_>> {
    let Some(path) = embree::path() else {
        return Vec::new();
    };
    let shape = Shape::triangles(triangles);
    [Quality::Low, Quality::Medium, Quality::High]
        .into_iter()
        .map(|quality| {
            let embree = Embree::load(&path, threads);
            let shape = shape.clone();
            let build: Build<'_> = Box::new(move || {
                let embree = embree.as_ref().map_err(Clone::clone)?;
                let scene = embree.build(&shape, quality, Robustness::Off);
                Ok(Tree {
                    seconds: scene.seconds,
                    sah_cost: None,
                    nodes: None,
                    bytes: Some(scene.bytes),
                    refit_seconds: None,
                })
            });
            Contender { system: "embree", builder: quality.name(), build }
        })
        .collect()
}
