//! How accurately integrators follow rays through a Luneburg lens, where the way is known.

use std::fmt::Write as _;

use raydsl::prelude::*;
use raydsl_examples::lens::{
    BogackiShampine, Luneburg, RungeKutta, State, Stepper, Verlet, excess, through,
};

const MEDIUM: Luneburg = Luneburg { radius: 1.0 };
/// Turns of a ray in a medium that goes on beyond the surface of a lens.
const TURNS: u32 = 100;

/// Entries of a beam along -z, on rings: the momentum is the focus.
fn beam() -> Vec<State> {
    let ray = |i: u16| {
        let (sin, cos) = (2.4 * f32::from(i)).sin_cos();
        let aside = 0.9 * (f32::from(i) / 200.0).sqrt();
        let at = vec3(aside * cos, aside * sin, (1.0 - aside * aside).sqrt());
        State { at, momentum: -Vec3::Z }
    };
    (0..200).map(ray).collect()
}

/// A line of the table: the mean number of steps; the largest error of the focus; the largest
/// excess where rays leave the lens, and within a hundred turns of one.
fn line<S: Stepper>(stepper: S, first: f32) -> String {
    let rays = beam();
    let (mut steps, mut error, mut drift) = (0, 0.0f32, 0.0f32);
    for &entry in &rays {
        let passage = through(stepper, MEDIUM.radius, entry, first, 1000);
        if !passage.is_out {
            return "did not leave the lens".to_owned();
        }
        steps += passage.steps;
        error = error.max(passage.end.at.distance(entry.momentum));
        drift = drift.max(excess(MEDIUM, passage.end).abs());
    }
    let steps = steps as f32 / rays.len() as f32;
    format!("{steps:6.1} {error:12.1e} {drift:12.1e} {:14.1e}", turning(stepper, rays[120], first))
}

/// The largest excess of a ray that goes around in the lens's medium: symplectic steps keep it
/// bounded, others let it grow.
fn turning<S: Stepper>(stepper: S, entry: State, first: f32) -> f32 {
    let (mut state, mut length, mut passed, mut most) = (entry, first, 0.0, 0.0f32);
    while passed < TURNS as f32 * std::f32::consts::TAU {
        let step = stepper.step(state, length);
        if step.is_accepted {
            state = step.end;
            passed += length;
            most = most.max(excess(MEDIUM, state).abs());
        }
        length = step.next;
    }
    most
}

/// The table: fixed steps divide a quarter of a turn, the way through the lens; the pair begins
/// with one of them, whatever its tolerance.
pub(crate) fn table() -> String {
    let quarter = 0.5 * std::f32::consts::PI;
    let mut text = format!(
        "{:24} {:>6} {:>12} {:>12} {:>14}\n",
        "integrator",
        "steps",
        "focus error",
        "p² - n²",
        format!("{TURNS} turns")
    );
    let mut add = |name: String, line: String| {
        let _ = writeln!(text, "{name:24} {line}");
    };
    for steps in [8u8, 16, 32] {
        let first = quarter / f32::from(steps);
        add(format!("Verlet, {steps}"), line(Verlet { medium: MEDIUM }, first));
    }
    for steps in [4u8, 8, 16] {
        let first = quarter / f32::from(steps);
        add(format!("Runge-Kutta 4, {steps}"), line(RungeKutta { medium: MEDIUM }, first));
    }
    for tolerance in [1e-2f32, 1e-3, 1e-4, 1e-5] {
        let stepper = BogackiShampine { medium: MEDIUM, tolerance };
        add(format!("Bogacki-Shampine, {tolerance:.0e}"), line(stepper, 0.1));
    }
    text
}
