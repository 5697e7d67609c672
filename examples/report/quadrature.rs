//! The optical depth along a ray by rules of quadrature: a closed form, and a knob of steps.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_report::work_precision::{Case, Estimates, Order, Reference, Run, Work};

/// Haze that is thinner the higher it is: extinction per unit of length.
#[kernel]
fn density(at: Vec3) -> f32 {
    let height = 1.0 + at.z;
    1.5 / (height * height)
}

/// The mean density on a step of a ray by a rule, which is its place in [`RULES`].
#[kernel]
fn on_step(#[host] rule: u32, ray: Ray, start: f32, length: f32) -> f32 {
    let middle = start + 0.5 * length;
    match rule {
        0 => density(ray.at(start)),
        1 => density(ray.at(middle)),
        2 => {
            let ends = density(ray.at(start)) + density(ray.at(start + length));
            (ends + 4.0 * density(ray.at(middle))) / 6.0
        }
        _ => {
            // Gauss and Legendre's two places.
            let aside = length * (1.0_f32 / 12.0).sqrt();
            0.5 * (density(ray.at(middle - aside)) + density(ray.at(middle + aside)))
        }
    }
}

/// Of a ray from the ground that rises by 1 on its way of length 2, in `steps` steps. What it
/// carries of the light behind is exp of minus that.
#[kernel]
pub(crate) fn optical_depth(#[host] rule: u32, steps: u32) -> f32 {
    let ray = Ray::new(vec3(0.0, 0.0, 0.0), vec3(0.75_f32.sqrt(), 0.0, 0.5));
    let length = 2.0 / steps as f32;
    let mut depth = 0.0;
    let mut i: u32 = 0;
    while i < steps {
        depth += length * on_step(rule, ray, i as f32 * length, length);
        i += 1;
    }
    depth
}

/// Names, look-ups of the density in a step, and orders. (Davis and Rabinowitz, "Methods of
/// Numerical Integration", chapter 2.)
pub(crate) const RULES: [(&str, u64, f64); 4] =
    [("left", 1, -1.0), ("middle", 1, -2.0), ("simpson", 3, -4.0), ("gauss", 2, -4.0)];

/// Places of the rule of this name.
fn place(name: &str) -> usize {
    RULES.iter().position(|rule| rule.0 == name).expect("a method of the case")
}

/// A knob of steps; the slack of the orders is for two and four of them, where they are not reached
/// yet. What is counted are look-ups of the density.
// ANCHOR: case
pub(crate) fn case() -> Case<'static> {
    // The integral of 1.5 / (1 + s / 2)^2 for s from 0 to 2.
    let case = Case::new("optical-depth", Reference::closed_form(1.5), |run: &Run<'_>| {
        let (rule, steps) = (place(run.method().name()), run.knob());
        let index = rule as u32;
        let kernel = kernel!(|_ray: Ray| optical_depth(host(index), steps));
        let found = run.with_samples(1).integral(&kernel)?;
        let look_ups = found.samples * u64::from(steps) * RULES[rule].1;
        Ok(Estimates { counted: Some(look_ups), ..found })
    });
    let case = case.knob("step").values(&[2, 4, 8, 16, 32]).family("quadrature");
    let case = case.counted(|_| Work::NOTHING);
    RULES
        .iter()
        .fold(case, |case, (name, _, order)| case.method(*name, Some(Order::near(*order, 0.15))))
}
// ANCHOR_END: case
