//! Following a line: steps as long as the tolerance allows.

use glam::{Vec2, Vec3, vec2, vec3};

use super::dormand_prince::{Flow, Step, flow_at, step};
use super::settings::FlowSettings;
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{clamp, length, max, min};
use crate::math::elementary::pow;
use crate::math::exact::lost_by_difference;
use crate::{Type, kernel};

/// Maximum number of steps that one call of [`trace()`] takes.
pub const STEPS_PER_CALL: usize = 8;

/// Maximum number of steps that one call of [`trace()`] tries, taken or not.
pub const TRIES_PER_CALL: u32 = 64;

/// Why a line ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Type)]
#[repr(u32)]
pub enum FlowEnd {
    /// It does not yet: it goes on with the next call.
    #[default]
    Going,
    /// The seed is where the field has no finite value; the line has no point.
    NoField,
    /// Within the least step beyond the last point the field has no finite value.
    Left,
    /// The speed is not above [`FlowSettings::still`].
    Still,
    /// It came back to its seed.
    Closed,
    /// It reached [`FlowSettings::max_time`].
    Time,
    /// It reached [`FlowSettings::max_length`].
    Length,
    /// It took [`FlowSettings::max_attempts`].
    Attempts,
    /// The least step has an error above the tolerance, as at a jump to another speed.
    Tolerance,
}

/// A point of a line, and what connects it to the point before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct FlowPoint {
    /// Place.
    pub at: Vec3,
    /// The field there.
    pub velocity: Vec3,
    /// Time from the seed; below 0 where the line was followed backwards.
    pub time: f32,
    /// Length of the line from the seed, of the same sign.
    pub length: f32,
    /// Term of order 4 of the dense output between the point before and this one.
    pub bend: Vec3,
}

/// Where a line is, and how it goes on.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct FlowState {
    /// Why it ends; [`FlowEnd::Going`] as long as it goes on.
    pub end: FlowEnd,
    /// Number of steps tried so far.
    pub attempts: u32,
    seed: Vec3,
    /// 1 along the field, -1 against it.
    sign: f32,
    /// Velocity at the seed, along the line.
    first: Vec3,
    has_begun: bool,
    at: Vec3,
    /// What was lost by rounding of `at`.
    rest: Vec3,
    flow: Flow,
    /// Time and length since the seed.
    run: Vec2,
    /// What was lost by rounding of both.
    run_rest: Vec2,
    /// Time of the next step.
    step: f32,
    /// Error of the last step that was taken, in units of the tolerance.
    error: f32,
    was_refused: bool,
    /// How often the next step was shortened to end where the line does.
    shortened: u32,
}

impl FlowState {
    /// Creates a line that begins at a seed and is followed along the field.
    pub const fn forwards(seed: Vec3) -> Self {
        Self {
            end: FlowEnd::Going,
            attempts: 0,
            seed,
            sign: 1.0,
            first: Vec3::ZERO,
            has_begun: false,
            at: seed,
            rest: Vec3::ZERO,
            flow: Flow { velocity: Vec3::ZERO, speed: 0.0, is_defined: false },
            run: Vec2::ZERO,
            run_rest: Vec2::ZERO,
            step: 0.0,
            error: 1e-4,
            was_refused: false,
            shortened: 0,
        }
    }

    /// Creates a line that begins at a seed and is followed against the field.
    pub const fn backwards(seed: Vec3) -> Self {
        Self { sign: -1.0, ..Self::forwards(seed) }
    }

    /// Returns the point at the seed.
    pub(super) fn first_point(&self) -> FlowPoint {
        FlowPoint { at: self.seed, velocity: self.first * self.sign, ..FlowPoint::default() }
    }
}

/// What a call of [`trace()`] returns.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct FlowSteps {
    /// The line behind these steps.
    pub state: FlowState,
    /// Number of the steps.
    pub count: u32,
    /// Their ends; only the first `count` are defined.
    pub points: [FlowPoint; STEPS_PER_CALL],
}

