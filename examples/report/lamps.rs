//! One of many lamps, chosen in several ways: the sum over all of them in `f64`.

use raydsl::kernel;
use raydsl::light::{LightSample, Lights, PointLight};
use raydsl::prelude::*;
use raydsl_report::Missing;
use raydsl_report::work_precision::{Backend, Case, Estimates, Method, Reference, Run, Work};

/// Names of the cases, with the number of lamps: no power of two, of which Sobol points would choose each
/// equally often.
pub(crate) const NAMES: [(&str, u32); 2] = [("lamps-15", 15), ("lamps-1000", 1000)];

/// Names of the methods: any lamp, one by its power, one by a tree, and the sum of all.
pub(crate) const METHODS: [&str; 4] = ["uniform", "power", "tree", "each"];

/// The floor's edge.
const SIDE: f32 = 16.0;

/// Lamps above the floor, some a hundred times as bright as others.
fn lamps(count: u32) -> Vec<PointLight> {
    let lamp = |i: u32| {
        let mut rng = Rng::new(uvec2(i, count), 0, 3);
        let (place, height) = (rng.next_2d(), rng.next_f32());
        let position = vec3(SIDE * (place.x - 0.5), SIDE * (place.y - 0.5), 0.5 + height);
        // Fifteen lamps have as much light as a thousand.
        let intensity = Vec3::splat(100f32.powf(rng.next_f32()) / count as f32);
        PointLight { position, intensity }
    };
    (0..count).map(lamp).collect()
}

/// The irradiance of a sample.
#[kernel]
fn arriving(light: LightSample) -> f32 {
    if light.pdf > 0.0 { light.light.x * max(light.wi.z, 0.0) / light.pdf } else { 0.0 }
}

/// The place of the floor that a ray from above meets.
#[kernel]
fn floor(ray: Ray) -> SurfacePoint {
    let position = vec3(ray.origin.x, ray.origin.y, 0.0);
    SurfacePoint { position, normal: vec3(0.0, 0.0, 1.0), error: 0.0 }
}

type All = Lights<'static, PointLight>;

fn camera() -> Orthographic {
    Orthographic::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, SIDE)
}

/// The light of all lamps.
fn sum(run: &Run<'_>, lights: &All) -> Result<Estimates, Missing> {
    let kernel = kernel!(|ray: Ray| {
        let mut light = 0.0;
        for i in 0..lights.count() {
            light += arriving(lights.sample_light(i, floor(ray), vec2(0.5, 0.5)));
        }
        light
    });
    run.with_samples(1).centers(&camera(), &kernel)
}

fn estimate(run: &Run<'_>, by_power: &All, by_tree: &All) -> Result<Estimates, Missing> {
    match run.method().name() {
        "each" => sum(run, by_power),
        "uniform" => {
            let kernel = kernel!(|ray: Ray, sampler: Sampler| {
                let mut sampler = sampler;
                let count = by_power.count();
                let number = min((sampler.next_1d() * count as f32) as u32, count - 1);
                let light = by_power.sample_light(number, floor(ray), sampler.next_2d());
                arriving(light) * count as f32
            });
            run.centers(&camera(), &kernel)
        }
        name => {
            let lights = if name == "tree" { by_tree } else { by_power };
            let kernel = kernel!(|ray: Ray, sampler: Sampler| {
                let mut sampler = sampler;
                let (u, v) = (sampler.next_2d(), sampler.next_1d());
                arriving(lights.sample(floor(ray), vec3(u.x, u.y, v)))
            });
            run.centers(&camera(), &kernel)
        }
    }
}

/// The cases, of pictures with `edge` pixels along each edge.
pub(crate) fn case(name: &str, edge: u32) -> Result<Case<'static>, Box<dyn core::error::Error>> {
    let known = NAMES.iter().find(|n| n.0 == name);
    let (name, count) = *known.ok_or_else(|| format!("there are no lamps `{name}`"))?;
    let list: &'static [PointLight] = lamps(count).leak();
    let bounds = Aabb { min: vec3(-SIDE, -SIDE, 0.0), max: vec3(SIDE, SIDE, 2.0) };
    let by_power: &'static All = Box::leak(Box::new(Lights::new(list, bounds)?));
    let by_tree: &'static All = Box::leak(Box::new(Lights::new(list, bounds)?.with_tree()?));
    let method = Method::from("each");
    let run = Run::new(&method, Backend::F64, 1).sized(edge, edge);
    let exact = sum(&run, by_power).map_err(|missing| missing.to_string())?;
    let reference = Reference::f64(exact.values, 1e-9);
    let case = Case::new(name, reference, move |run| estimate(run, by_power, by_tree));
    // Points that choose a lamp have as many edges as lamps: theory says nothing of their constants.
    let case = case.counted(|_| Work::NOTHING).values(&[4, 16, 64, 256, 1024, 4096]);
    let case = case.family("many-lights");
    Ok(METHODS.iter().fold(case, |case, name| case.method(*name, None)))
}
