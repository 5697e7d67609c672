//! Light that arrives, and other smooth integrals: closed forms.

use core::f32::consts::PI;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_report::work_precision::{Case, Order, Reference, Work};

use crate::visibility::SAMPLES;

/// Light of unit radiance through a point of a lamp, per density of 1 over `area`.
#[kernel]
pub(crate) fn from_lamp(point: Vec3, normal: Vec3, area: f32, has_cosine: bool) -> f32 {
    let square = point.dot(point);
    let way = point / square.sqrt();
    let cosine = if has_cosine { way.z } else { 1.0 };
    area * cosine * normal.dot(way).abs() / square
}

/// At the origin, whose normal is +z, of a ball, a square or a triangle.
#[kernel]
fn lamps(#[host] which: u32, u: Vec2) -> f32 {
    match which {
        0 => {
            // A ball of radius 0.5 around (1, 0, 2), radiance 10, by the cone in which it is seen.
            let height = one_minus_cos(0.5 / 5.0_f32.sqrt());
            let axis = vec3(1.0, 0.0, 2.0).normalize();
            let way = Frame::around(axis).to_world(sample_cone(u, height));
            10.0 * way.z / cone_pdf(height)
        }
        1 => {
            let point = vec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 1.0);
            from_lamp(point, vec3(0.0, 0.0, 1.0), 4.0, true)
        }
        _ => {
            let (a, b, c) = (vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 2.0), vec3(-1.0, -0.5, 1.5));
            let across = (b - a).cross(c - a);
            let weights = sample_triangle(u);
            let point = a * (1.0 - weights.x - weights.y) + b * weights.x + c * weights.y;
            let area = across.length();
            from_lamp(point, across / area, 0.5 * area, which == 2)
        }
    }
}

/// Means over a patch, a ball's disk, the sky and the square.
#[kernel]
fn means(#[host] which: u32, u: Vec2) -> f32 {
    match which {
        4 => {
            let way = vec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 1.5);
            1.5 / (way.dot(way) * way.length())
        }
        5..=7 => {
            // The sine and the cosine of the phase angle: 0, 60 and 90 degrees.
            let sine = if which == 5 {
                0.0
            } else if which == 6 {
                0.75_f32.sqrt()
            } else {
                1.0
            };
            let cosine = if which == 5 {
                1.0
            } else if which == 6 {
                0.5
            } else {
                0.0
            };
            let p = sample_concentric_disk(u);
            let z = max(1.0 - p.dot(p), 0.0).sqrt();
            max(p.x * sine + z * cosine, 0.0)
        }
        8 => PI * (1.0 + 2.0 * sample_cosine_hemisphere(u).z) / 3.0,
        9 => sample_cosine_hemisphere(u).z,
        10 => {
            let cosine = sample_cosine_hemisphere(u).z;
            cosine * cosine
        }
        _ => exp(-u.x * u.y),
    }
}

#[kernel]
pub(crate) fn light(#[host] which: u32, sampler: Sampler) -> f32 {
    let mut sampler = sampler;
    let u = sampler.next_2d();
    if which < 4 { lamps(which, u) } else { means(which, u) }
}

// Orders of Sobol points, n of them in cells of the width n^-1/2; stratified samples have -1 in all
// of these. (The first: Owen, "Scrambled Net Variance for Integrals of Smooth Functions", 1997.)

/// Smooth in the square: -1.5 but for a power of log n, which makes it flatter at these n.
const SMOOTH: Order = Order::near(-1.4, 0.1);
/// With a kink aslant, as the triangle's warp has: the n^1/2 cells that it crosses have errors of
/// the first order, each n^-3/2, and so together n^-5/4.
const KINKED: Order = Order::near(-1.25, 0.05);
/// The disk's warp has kinks along its diagonals; besides the hemisphere's height has an infinite
/// slope at the horizon, and light an edge between day and night that is a kink. If cells were all
/// that Sobol points had, the horizon would hold them to -1.
const WARPED: Order = Order::near(-1.2, 0.1);

fn case(name: &str, which: u32, exact: f64, sobol: Order) -> Case<'static> {
    Case::new(name, Reference::closed_form(exact), move |run| {
        run.integral(&kernel!(|_ray: Ray, sampler: Sampler| { light(host(which), sampler) }))
    })
    // Lamps are sampled, and nothing stands between.
    .counted(|_| Work::NOTHING)
    .values(&SAMPLES)
    .family("smooth")
    .method(SampleMethod::Random, Some(Order::RANDOM))
    .method(SampleMethod::Stratified, Some(Order::near(-1.0, 0.1)))
    .method(SampleMethod::Sobol, Some(sobol))
}

/// All of them.
pub(crate) fn cases() -> Vec<Case<'static>> {
    vec![
        case("P-D1", 0, 1.404_962_946_208_145_3, SMOOTH),
        case("P-D2", 1, 1.740_839_502_734_206_4, SMOOTH),
        case("P-D3", 2, 0.452_401_900_028_853, KINKED),
        case("P-D3-angle", 3, 0.479_707_883_154_055_55, KINKED),
        case("P-D4", 4, 0.312_766_721_941_545, SMOOTH),
        case("P-D5-0", 5, 2.0 / 3.0, WARPED),
        case("P-D5-60", 6, 0.405_998_520_696_152_9, WARPED),
        case("P-D5-90", 7, 0.212_206_590_789_193_78, WARPED),
        case("P-D6", 8, 2.443_460_952_792_061, WARPED),
        case("P-S1", 9, 2.0 / 3.0, WARPED),
        case("P-S1-square", 10, 0.5, WARPED),
        case("P-S2", 11, 0.796_599_599_297_053_2, SMOOTH),
    ]
}
