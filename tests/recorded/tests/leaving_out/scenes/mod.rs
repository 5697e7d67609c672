//! The scenes of the matrix: the programs of small kernels, each with the features that it uses.

use std::error::Error;

use raydsl::kernel;
use raydsl::machine::Recording;
use raydsl::prelude::*;

/// Records a `#[kernel] fn` alone, whose packets nobody compiles: its captures, and its parameters.
macro_rules! recorded {
    ($kernel:ident($($capture:ident),*)($($arg:ident: $ty:ty),+) -> $out:ty) => {
        Recording::batch::<($($ty,)+), $out>(Arithmetic::Strict, |m, ($($arg,)+)| {
            use raydsl::__private::{Capture, Recorder};
            // The function itself runs nowhere here.
            let _ = $kernel;
            $(let $capture = Capture::<Recorder>::capture(&$capture, m, stringify!($capture));)*
            $kernel::on(m, $($capture,)* $($arg),+)
        })
    };
}

mod fields;
mod films;
mod lit;
mod primitives;

use fields::{cubic, cut, linear, nearest, repeated, solid, volume, volume_2d};
pub(crate) use fields::{grid, marched, transfer};
use films::{adaptive, film, frame};
use lit::{
    channels, diffuse, direct, fog, glass, holes, metal, mirrors, occlusion, without_roulette,
};
pub(crate) use lit::{diffuse_path, lit_triangles, open_sky};
pub(crate) use primitives::{Face, colors};
use primitives::{coordinates, cost, depth, few, instances, kinds, layers, points, wide};

/// What may go wrong while a scene is made.
type Made = Result<Recording, Box<dyn Error>>;

/// A scene: its name, what it uses, and how it is made.
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    /// Names of its features, with commas between them.
    uses: &'static str,
    pub(crate) record: fn() -> Made,
}

impl Scene {
    /// Returns the names of its features.
    pub(crate) fn features(&self) -> impl Iterator<Item = &'static str> {
        self.uses.split(", ").filter(|name| !name.is_empty())
    }

    /// Returns whether it has a feature.
    pub(crate) fn uses(&self, feature: &str) -> bool {
        self.features().any(|name| name == feature)
    }
}

/// Returns all scenes: a new one is one line here, and its function below.
pub(crate) fn all() -> Vec<Scene> {
    let scene = |name, uses, record| Scene { name, uses, record };
    vec![
        scene("plain numbers", "", plain),
        scene("points", "sphere, tree, closest hit", points),
        scene("depth", "triangle, tree, closest hit", depth),
        scene("wide tree", "triangle, tree, wide tree, closest hit", wide),
        scene("few triangles", "triangle, any hit", few),
        scene("instances", "triangle, tree, instances", instances),
        scene("kinds", "sphere, disk, tree, closest hit", kinds),
        scene("layers", "sphere, tree, multi-hit", layers),
        scene("cost", "triangle, tree, cost", cost),
        scene("coordinates", "triangle, tree, closest hit, coordinates", coordinates),
        scene(
            "occlusion",
            "triangle, tree, closest hit, any hit, surface, occlusion, samples, directions",
            occlusion,
        ),
        scene(
            "direct light",
            "sphere, tree, closest hit, any hit, surface, material, Lambert, direct light, lights, \
             kinds of lights, point light, directional light, samples, directions",
            direct,
        ),
        scene(
            "mirrors",
            "sphere, tree, closest hit, any hit, surface, material, Lambert, direct light, lights, \
             point light, samples, directions",
            mirrors,
        ),
        scene(
            "diffuse path",
            "triangle, tree, closest hit, any hit, surface, material, Lambert, direct light, lights, \
             area light, light table, path, roulette, samples, directions",
            diffuse,
        ),
        scene(
            "path without roulette",
            "triangle, tree, closest hit, any hit, surface, material, Lambert, direct light, lights, \
             area light, light table, path, samples, directions",
            without_roulette,
        ),
        // Coordinates of candidates are not left out: see the end of the book's page.
        scene(
            "path with holes",
            "triangle, tree, multi-hit, surface, coordinates, material, Lambert, direct light, lights, \
             area light, light table, path, roulette, holes, samples, directions",
            holes,
        ),
        scene(
            "channels",
            "triangle, tree, closest hit, any hit, surface, material, Lambert, direct light, lights, \
             area light, light table, path, roulette, channels, samples, directions",
            channels,
        ),
        scene(
            "fog",
            "triangle, tree, closest hit, any hit, surface, material, Lambert, direct light, lights, \
             area light, light table, path, roulette, fog, samples, directions",
            fog,
        ),
        scene(
            "metal",
            "sphere, tree, closest hit, any hit, surface, material, Lambert, microfacets, conductor, \
             direct light, lights, environment, path, roulette, samples, directions",
            metal,
        ),
        scene(
            "glass",
            "sphere, tree, closest hit, any hit, surface, material, Lambert, microfacets, \
             dielectric, direct light, lights, environment, path, roulette, samples, directions",
            glass,
        ),
        scene("volume", "volume, grid, transfer function, empty space, steps", volume),
        scene("2-D volume", "volume, grid, 2-D transfer function, empty space, steps", volume_2d),
        scene(
            "cut volume",
            "volume, grid, transfer function, empty space, exact cells, cut, sphere, surface",
            cut,
        ),
        scene("nearest texels", "texture, 2-D texture, nearest, repeat", nearest),
        scene("repeated texels", "texture, 2-D texture, linear, repeat", repeated),
        scene("linear texels", "texture, 2-D texture, linear, clamp, sRGB", linear),
        scene("cubic texels", "texture, 2-D texture, cubic, border", cubic),
        scene("3-D texels", "texture, 3-D texture, linear, mirror", solid),
        scene("frame", "camera", frame),
        scene("film", "camera, film, samples", film),
        scene("adaptive film", "camera, film, adaptive samples, samples", adaptive),
    ]
}

#[kernel]
fn line(slope: f32, x: f32) -> f32 {
    x * slope + 1.0
}

fn plain() -> Made {
    let slope = 0.5f32;
    Ok(recorded!(line(slope)(x: f32) -> f32))
}
