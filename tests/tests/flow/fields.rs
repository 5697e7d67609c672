//! Fields in closed form, for kernels and in `f64`, and an integrator of the latter.

use glam::{DVec3, dvec3};
use raydsl::kernel;
use raydsl::prelude::*;

/// A field by its number: one kernel for all, so that one is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Field {
    /// Around the z axis, one radian in unit time, and slowly up.
    Rotation,
    /// Away from the plane x = 0, towards y = 0.
    Saddle,
    /// Arnold, Beltrami and Childress: chaotic between vortices.
    Abc,
    /// Lorenz' butterfly.
    Lorenz,
    /// Towards a moving point, a hundred times as fast as it moves.
    Stiff,
    /// Around the z axis, faster towards it, without bound.
    Vortex,
    /// At a speed that has a corner on each plane x = 1, 2, ...
    Corners,
}

impl Field {
    pub(crate) const ALL: [Self; 7] = [
        Self::Rotation,
        Self::Saddle,
        Self::Abc,
        Self::Lorenz,
        Self::Stiff,
        Self::Vortex,
        Self::Corners,
    ];

    pub(crate) const fn number(self) -> u32 {
        self as u32
    }

    /// The velocity in `f64`.
    pub(crate) fn at(self, p: DVec3) -> DVec3 {
        match self {
            Self::Rotation => dvec3(-p.y, p.x, 0.1),
            Self::Saddle => dvec3(p.x, -p.y, 0.25),
            Self::Abc => dvec3(
                p.z.sin() + 0.5 * p.y.cos(),
                0.8 * p.x.sin() + p.z.cos(),
                0.5 * p.y.sin() + 0.8 * p.x.cos(),
            ),
            Self::Lorenz => {
                dvec3(10.0 * (p.y - p.x), p.x * (28.0 - p.z) - p.y, p.x * p.y - (8.0 / 3.0) * p.z)
            }
            Self::Stiff => dvec3(1.0, -100.0 * (p.y - p.x.sin()), -100.0 * p.z),
            Self::Vortex => dvec3(-p.y, p.x, 0.0) / (p.x * p.x + p.y * p.y),
            Self::Corners => {
                let x = p.x - p.x.floor();
                dvec3(1.0 + 0.5 * x.min(1.0 - x), 0.3 * (x - 0.5).abs(), 0.0)
            }
        }
    }

    /// A seed, a time and the greatest step.
    pub(crate) const fn case(self) -> (Vec3, f32, f32) {
        match self {
            Self::Rotation => (vec3(1.0, 0.0, 0.0), 6.0, 1.0),
            Self::Saddle => (vec3(0.25, 2.0, 0.0), 3.0, 1.0),
            Self::Abc => (vec3(0.3, 0.7, 1.1), 8.0, 1.0),
            Self::Lorenz => (vec3(1.0, 1.0, 20.0), 1.0, 10.0),
            Self::Stiff => (vec3(0.0, 1.0, 0.5), 2.0, 1.0),
            Self::Vortex => (vec3(0.5, 0.0, 0.0), 2.0, 0.5),
            Self::Corners => (vec3(0.1, 0.0, 0.0), 4.0, 0.5),
        }
    }

    /// Where a seed is after a time, by many steps of Runge and Kutta's rule in `f64`; those through
    /// corners are short enough for their error to be far below 1e-7.
    pub(crate) fn exact(self, seed: Vec3, time: f32) -> DVec3 {
        let steps = if self == Self::Stiff || self == Self::Corners { 400_000 } else { 40_000 };
        let h = f64::from(time) / f64::from(steps);
        let mut p = seed.as_dvec3();
        for _ in 0..steps {
            let a = self.at(p);
            let b = self.at(p + a * (h * 0.5));
            let c = self.at(p + b * (h * 0.5));
            let d = self.at(p + c * h);
            p += (a + 2.0 * b + 2.0 * c + d) * (h / 6.0);
        }
        p
    }
}

#[kernel]
fn abc(p: Vec3) -> Vec3 {
    vec3(sin(p.z) + 0.5 * cos(p.y), 0.8 * sin(p.x) + cos(p.z), 0.5 * sin(p.y) + 0.8 * cos(p.x))
}

#[kernel]
fn corners(p: Vec3) -> Vec3 {
    let x = p.x - p.x.floor();
    vec3(1.0 + 0.5 * min(x, 1.0 - x), 0.3 * (x - 0.5).abs(), 0.0)
}

/// The velocity at a place.
#[kernel]
pub(crate) fn velocity(field: u32, p: Vec3) -> Vec3 {
    match field {
        0 => vec3(-p.y, p.x, 0.1),
        1 => vec3(p.x, -p.y, 0.25),
        2 => abc(p),
        3 => vec3(10.0 * (p.y - p.x), p.x * (28.0 - p.z) - p.y, p.x * p.y - (8.0 / 3.0) * p.z),
        4 => vec3(1.0, -100.0 * (p.y - sin(p.x)), -100.0 * p.z),
        5 => vec3(-p.y, p.x, 0.0) / (p.x * p.x + p.y * p.y),
        _ => corners(p),
    }
}
