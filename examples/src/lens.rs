//! Rays through media whose index of refraction changes from place to place: they are curved.
//!
//! In Hamilton's form a ray has a place `r` and an optical momentum `p`, a vector along it as long
//! as the index `n`. Over σ, with the length of the path `ds = n dσ`, `dr/dσ = p` and
//! `dp/dσ = grad(n²) / 2`: the equations of a particle, so that its integrators serve. `p² - n²`
//! stays 0.

use raydsl::kernel;
use raydsl::prelude::*;

// ANCHOR: medium
/// A medium by its index of refraction, smooth also a little beyond its surface: a step ends there
/// before it is shortened.
#[kernel]
pub trait Medium {
    /// The square of the index at a place.
    fn index_squared(&self, at: Vec3) -> f32;
    /// Half of the gradient of that: the force on the momentum.
    fn force(&self, at: Vec3) -> Vec3;
}

/// A ball around the origin that focuses parallel light on its surface. (Luneburg, "Mathematical
/// Theory of Optics", 1944.)
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Luneburg {
    /// Where the index is 1.
    pub radius: f32,
}

#[kernel]
impl Medium for Luneburg {
    fn index_squared(&self, at: Vec3) -> f32 {
        2.0 - at.dot(at) / (self.radius * self.radius)
    }

    fn force(&self, at: Vec3) -> Vec3 {
        at * (-1.0 / (self.radius * self.radius))
    }
}
// ANCHOR_END: medium

/// A ball around the origin that shows each point of its surface at the opposite one; rays are
/// arcs of circles. (Maxwell, 1854; Born and Wolf, "Principles of Optics", section 4.2.2.)
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct FishEye {
    /// Where the index is 1.
    pub radius: f32,
}

#[kernel]
impl Medium for FishEye {
    fn index_squared(&self, at: Vec3) -> f32 {
        let ratio = 1.0 + at.dot(at) / (self.radius * self.radius);
        4.0 / (ratio * ratio)
    }

    fn force(&self, at: Vec3) -> Vec3 {
        let area = self.radius * self.radius;
        let ratio = 1.0 + at.dot(at) / area;
        at * (-8.0 / (area * ratio * ratio * ratio))
    }
}

/// A place on a ray and its momentum there; or how fast these change.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct State {
    /// The place.
    pub at: Vec3,
    /// Along the ray, as long as the index.
    pub momentum: Vec3,
}

#[kernel]
impl State {
    /// This state after changing by `slope` over `length`.
    pub fn moved(self, slope: State, length: f32) -> State {
        State { at: self.at + slope.at * length, momentum: self.momentum + slope.momentum * length }
    }
}

/// The right-hand side of the equations.
#[kernel]
pub fn slope<M: Medium>(medium: M, state: State) -> State {
    State { at: state.momentum, momentum: medium.force(state.at) }
}

/// `p² - n²`, which is 0 on a ray.
#[kernel]
pub fn excess<M: Medium>(medium: M, state: State) -> f32 {
    state.momentum.dot(state.momentum) - medium.index_squared(state.at)
}

// ANCHOR: stepper
/// What a step gives.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Step {
    /// The state at its end.
    pub end: State,
    /// Whether it is accurate enough.
    pub is_accepted: bool,
    /// The length of the next step, or of another attempt.
    pub next: f32,
}

/// An integrator.
#[kernel]
pub trait Stepper {
    /// One step from a state.
    fn step(&self, from: State, length: f32) -> Step;
}

/// Störmer and Verlet's rule, which is symplectic and of order 2: it moves half a step along the
/// momentum, changes the momentum for the whole step, and moves the other half.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Verlet<M: Medium> {
    /// What the ray is in.
    pub medium: M,
}

#[kernel]
impl<M: Medium> Stepper for Verlet<M> {
    fn step(&self, from: State, length: f32) -> Step {
        let medium: M = self.medium;
        let middle = from.at + from.momentum * (0.5 * length);
        let momentum = from.momentum + medium.force(middle) * length;
        let end = State { at: middle + momentum * (0.5 * length), momentum };
        Step { end, is_accepted: true, next: length }
    }
}
// ANCHOR_END: stepper

/// The classical rule of Runge and Kutta, of order 4.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct RungeKutta<M: Medium> {
    /// What the ray is in.
    pub medium: M,
}

