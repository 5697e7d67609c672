//! A picture of waves by filters between texels: a closed form, and a knob of texels.

use core::f64::consts::TAU;

use raydsl::prelude::*;
use raydsl::texture::Filter;
use raydsl_report::Missing;
use raydsl_report::work_precision::{Case, Estimates, Order, Reference, Run, Work};

/// Names and orders, which are those of the polynomials that each reproduces. (Thévenaz, Blu and Unser,
/// "Interpolation Revisited", 2000: a B-spline of degree 3 through the texels has the order 4, Keys'
/// spline 3, and without its prefilter the B-spline smooths: 2.)
pub(crate) const FILTERS: [(&str, f64); 5] = [
    ("nearest", -1.0),
    ("linear", -2.0),
    ("bspline", -2.0),
    ("catmull-rom", -3.0),
    ("interpolating", -4.0),
];

/// Look-ups of each place, so that the time of a run is not that of its beginning.
const LOOK_UPS: u32 = 64;

/// Waves of at most three periods along an axis: more than six texels can show all of them.
fn waves(u: f64, v: f64) -> f64 {
    let wave = |along: f64, across: f64, turn: f64| (TAU * (along * u + across * v + turn)).sin();
    0.5 + 0.2 * wave(1.0, 1.0, 0.1) + 0.15 * wave(2.0, -1.0, 0.35) + 0.1 * wave(-1.0, 3.0, 0.8)
}

/// Where a pixel looks: the factors of its place in the picture, which turn it a little, so that pixels
/// are everywhere between texels. For pictures of a power of two they lose no bit of `f32`.
const TURN: [[f32; 2]; 2] = [[1061.0 / 1024.0, 37.0 / 1024.0], [-53.0 / 1024.0, 1031.0 / 1024.0]];

fn config(filter: Filter) -> TextureConfig {
    TextureConfig::new().filter(filter)
}

/// A texture of so many texels along each edge, which repeats.
fn texture(method: &str, side: u32) -> Result<Texture2<'static, f32>, Missing> {
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
    let texels: Vec<f32> =
        (0..side * side).map(|i| waves(middle(i % side), middle(i / side)) as f32).collect();
    let filter = match method {
        "nearest" => Filter::Nearest,
        "linear" => Filter::Linear,
        "bspline" => Filter::BSpline,
        "catmull-rom" => Filter::CatmullRom,
        // The filter of one that interpolates is chosen below.
        _ => Filter::Linear,
    };
    let refused = |e: raydsl::texture::TextureError| Missing::Refused(e.to_string());
    let plain = Texture2::new(texels, [side, side], config(filter)).map_err(refused)?;
    if method == "interpolating" { plain.interpolating().map_err(refused) } else { Ok(plain) }
}

fn camera() -> Orthographic {
    Orthographic::new(vec3(0.5, 0.5, 4.0), vec3(0.5, 0.5, 0.0), Vec3::Y, 1.0)
}

/// Making the texture is part of a run: it is what more texels cost.
fn estimate(run: &Run<'_>) -> Result<Estimates, Missing> {
    let texture = texture(run.method().name(), run.knob())?;
    let [along, across] = TURN.map(|row| vec2(row[0], row[1]));
    let kernel = kernel!(|ray: Ray| {
        let place = vec2(ray.origin.x, ray.origin.y);
        tex2(&texture, vec2(along.dot(place), across.dot(place)))
    });
    run.with_samples(LOOK_UPS).centers(&camera(), &kernel)
}

/// The case, of a picture with `edge` pixels along each edge.
pub(crate) fn case(edge: u32) -> Case<'static> {
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(edge);
    let exact = (0..edge * edge).map(|i| {
        let (x, y) = (middle(i % edge), middle(i / edge));
        let [u, v] = TURN.map(|row| f64::from(row[0]) * x + f64::from(row[1]) * y);
        waves(u, v)
    });
    let reference = Reference::closed_forms(exact.collect::<Vec<f64>>());
    let case = Case::new("filters", reference, estimate).knob("texels");
    let case = case.values(&[8, 16, 32, 64, 128, 256]).family("filters");
    let case = case.counted(|run| Work {
        texture_fetches: Some(u64::from(LOOK_UPS * run.size().0 * run.size().1)),
        ..Work::NOTHING
    });
    FILTERS
        .iter()
        .fold(case, |case, (name, order)| case.method(*name, Some(Order::near(*order, 0.25))))
}
