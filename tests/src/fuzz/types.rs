//! The structs of generated kernels, and methods that they may call.

use raydsl::kernel;
use raydsl::prelude::*;

/// One member of each scalar type.
#[derive(Clone, Copy, Debug, Type)]
pub struct Small {
    /// A signed integer.
    pub i: i32,
    /// A truth value.
    pub t: bool,
    /// A float.
    pub y: f32,
    /// An unsigned integer.
    pub m: u32,
}

/// Members that have members.
#[derive(Clone, Copy, Debug, Type)]
pub struct Nested {
    /// A vector.
    pub v: Vec3,
    /// A struct.
    pub s: Small,
    /// An unsigned integer.
    pub k: u32,
}

/// What a generated kernel gives.
#[derive(Clone, Copy, Debug, Type)]
pub struct Outcome {
    /// Most of it.
    pub n: Nested,
    /// A float.
    pub x: f32,
    /// A truth value.
    pub t: bool,
}

#[kernel]
impl Small {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        Self { i: (n & 7) as i32 - 3, t: (n & 1) != 0, y: (n & 15) as f32 * 0.5, m: n }
    }

    /// An early return and a member of the other.
    pub fn chosen(&self, other: Self, x: f32) -> Small {
        if self.y > x && !other.t {
            return other;
        }
        Self { y: x, ..*self }
    }

    /// A truth value of two.
    pub fn is_more(self, other: Small) -> bool {
        self.m > other.m || self.t && self.i < other.i
    }
}

#[kernel]
impl Nested {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        let x = (n & 31) as f32;
        Self { v: vec3(x, 0.5, -x), s: Small::of(n >> 1), k: n ^ 5 }
    }

    /// A loop in a method.
    pub fn moved(&self, by: Vec3, rounds: u32) -> Self {
        let mut v = self.v;
        for i in 0..rounds & 3 {
            if v.x > v.y {
                continue;
            }
            v += by * i as f32;
        }
        Nested { v, ..*self }
    }
}

#[kernel]
impl Outcome {
    /// One for each number.
    pub fn of(n: u32) -> Self {
        Self { n: Nested::of(n), x: n as f32, t: n > 3 }
    }
}