#[kernel]
impl<M: Medium> Stepper for RungeKutta<M> {
    fn step(&self, from: State, length: f32) -> Step {
        let medium: M = self.medium;
        let a = slope::<M>(medium, from);
        let b = slope::<M>(medium, from.moved(a, 0.5 * length));
        let c = slope::<M>(medium, from.moved(b, 0.5 * length));
        let d = slope::<M>(medium, from.moved(c, length));
        let sum = a.moved(b, 2.0).moved(c, 2.0).moved(d, 1.0);
        Step { end: from.moved(sum, length / 6.0), is_accepted: true, next: length }
    }
}

/// Bogacki and Shampine's pair: a step of order 3, and the error of another one of order 2 from
/// the same slopes. ("A 3(2) pair of Runge-Kutta formulas", 1989.)
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct BogackiShampine<M: Medium> {
    /// What the ray is in.
    pub medium: M,
    /// The error of every coordinate of place and momentum that is aimed at. Errors of steps add up
    /// over some ten, partly with other signs: a step is accepted with a quarter of it.
    pub tolerance: f32,
}

#[kernel]
impl<M: Medium> Stepper for BogackiShampine<M> {
    fn step(&self, from: State, length: f32) -> Step {
        let medium: M = self.medium;
        let a = slope::<M>(medium, from);
        let b = slope::<M>(medium, from.moved(a, 0.5 * length));
        let c = slope::<M>(medium, from.moved(b, 0.75 * length));
        let sum = from.moved(a, length * (2.0 / 9.0)).moved(b, length * (1.0 / 3.0));
        let end = sum.moved(c, length * (4.0 / 9.0));
        let d = slope::<M>(medium, end);
        let zero = State { at: vec3(0.0, 0.0, 0.0), momentum: vec3(0.0, 0.0, 0.0) };
        let off = zero.moved(a, -5.0 / 72.0).moved(b, 1.0 / 12.0).moved(c, 1.0 / 9.0);
        let off = off.moved(d, -0.125);
        let error = length * max(off.at.abs(), off.momentum.abs()).max_element();
        // The error grows with the cube of the length. A NaN is not accepted.
        let allowed = 0.25 * self.tolerance;
        let is_accepted = error <= allowed;
        let factor = 0.9 * pow(allowed / max(error, f32::MIN_POSITIVE), 1.0 / 3.0);
        Step { end, is_accepted, next: length * clamp(factor, 0.2, 5.0) }
    }
}

// ANCHOR: through
/// A ray's way through a ball.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Passage {
    /// Where it leaves the ball; where it was given up if it does not.
    pub end: State,
    /// Attempted steps, without those that shorten the last one.
    pub steps: u32,
    /// Whether it left the ball. It does not after `most` steps.
    pub is_out: bool,
}

/// How often the step that leaves the ball is shortened: Newton's iteration for where it meets the
/// surface, which squares the distance that is left each time.
const SHORTENED: u32 = 4;

/// Follows a ray from where it enters a ball of this radius around the origin, with a first step of
/// length `first`, to where it leaves it. At most `most` steps are attempted, so that neither a
/// tolerance that cannot be reached nor a NaN goes on for ever.
#[kernel]
pub fn through<S: Stepper>(stepper: S, radius: f32, from: State, first: f32, most: u32) -> Passage {
    let mut passage = Passage { end: from, steps: 0, is_out: false };
    let mut length = first;
    while !passage.is_out && passage.steps < most {
        let step = stepper.step(passage.end, length);
        passage.steps += 1;
        if step.is_accepted {
            let State { at, momentum } = step.end;
            passage.is_out = at.dot(at) > radius * radius && at.dot(momentum) > 0.0;
            passage.end = if passage.is_out {
                onto_surface::<S>(stepper, radius, passage.end, length, step.end)
            } else {
                step.end
            };
        }
        length = step.next;
    }
    passage
}

/// Shortens the step from `from` to `beyond` so that it ends on the surface.
#[kernel]
fn onto_surface<S: Stepper>(
    stepper: S,
    radius: f32,
    from: State,
    step: f32,
    beyond: State,
) -> State {
    let mut end = beyond;
    let mut shorter = step;
    for _i in 0..SHORTENED {
        // A difference of squares has addends enough for a device to reorder, with other bits.
        let distance = length(end.at);
        let rate = max(end.at.dot(end.momentum), f32::MIN_POSITIVE);
        shorter = clamp(shorter - (distance - radius) * distance / rate, 0.0, step);
        end = stepper.step(from, shorter).end;
    }
    end
}
// ANCHOR_END: through
