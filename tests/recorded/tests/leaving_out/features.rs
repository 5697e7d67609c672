//! The features of the matrix, and how each is known in a program.

/// A feature of the library.
pub(crate) struct Feature {
    pub(crate) name: &'static str,
    /// What a program with it has: source files of kernels, and names of functions, structs, bindings,
    /// numbers and constants, which may begin or end with `*`; a trace with a space is a piece of the
    /// text, for arms of one function.
    pub(crate) traces: &'static [&'static str],
}

const fn feature(name: &'static str, traces: &'static [&'static str]) -> Feature {
    Feature { name, traces }
}

/// All features: a new one is one line.
pub(crate) const FEATURES: &[Feature] = &[
    feature("sphere", &["geometry/sphere.rs"]),
    feature("disk", &["geometry/disk.rs", "Near"]),
    feature("triangle", &["geometry/triangle.rs", "math/exact.rs"]),
    feature("tree", &["Slabs", "*_nodes", "*_ids"]),
    feature("wide tree", &["bvh/wide/compressed/mod.rs", "CompressedNode", "*_leaves"]),
    feature("instances", &["bvh/on/wgsl/instances.rs", "Place", "*_places", "TraversalLevel"]),
    feature("closest hit", &["*_closest_hit"]),
    feature("any hit", &["*_any_hit"]),
    feature("multi-hit", &["Traversal"]),
    feature("cost", &["Cost", "CountedHit", "*_closest_hit_with_cost"]),
    feature("surface", &["geometry/surface.rs"]),
    feature("coordinates", &["Surface_uv"]),
    feature("material", &["bsdf/frame.rs", "bsdf/material.rs", "bsdf/mod.rs", "shading/scene.rs"]),
    feature("Lambert", &["bsdf/diffuse.rs", "Lambert"]),
    feature("microfacets", &["bsdf/microfacet.rs", "bsdf/fresnel.rs"]),
    feature("conductor", &["bsdf/conductor.rs", "bsdf/albedo.rs", "Reflection"]),
    feature("dielectric", &["bsdf/dielectric.rs", "FresnelSplit"]),
    feature("lights", &["light/mod.rs", "light/lights/*"]),
    feature("kinds of lights", &["light/any.rs", "AnyLight"]),
    feature("point light", &["light/punctual.rs", "PointLight"]),
    feature("directional light", &["light/directional.rs", "lights_distant"]),
    feature("area light", &["light/area.rs", "light/shapes.rs", "light/triangle.rs"]),
    feature("light table", &["sampling/table.rs", "LightChoice"]),
    feature("environment", &["light/environment.rs", "*_texels"]),
    feature("occlusion", &["integrators/occlusion.rs"]),
    feature("direct light", &["integrators/direct.rs", "sampling/heuristics.rs"]),
    feature("path", &["integrators/path_tracing.rs", "PathLimits"]),
    feature("roulette", &["survival"]),
    feature("holes", &["integrators/masks.rs"]),
    feature("channels", &["Luminous_albedo", "StoredPathSample"]),
    feature("samples", &["sampling/sampler.rs", "sampling/hash.rs", "sampling/rng.rs", "Sampler"]),
    feature("directions", &["sampling/warp/*", "sampling/frame.rs"]),
    feature("volume", &["volume/integrator.rs", "volume/light.rs", "VolumeLight"]),
    feature("grid", &["volume/voxel.rs", "volume/sample.rs", "*_voxels"]),
    feature("transfer function", &["volume/transfer.rs", "*_knots", "*_bins", "TransferKnot"]),
    feature("2-D transfer function", &["volume/volume_2d.rs", "volume_samples"]),
    feature("empty space", &["volume/walk.rs", "*_majorants", "CellWalk"]),
    feature("steps", &["volume/march.rs", "Euler"]),
    feature("exact cells", &["volume/exact.rs", "volume/cubic.rs", "ExactCell"]),
    feature("cut", &["volume/cut.rs", "bvh/hits.rs", "Cut"]),
    feature(
        "fog",
        &["integrators/media.rs", "volume/medium.rs", "volume/phase.rs", "volume/tracking.rs"],
    ),
    feature("texture", &["texture/*"]),
    feature("2-D texture", &["tex2", "filter2"]),
    feature("3-D texture", &["tex3", "filter3"]),
    feature("nearest", &["nearest_texel"]),
    feature("linear", &["linear_image", "linear_row", "Pair"]),
    feature("cubic", &["cubic_image", "cubic_row", "Weights"]),
    feature("repeat", &["return c - floor(c);", "select(i, i + n, "]),
    feature("mirror", &["2i * n - 1i - i"]),
    feature("clamp", &["select(i, 0i, "]),
    feature("border", &["*_border"]),
    feature("sRGB", &["texture/color.rs", "srgb_to_linear"]),
    feature("camera", &["camera/*", "render/shot.rs"]),
    feature(
        "film",
        &["render/moments.rs", "Moments", "render/pixel_sampler.rs", "render/radiance.rs"],
    ),
    feature(
        "adaptive samples",
        &["render/allocation.rs", "samples_of_blocks", "columns_of_blocks"],
    ),
];

/// Files whose kernels several features have in common: rays, boxes, points, elementary functions.
pub(crate) const CORE: &[&str] = &[
    "machine/*",
    "bvh/contract.rs",
    "geometry/aabb.rs",
    "geometry/affine.rs",
    "geometry/edges.rs",
    "geometry/hit.rs",
    "geometry/near.rs",
    "geometry/origin.rs",
    "geometry/ray.rs",
    "geometry/slabs.rs",
    "math/elementary/*",
    "shading/surface.rs",
];