/// Part of the greatest step that the first step tries.
const FIRST: f32 = 1.0 / 16.0;
/// By how much steps are shorter than the estimated error allows.
const SAFETY: f32 = 0.9;
/// Exponents of a controller with an integral and a proportional part.
const INTEGRAL: f32 = 0.17;
const PROPORTIONAL: f32 = 0.04;
/// Bounds of what a step may be longer than the one before.
const LEAST_GROWTH: f32 = 0.2;
const MOST_GROWTH: f32 = 5.0;
/// Least error in units of the tolerance: below, steps grow as fast as they may.
const LEAST_ERROR: f32 = 1e-4;
/// How often a step is shortened to end where the line does.
const MAX_SHORTENED: u32 = 6;
/// By which share such a step may be longer.
const NEAR: f32 = 1e-4;
/// Least share to which a step is shortened at once.
const LEAST_SHARE: f32 = 0.01;

/// Follows a line for a few steps, at most [`STEPS_PER_CALL`], by Dormand and Prince's method of
/// order 5 in time, and returns where it is then. `field` returns the velocity at a place, or `None`
/// where there is none.
///
/// A call tries at most [`TRIES_PER_CALL`] steps: devices end long loops. So it may return without a
/// step of a line that goes on.
///
/// A step is taken if its estimated error is within the tolerance, and so is the defect of its dense
/// output in the middle (Enright, 2000), which sees the corners of a field; the next one is as long as this
/// error and the one before suggest. (Gustafsson, Lundh and Söderlind, "A PI stepsize control for
/// the numerical solution of ordinary differential equations", BIT 1988; exponents of Hairer,
/// Nørsett and Wanner, "Solving Ordinary Differential Equations I", 1993, program DOPRI5.) What
/// rounding loses of the place, of the time and of the length is added to the next step (Kahan,
/// "Further Remarks on Reducing Truncation Errors", 1965).
///
/// Speeds above 1.8e19, whose squares overflow, count as no value.
#[kernel]
#[inline]
#[expect(clippy::needless_range_loop, reason = "kernels have no `iter_mut`")]
pub fn trace<F: Fn(Vec3) -> Option<Vec3>>(
    field: F,
    state: FlowState,
    settings: FlowSettings,
) -> FlowSteps {
    let mut state = state;
    if !state.has_begun {
        state = begun(&field, state, settings);
    }
    let none = vec3(0.0, 0.0, 0.0);
    let nothing = FlowPoint { at: none, velocity: none, time: 0.0, length: 0.0, bend: none };
    let mut points = [nothing; STEPS_PER_CALL];
    let mut count = 0u32;
    let before = state.attempts;
    for i in 0..STEPS_PER_CALL {
        let mut is_taken = false;
        let mut bend = none;
        while !is_taken && state.end == FlowEnd::Going && state.attempts - before < TRIES_PER_CALL {
            let tried = attempt(&field, state, settings);
            state = tried.state;
            is_taken = tried.is_taken;
            bend = tried.bend;
        }
        if is_taken {
            points[i] = FlowPoint {
                at: state.at,
                velocity: state.flow.velocity * state.sign,
                time: state.run.x * state.sign,
                length: state.run.y * state.sign,
                bend,
            };
            count += 1;
        }
    }
    FlowSteps { state, count, points }
}

/// Returns a line that knows the field at its seed.
#[kernel]
#[inline]
fn begun<F: Fn(Vec3) -> Option<Vec3>>(
    field: &F,
    state: FlowState,
    settings: FlowSettings,
) -> FlowState {
    let flow = flow_at(field, state.seed, state.sign);
    let mut end = FlowEnd::Going;
    if !flow.is_defined {
        end = FlowEnd::NoField;
    } else if flow.speed <= settings.still {
        end = FlowEnd::Still;
    } else if settings.max_attempts == 0 {
        end = FlowEnd::Attempts;
    }
    let step = FIRST * settings.max_step / max(flow.speed, settings.still);
    FlowState { end, flow, first: flow.velocity, has_begun: true, step, ..state }
}

/// A step that was tried.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Tried {
    state: FlowState,
    is_taken: bool,
    bend: Vec3,
}

