//! Light of one lamp that a metal reflects, by samples of the metal, of the lamp, or of both: two
//! halves of a reference.

use raydsl::bsdf::{Bsdf, BsdfSample, Conductor, F82};
use raydsl::kernel;
use raydsl::light::{AreaLight, Light, LightSample, RectangleShape};
use raydsl::prelude::*;
use raydsl_report::Missing;
use raydsl_report::work_precision::{Case, Estimates, Run, Work};

use crate::cloud::halves;

/// Names of the cases, GGX parameters of the metal and edges of the square lamp: one that a sample of
/// the metal rarely meets, one that it nearly always does, and one in between.
pub(crate) const SCENES: [(&str, f32, f32); 3] =
    [("small-lamp", 0.3, 0.1), ("large-lamp", 0.02, 3.0), ("both-alike", 0.2, 1.0)];

/// Names of the methods.
pub(crate) const METHODS: [&str; 4] = ["bsdf", "light", "balance", "power"];

type Metal = Conductor<F82>;
type Lamp = AreaLight<RectangleShape>;

/// The lamp, in the plane z = 1 over the plane z = 0 of the metal, facing down.
fn lamp(edge: f32) -> Lamp {
    let half = 0.5 * edge;
    let shape = RectangleShape {
        corner: vec3(-half, -half, 1.0),
        u_edge: Vec3::Y * edge,
        v_edge: Vec3::X * edge,
    };
    AreaLight { shape, radiance: Vec3::splat(1.0 / (edge * edge)), is_two_sided: false }
}

fn metal(alpha: f32) -> Metal {
    let fresnel = F82 { normal: Vec3::splat(0.8), tint: Vec3::ONE };
    Conductor { fresnel, alpha }
}

/// The weight of a sample with one density, where another way of sampling has `rival`.
#[kernel]
fn weight(#[host] method: u32, pdf: f32, rival: f32) -> f32 {
    match method {
        2 => balance_heuristic(1.0, pdf, 1.0, rival),
        3 => power_heuristic(1.0, pdf, 1.0, rival),
        _ => 1.0,
    }
}

/// The light that the metal at `point` sends to `wo`, by one sample of each way that `method`, a place
/// in [`METHODS`], has. The frame of the metal is that of the world.
#[kernel]
fn reflected(
    #[host] method: u32,
    metal: Conductor<F82>,
    lamp: AreaLight<RectangleShape>,
    point: SurfacePoint,
    wo: Vec3,
    sampler: Sampler,
) -> f32 {
    let mut sampler = sampler;
    let (u, third, v) = (sampler.next_2d(), sampler.next_1d(), sampler.next_2d());
    let mut light = 0.0;
    if method != 1 {
        let chosen: BsdfSample = metal.sample(wo, vec3(u.x, u.y, third));
        if chosen.wi.z > 0.0 {
            let shape = lamp.shape;
            let position = point.position + chosen.wi * (1.0 / chosen.wi.z);
            let aside = position - shape.corner;
            let (x, y) = (aside.dot(shape.v_edge), aside.dot(shape.u_edge));
            let most = shape.u_edge.dot(shape.u_edge);
            if x >= 0.0 && x <= most && y >= 0.0 && y <= most {
                let at = SurfacePoint { position, normal: vec3(0.0, 0.0, -1.0), error: 0.0 };
                let rival = lamp.pdf(point.position, at);
                light += chosen.weight.x * lamp.radiance.x * weight(method, chosen.pdf, rival);
            }
        }
    }
    if method != 0 {
        let chosen: LightSample = lamp.sample(point.position, v);
        if chosen.pdf > 0.0 {
            let rival = metal.pdf(wo, chosen.wi);
            let scattered = metal.eval(wo, chosen.wi).x * chosen.light.x;
            light += scattered / chosen.pdf * weight(method, chosen.pdf, rival);
        }
    }
    light
}

/// What a camera sees of a square of the metal.
fn estimate(run: &Run<'_>, alpha: f32, edge: f32) -> Result<Estimates, Missing> {
    let (metal, lamp) = (metal(alpha), lamp(edge));
    // A reference's method is none of these: it takes the last.
    let method = METHODS.iter().position(|m| *m == run.method().name()).unwrap_or(3) as u32;
    let camera = Pinhole::new(vec3(0.0, -3.0, 3.0), Vec3::ZERO, Vec3::Z, 0.25);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let position = ray.at(-ray.origin.z / ray.direction.z);
        let point = SurfacePoint { position, normal: vec3(0.0, 0.0, 1.0), error: 0.0 };
        let wo = -ray.direction.normalize();
        reflected(host(method), metal, lamp, point, wo, sampler)
    });
    run.film(&camera, &kernel)
}

/// The cases; each half of a reference has so many samples of each pixel.
pub(crate) fn case(name: &str, samples: u32) -> Result<Case<'static>, String> {
    let scene = SCENES.iter().find(|scene| scene.0 == name);
    let (name, alpha, edge) = *scene.ok_or_else(|| format!("there is no lamp `{name}`"))?;
    let reference = halves(samples, |run| estimate(run, alpha, edge))?;
    let case = Case::new(name, reference, move |run| estimate(run, alpha, edge));
    let case = case.counted(|_| Work::NOTHING).values(&[1, 4, 16, 64, 256, 1024, 4096]);
    let case = case.family("strategies");
    Ok(METHODS.iter().fold(case, |case, name| case.method(*name, None)))
}
