//! Elementary functions by the strict arithmetic of every variant, and by a device's own: a closed
//! form.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_report::work_precision::{Case, Order, Reference, Work};

/// Turns of a sine and a cosine, a power, and a logarithm of two numbers, whose means are known.
#[kernel]
pub(crate) fn functions(sampler: Sampler) -> f32 {
    let mut sampler = sampler;
    let u = sampler.next_2d();
    let turns = sin(3.0 * u.x) * cos(2.0 * u.y);
    let growth = exp(-2.0 * u.x) * pow(1.0 + u.y, 1.5);
    turns + growth + log(1.0 + u.x) * atan(u.y)
}

/// The mean over the square.
fn exact() -> f64 {
    let turns = (1.0 - 3f64.cos()) / 3.0 * (2f64.sin() / 2.0);
    let growth = (1.0 - (-2f64).exp()) / 2.0 * ((2f64.powf(2.5) - 1.0) / 2.5);
    let logarithm = 2.0 * 2f64.ln() - 1.0;
    let angle = core::f64::consts::FRAC_PI_4 - 0.5 * 2f64.ln();
    turns + growth + logarithm * angle
}

/// The case: `fast` is [`Arithmetic::Fast`], which changes nothing on the CPU.
pub(crate) fn case() -> Case<'static> {
    Case::new("functions", Reference::closed_form(exact()), |run| {
        let kernel = kernel!(|_ray: Ray, sampler: Sampler| functions(sampler));
        match run.method().name() {
            "fast" => run.integral(&kernel.arithmetic(Arithmetic::Fast)),
            _ => run.integral(&kernel),
        }
    })
    .counted(|_| Work::NOTHING)
    .values(&[4, 16, 64, 256, 1024, 4096])
    .family("arithmetic")
    .method("strict", Some(Order::near(-1.4, 0.1)))
    .method("fast", Some(Order::near(-1.4, 0.1)))
}
