//! Light that is scattered several times, by paths that find it in several ways: no closed form, so
//! two halves of a reference.

use core::error::Error;
use std::time::Instant;

use raydsl::bsdf::{Conductor, F82, Lambert, Luminous, NO_LIGHT};
use raydsl::integrators::{LightSampling, PathLimits, PathOptions, path_with};
use raydsl::light::{AreaLight, Lights};
use raydsl::prelude::*;
use raydsl_report::Missing;
use raydsl_report::work_precision::{Case, Estimates, Method, Order, Run};

use crate::cloud::halves;
use crate::cornell::{self, Wall};

/// Names of the cases.
pub(crate) const NAMES: [&str; 2] = ["path-cornell", "path-plates"];

/// GGX parameters of the plates, from the nearest to the farthest.
const ALPHAS: [f32; 4] = [0.25, 0.1, 0.04, 0.015];

/// Edges of the square lamps above the plates, which have the same power.
const LAMPS: [f32; 4] = [0.05, 0.15, 0.4, 0.8];

/// What is seen, lit and from where.
struct View {
    tree: &'static Bvh<'static, Wall>,
    lights: Lights<'static, AreaLight<Triangle>>,
    /// GGX parameters of metal plates by primitive; the Cornell box has none.
    alphas: &'static [f32],
    camera: Pinhole,
    limits: PathLimits,
}

/// How a method finds light: by its name, if it is no placement of samples.
fn options(method: &Method) -> PathOptions {
    let lights = match method.name() {
        "lights" => LightSampling::LightsAlone,
        "hits" => LightSampling::HitsAlone,
        _ => LightSampling::Weighted,
    };
    PathOptions { lights, ..PathOptions::new() }
}

impl View {
    fn new(
        walls: Vec<Wall>,
        lamps: Vec<AreaLight<Triangle>>,
        alphas: Vec<f32>,
        camera: Pinhole,
        limits: PathLimits,
    ) -> Result<Self, Box<dyn Error>> {
        let tree: &'static Bvh<'static, Wall> = Box::leak(Box::new(Bvh::build(walls.leak())?));
        let lights = Lights::new(lamps.leak(), tree.bounds())?;
        Ok(Self { tree, lights, alphas: alphas.leak(), camera, limits })
    }

    /// The diffuse box.
    fn diffuse(&self, run: &Run<'_>) -> Result<Estimates, Missing> {
        let (tree, lights, limits) = (self.tree, &self.lights, self.limits);
        let options = options(run.method());
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            let surface = |hit: Hit, _point: ShadingPoint| tree.primitive(hit).material();
            path_with::<_, _, Luminous<Lambert>>(
                tree,
                surface,
                lights,
                host(options),
                limits,
                ray,
                sampler,
            )
            .color
        });
        run.film(&self.camera, &kernel)
    }

    /// The metal plates.
    fn glossy(&self, run: &Run<'_>) -> Result<Estimates, Missing> {
        let (tree, lights, alphas, limits) = (self.tree, &self.lights, self.alphas, self.limits);
        let options = options(run.method());
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            let surface = |hit: Hit, _point: ShadingPoint| {
                let wall = tree.primitive(hit);
                let fresnel = F82 { normal: wall.color, tint: vec3(1.0, 1.0, 1.0) };
                let bsdf = Conductor::<F82> { fresnel, alpha: alphas[hit.prim_id as usize] };
                Luminous::<Conductor<F82>> { bsdf, light: wall.light }
            };
            path_with::<_, _, Luminous<Conductor<F82>>>(
                tree,
                surface,
                lights,
                host(options),
                limits,
                ray,
                sampler,
            )
            .color
        });
        run.film(&self.camera, &kernel)
    }

    fn estimate(&self, run: &Run<'_>) -> Result<Estimates, Missing> {
        if self.alphas.is_empty() { self.diffuse(run) } else { self.glossy(run) }
    }
}

/// Adds a square as two triangles.
fn add_square(
    walls: &mut Vec<Wall>,
    center: Vec3,
    [x, y]: [Vec3; 2],
    color: Vec3,
    light: Option<u32>,
) {
    let [a, b, c, d] = [center - x - y, center + x - y, center + x + y, center - x + y];
    for (k, [v1, v2]) in [[b, c], [c, d]].into_iter().enumerate() {
        let light = light.map_or(NO_LIGHT, |light| light + k as u32);
        walls.push(Wall { v0: a, v1, v2, color, light });
    }
}

/// Plates that each reflect the middle of a row of lamps to the eye. (After Veach and Guibas,
/// "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995.)
fn plates() -> Result<View, Box<dyn Error>> {
    let (eye, row) = (vec3(0.0, -4.0, 1.5), vec3(0.0, 2.5, 2.0));
    let (mut walls, mut lamps, mut alphas) = (Vec::new(), Vec::new(), Vec::new());
    for (i, alpha) in (0u16..).zip(ALPHAS) {
        let center = vec3(0.0, -1.2 + 0.8 * f32::from(i), 0.15 * f32::from(i * i) * 0.5);
        let normal = ((eye - center).normalize() + (row - center).normalize()).normalize();
        let axes = [Vec3::X * 1.5, normal.cross(Vec3::X) * 0.3];
        add_square(&mut walls, center, axes, Vec3::splat(0.8), None);
        alphas.extend([alpha; 2]);
    }
    for (i, edge) in (0u16..).zip(LAMPS) {
        let center = row + Vec3::X * (f32::from(i) * 0.8 - 1.2);
        let normal = -row.normalize();
        let x = Vec3::X * (0.5 * edge);
        let first = walls.len();
        add_square(&mut walls, center, [x, normal.cross(x)], Vec3::ZERO, Some(lamps.len() as u32));
        alphas.extend([1.0; 2]);
        lamps.extend(walls[first..].iter().map(|w| AreaLight::<Triangle> {
            shape: Triangle { v0: w.v0, v1: w.v1, v2: w.v2 },
            radiance: Vec3::splat(0.1 / (edge * edge)),
            is_two_sided: true,
        }));
    }
    let camera = Pinhole::new(eye, vec3(0.0, 0.2, 0.1), Vec3::Z, 0.5);
    View::new(walls, lamps, alphas, camera, PathLimits::new(1))
}

fn cornell_box() -> Result<View, Box<dyn Error>> {
    let walls = cornell::walls();
    let lamps = cornell::lamps(&walls);
    View::new(walls, lamps, Vec::new(), cornell::camera(), PathLimits::new(4))
}

/// The case of a name; each half of its reference has so many samples of each pixel.
pub(crate) fn case(name: &str, samples: u32) -> Result<Case<'static>, Box<dyn Error>> {
    let start = Instant::now();
    let view = if name == "path-plates" { plates()? } else { cornell_box()? };
    let (build, view): (_, &'static View) = (start.elapsed(), Box::leak(Box::new(view)));
    let reference = halves(samples, |run| view.estimate(run))?;
    // Of many dimensions, edges in most of them: theory knows the order of random samples alone.
    Ok(Case::new(name, reference, move |run| view.estimate(run))
        .built_in(build)
        .values(&[1, 4, 16, 64, 256, 1024])
        .family("paths")
        .method(SampleMethod::Random, Some(Order::RANDOM))
        .method(SampleMethod::Stratified, None)
        .method(SampleMethod::Sobol, None)
        .method("lights", None)
        .method("hits", None))
}
