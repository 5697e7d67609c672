//! One step of Dormand and Prince's pair of orders 5 and 4.
//!
//! Dormand and Prince, "A family of embedded Runge-Kutta formulae", Journal of Computational and
//! Applied Mathematics 6 (1980); dense output of order 4 by Shampine, "Some practical Runge-Kutta
//! formulas", Mathematics of Computation 46 (1986), with the coefficients of Hairer, Nørsett and
//! Wanner, "Solving Ordinary Differential Equations I" (1993), section II.6.
//!
//! The estimate of the pair assumes a smooth field. At a corner, as fields of grids have them between
//! cells, it may be near 0 by chance. So the defect counts too: by how much the velocity of the
//! dense output is off in the middle of a step, where no stage is. (Enright, "Continuous numerical
//! methods for ODEs with defect control", Journal of Computational and Applied Mathematics 125, 2000.)

use glam::{Vec3, vec3};

use crate::machine::functions::vec3;
use crate::machine::generic::{length, max};
use crate::{Type, kernel};

/// A field at a place.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(super) struct Flow {
    /// Along the line: against the field for a line that is followed backwards.
    pub(super) velocity: Vec3,
    pub(super) speed: f32,
    /// Whether the field has a finite value.
    pub(super) is_defined: bool,
}

#[kernel]
#[inline]
pub(super) fn flow_at<F: Fn(Vec3) -> Option<Vec3>>(field: &F, at: Vec3, sign: f32) -> Flow {
    let mut flow = Flow { velocity: vec3(0.0, 0.0, 0.0), speed: 0.0, is_defined: false };
    if let Some(velocity) = field(at) {
        let speed = length(velocity);
        // It is not for a NaN.
        if speed <= f32::MAX {
            flow = Flow { velocity: velocity * sign, speed, is_defined: true };
        }
    }
    flow
}

const A21: f32 = 1.0 / 5.0;
const A31: f32 = 3.0 / 40.0;
const A32: f32 = 9.0 / 40.0;
const A41: f32 = 44.0 / 45.0;
const A42: f32 = -56.0 / 15.0;
const A43: f32 = 32.0 / 9.0;
const A51: f32 = 19_372.0 / 6561.0;
const A52: f32 = -25_360.0 / 2187.0;
const A53: f32 = 64_448.0 / 6561.0;
const A54: f32 = -212.0 / 729.0;
const A61: f32 = 9017.0 / 3168.0;
const A62: f32 = -355.0 / 33.0;
const A63: f32 = 46_732.0 / 5247.0;
const A64: f32 = 49.0 / 176.0;
const A65: f32 = -5103.0 / 18_656.0;
/// Weights of the solution of order 5, which are those of the last stage too.
const B1: f32 = 35.0 / 384.0;
const B3: f32 = 500.0 / 1113.0;
const B4: f32 = 125.0 / 192.0;
const B5: f32 = -2187.0 / 6784.0;
const B6: f32 = 11.0 / 84.0;
/// Weights of its difference from the solution of order 4.
const E1: f32 = 71.0 / 57_600.0;
const E3: f32 = -71.0 / 16_695.0;
const E4: f32 = 71.0 / 1920.0;
const E5: f32 = -17_253.0 / 339_200.0;
const E6: f32 = 22.0 / 525.0;
const E7: f32 = -1.0 / 40.0;
/// Weights of the term of order 4 of the dense output.
const D1: f32 = (-12_715_105_075.0f64 / 11_282_082_432.0) as f32;
const D3: f32 = (87_487_479_700.0f64 / 32_700_410_799.0) as f32;
const D4: f32 = (-10_690_763_975.0f64 / 1_880_347_072.0) as f32;
const D5: f32 = (701_980_252_875.0f64 / 199_316_789_632.0) as f32;
const D6: f32 = (-1_453_857_185.0f64 / 822_651_844.0) as f32;
const D7: f32 = (69_997_945.0f64 / 29_380_423.0) as f32;

/// Weight of the defect beside the estimate of the pair.
const DEFECT: f32 = 0.5;

/// A step from a place.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub(super) struct Step {
    /// Displacement from the place.
    pub(super) moved: Vec3,
    /// Field at the end.
    pub(super) end: Flow,
    /// Estimated error of each coordinate of the displacement, by its size.
    pub(super) error: Vec3,
    /// Term of order 4 of the dense output.
    pub(super) bend: Vec3,
    /// Length of the path.
    pub(super) length: f32,
    /// Whether the field has a finite value in all stages.
    pub(super) is_defined: bool,
}

/// Takes a step over a time from a place, at which the field is `a`.
#[kernel]
#[inline]
pub(super) fn step<F: Fn(Vec3) -> Option<Vec3>>(
    field: &F,
    at: Vec3,
    a: Flow,
    time: f32,
    sign: f32,
) -> Step {
    let (k1, h) = (a.velocity, time);
    let b = flow_at(field, at + k1 * (A21 * h), sign);
    let k2 = b.velocity;
    let c = flow_at(field, at + (k1 * A31 + k2 * A32) * h, sign);
    let k3 = c.velocity;
    let d = flow_at(field, at + (k1 * A41 + k2 * A42 + k3 * A43) * h, sign);
    let k4 = d.velocity;
    let e = flow_at(field, at + (k1 * A51 + k2 * A52 + k3 * A53 + k4 * A54) * h, sign);
    let k5 = e.velocity;
    let sum = k1 * A61 + k2 * A62 + k3 * A63 + k4 * A64 + k5 * A65;
    let f = flow_at(field, at + sum * h, sign);
    let k6 = f.velocity;
    let moved = (k1 * B1 + k3 * B3 + k4 * B4 + k5 * B5 + k6 * B6) * h;
    let end = flow_at(field, at + moved, sign);
    let k7 = end.velocity;
    let error = (k1 * E1 + k3 * E3 + k4 * E4 + k5 * E5 + k6 * E6 + k7 * E7) * h;
    let bend = (k1 * D1 + k3 * D3 + k4 * D4 + k5 * D5 + k6 * D6 + k7 * D7) * h;
    // The dense output in the middle, and how far it would move in the whole time.
    let middle = moved * 0.5 + (k1 - k7) * (0.125 * h) + bend * 0.0625;
    let pace = moved * 1.5 - (k1 + k7) * (0.25 * h);
    let m = flow_at(field, at + middle, sign);
    let defect = (pace - m.velocity * h) * DEFECT;
    Step {
        moved,
        end,
        error: max(error.abs(), defect.abs()),
        bend,
        length: (a.speed * B1 + c.speed * B3 + d.speed * B4 + e.speed * B5 + f.speed * B6) * h,
        is_defined: b.is_defined
            & c.is_defined
            & d.is_defined
            & e.is_defined
            & f.is_defined
            & end.is_defined
            & m.is_defined,
    }
}