/// Tries a step.
#[kernel]
#[inline]
fn attempt<F: Fn(Vec3) -> Option<Vec3>>(
    field: &F,
    state: FlowState,
    settings: FlowSettings,
) -> Tried {
    let left = settings.max_time - state.run.x;
    let longest = min(settings.max_step / state.flow.speed, f32::MAX);
    let time = min(min(state.step, longest), left);
    let step = step(field, state.at, state.flow, time, state.sign);
    let moved = step.moved + state.rest;
    let at = state.at + moved;
    let size = max(state.at.abs(), at.abs()).max_element();
    let allowed = settings.absolute + settings.relative * size;
    let error = max(step.error.max_element() / allowed, LEAST_ERROR);
    let is_shortest = time * state.flow.speed <= settings.min_step;
    // A negative length is that of a step whose stages have nothing to do with each other.
    let is_too_long = step.length > 1.25 * settings.max_step || step.length < 0.0;
    let share = share_to_end(state, settings, at, step.length);

    let mut next = FlowState { attempts: state.attempts + 1, was_refused: true, ..state };
    let mut is_taken = false;
    if !(step.is_defined && step.length <= f32::MAX && at.is_finite() && step.error.is_finite()) {
        // The field ends on the way.
        next.step = 0.25 * time;
        if is_shortest {
            next.end = FlowEnd::Left;
        }
    } else if is_too_long {
        next.step = time * max(settings.max_step / step.length, LEAST_GROWTH);
    } else if error > 1.0 {
        next.step = time * max(SAFETY / pow(error, 0.2), LEAST_GROWTH);
        if is_shortest {
            next.end = FlowEnd::Tolerance;
        }
    } else if share < 1.0 - NEAR && state.shortened < MAX_SHORTENED {
        next.step = time * share;
        next.shortened = state.shortened + 1;
    } else {
        is_taken = true;
        next = taken(next, step, at, moved, time);
        let growth = SAFETY * pow(state.error, PROPORTIONAL) / pow(error, INTEGRAL);
        let most = if state.was_refused { 1.0 } else { MOST_GROWTH };
        next.step = min(time * clamp(growth, LEAST_GROWTH, most), f32::MAX);
        next.error = error;
        next.end = end_of(next, settings, state, time >= left);
    }
    if next.end == FlowEnd::Going && next.attempts >= settings.max_attempts {
        next.end = FlowEnd::Attempts;
    }
    Tried { state: next, is_taken, bend: step.bend }
}

/// Returns how far the point is beyond the plane through the seed, across the line there.
#[kernel]
#[inline]
fn beyond_seed(state: FlowState, at: Vec3) -> f32 {
    (at - state.seed).dot(state.first)
}

/// Returns the share of a step that ends where the line does, by its length or by coming back; 1 or
/// more if it does not.
#[kernel]
#[inline]
fn share_to_end(state: FlowState, settings: FlowSettings, at: Vec3, way: f32) -> f32 {
    let mut share = (settings.max_length - state.run.y) / max(way, f32::MIN_POSITIVE);
    if settings.closing > 0.0 {
        let (from, to) = (beyond_seed(state, state.at), beyond_seed(state, at));
        if from < 0.0 && to >= 0.0 {
            share = min(share, from / (from - to));
        }
    }
    // A step of no length would not get any nearer.
    max(share, LEAST_SHARE)
}

/// Returns the line behind a step.
#[kernel]
#[inline]
fn taken(state: FlowState, step: Step, at: Vec3, moved: Vec3, time: f32) -> FlowState {
    let more = vec2(time, step.length) + state.run_rest;
    let run = state.run + more;
    let (sum, part) = (vec3(state.run.x, state.run.y, 0.0), vec3(more.x, more.y, 0.0));
    let lost = lost_by_difference(sum, -part);
    FlowState {
        at,
        rest: lost_by_difference(state.at, -moved),
        flow: step.end,
        run,
        run_rest: vec2(lost.x, lost.y),
        was_refused: false,
        shortened: 0u32,
        ..state
    }
}

/// Returns why a line ends behind the step from `before`.
#[kernel]
#[inline]
fn end_of(state: FlowState, settings: FlowSettings, before: FlowState, is_last: bool) -> FlowEnd {
    let is_across = beyond_seed(before, before.at) < 0.0
        && beyond_seed(state, state.at) >= -NEAR * settings.closing * length(state.first);
    let is_back = is_across && length(state.at - state.seed) <= settings.closing;
    let mut end = FlowEnd::Going;
    if settings.closing > 0.0 && is_back {
        end = FlowEnd::Closed;
    } else if state.run.y >= settings.max_length * (1.0 - 1e-5) {
        end = FlowEnd::Length;
    } else if is_last {
        end = FlowEnd::Time;
    } else if state.flow.speed <= settings.still {
        end = FlowEnd::Still;
    }
    end
}
