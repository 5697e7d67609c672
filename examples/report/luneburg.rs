//! The focus of a Luneburg lens by two integrators: a closed form, and a knob of steps.

use std::f32::consts::FRAC_PI_2;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_report::work_precision::{Case, Estimates, Order, Reference, Run, Work};

use crate::lens::{Luneburg, RungeKutta, State, Stepper, Verlet};

/// Names, gradients of the index in a step, and orders. (Hairer, Lubich and Wanner, "Geometric
/// Numerical Integration", sections I.1.4 and II.1.1.)
pub(crate) const INTEGRATORS: [(&str, u64, f64); 2] = [("verlet", 1, -2.0), ("rk4", 4, -4.0)];

/// What a ray's momentum is where it enters a lens of radius 1, and where that is: a beam with the
/// direction (3, 0, -4) / 5, beside whose axis the ray is by x and y of `origin`.
#[kernel]
fn entry(origin: Vec3) -> State {
    let along = vec3(3.0, 0.0, -4.0) / 5.0;
    let across = vec3(4.0, 0.0, 3.0) / 5.0;
    let aside = origin.x * origin.x + origin.y * origin.y;
    let at = across * origin.x + vec3(0.0, origin.y, 0.0) - along * (1.0 - aside).sqrt();
    State { at, momentum: along }
}

/// Where a ray of the beam is after a quarter of a turn, along x. Exactly all of them are at the
/// focus then, (3, 0, -4) / 5 on the surface. A ray that is followed to the surface instead does
/// not show errors of its phase, and Runge and Kutta's order is 5.
#[kernel]
pub(crate) fn focus<S: Stepper>(stepper: S, steps: u32, origin: Vec3) -> f32 {
    let length = FRAC_PI_2 / steps as f32;
    let mut state = entry(origin);
    let mut i: u32 = 0;
    while i < steps {
        state = stepper.step(state, length).end;
        i += 1;
    }
    state.at.x
}

/// A beam half as wide as the lens. What is counted are gradients of the index.
// ANCHOR: case
pub(crate) fn case() -> Case<'static> {
    let beam = Orthographic::new(Vec3::ZERO, -Vec3::Z, Vec3::Y, 1.0);
    let case = Case::new("luneburg", Reference::closed_form(0.6), move |run: &Run<'_>| {
        let (steps, run) = (run.knob(), run.with_samples(1));
        let medium = Luneburg { radius: 1.0 };
        let (found, gradients) = match run.method().name() {
            "verlet" => {
                let verlet = Verlet { medium };
                let kernel = kernel!(|ray: Ray| focus(verlet, steps, ray.origin));
                (run.centers(&beam, &kernel)?, INTEGRATORS[0].1)
            }
            _ => {
                let runge_kutta = RungeKutta { medium };
                let kernel = kernel!(|ray: Ray| focus(runge_kutta, steps, ray.origin));
                (run.centers(&beam, &kernel)?, INTEGRATORS[1].1)
            }
        };
        let counted = found.samples * u64::from(steps) * gradients;
        Ok(Estimates { counted: Some(counted), ..found })
    });
    let case = case.knob("step").values(&[2, 4, 8, 16, 32]).family("curved-rays");
    let case = case.counted(|_| Work::NOTHING);
    INTEGRATORS
        .iter()
        .fold(case, |case, (name, _, order)| case.method(*name, Some(Order::near(*order, 0.15))))
}
// ANCHOR_END: case
