//! A texture, and a lamp that shows one: closed forms.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::texture::Filter;
use raydsl_report::work_precision::{Case, Order, Reference, Work};

use crate::light::from_lamp;
use crate::visibility::SAMPLES;

/// A dark surface with some bright places.
const TEXELS: [f32; 20] = [
    0.1, 0.2, 0.1, 4.0, 0.3, //
    0.1, 0.9, 0.5, 0.2, 0.1, //
    0.1, 2.5, 0.3, 0.1, 0.6, //
    0.2, 0.1, 0.1, 0.7, 8.0,
];
const SIZE: [u32; 2] = [5, 4];

/// The texture's value somewhere; or what arrives at the origin, whose normal is +z, from that
/// place of a lamp, the square from -1 to 1 in the plane z = 1.
#[kernel]
pub(crate) fn textured(
    texture: &Texture2<'_, f32>,
    #[host] is_lamp: bool,
    sampler: Sampler,
) -> f32 {
    let mut sampler = sampler;
    let u = sampler.next_2d();
    let value = tex2(texture, u);
    if is_lamp {
        let point = vec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 1.0);
        value * from_lamp(point, vec3(0.0, 0.0, 1.0), 4.0, true)
    } else {
        value
    }
}

/// The texture, which repeats and is linear between the middles of texels, or has steps.
pub(crate) fn texture(filter: Filter) -> Texture2<'static, f32> {
    let config = TextureConfig::new().filter(filter);
    Texture2::new(&TEXELS, SIZE, config).expect("as many texels as the size says")
}

/// Linear weights of the texels around a place add up to 1, and each texel has the same share.
fn mean() -> f64 {
    TEXELS.iter().map(|&t| f64::from(t)).sum::<f64>() / TEXELS.len() as f64
}

/// Each texel is a rectangle that sends the light of four with a corner above the origin. (Howell,
/// Mengüç, Daun and Siegel, "Thermal Radiation Heat Transfer", configuration factor C-11.)
fn from_texels() -> f64 {
    let of_corner = |x: f64, y: f64| {
        let half = |a: f64, b: f64| a / a.hypot(1.0) * (b / a.hypot(1.0)).atan();
        0.5 * (half(x, y) + half(y, x))
    };
    let [columns, rows] = SIZE;
    let edge = |i: u32, count: u32| 2.0 * f64::from(i) / f64::from(count) - 1.0;
    let texels = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))).zip(TEXELS);
    let light = texels.map(|((i, j), texel)| {
        let ([x0, x1], [y0, y1]) =
            ([i, i + 1].map(|i| edge(i, columns)), [j, j + 1].map(|j| edge(j, rows)));
        let all = of_corner(x1, y1) + of_corner(x0, y0) - of_corner(x0, y1) - of_corner(x1, y0);
        f64::from(texel) * all
    });
    light.sum()
}

/// Every sample looks the texture up once, and sends no ray.
fn case(name: &str, exact: f64, is_lamp: bool, filter: Filter) -> Case<'static> {
    let texture = texture(filter);
    Case::new(name, Reference::closed_form(exact), move |run| {
        let texture = &texture;
        run.integral(&kernel!(|_ray: Ray, sampler: Sampler| {
            textured(texture, host(is_lamp), sampler)
        }))
    })
    .counted(|run| run.integral_work(|_| Work { texture_fetches: Some(1), ..Work::NOTHING }))
    .values(&SAMPLES)
    .family("smooth")
    .method(SampleMethod::Random, Some(Order::RANDOM))
}

/// Both of them.
pub(crate) fn cases() -> Vec<Case<'static>> {
    // Kinks, but no steps, along the axes: as for what is smooth, Sobol points all but.
    let linear = case("texture", mean(), false, Filter::Linear)
        .method(SampleMethod::Stratified, Some(Order::near(-1.0, 0.1)))
        .method(SampleMethod::Sobol, Some(Order::near(-1.3, 0.1)));
    // Steps: only the strata that they cross do not converge as where it is smooth.
    let steps = case("textured-lamp", from_texels(), true, Filter::Nearest)
        .method(SampleMethod::Stratified, Some(Order::at_most(-0.7)))
        .method(SampleMethod::Sobol, Some(Order::at_most(-0.9)));
    vec![linear, steps]
}
