//! Functions and associated functions of lifted code: `vec3(..)`, `min(..)`, `Vec3::splat(..)`.
//!
//! The type `vec3` stands beside glam's function `vec3`, in the namespace of types: `vec3::on` is
//! the lifted function.

#![allow(non_camel_case_types, reason = "they have the names of functions")]

use glam::{Vec2, Vec3, Vec4};

use super::{Coerce, F, F32Binary, Machine, U, V2, V3, V4};

macro_rules! vector_function {
    ($name:ident, $twin:ident, $($c:ident),+) => {
        #[doc(hidden)]
        #[derive(Debug)]
        pub enum $name {}

        impl $name {
            #[doc(hidden)]
            #[inline(always)]
            pub fn on<M: Machine>(m: &M, $($c: impl Coerce<M, F<M>>),+) -> $twin<M> {
                $twin { $($c: $c.coerce(m)),+ }
            }
        }
    };
}

vector_function!(vec2, V2, x, y);
vector_function!(vec3, V3, x, y, z);
vector_function!(vec4, V4, x, y, z, w);

/// The smaller number: `if b < a { b } else { a }`, so a NaN `b` gives `a`.
#[inline(always)]
pub fn min(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

/// The larger number: `if a < b { b } else { a }`, so a NaN `b` gives `a`.
#[inline(always)]
pub fn max(a: f32, b: f32) -> f32 {
    if a < b { b } else { a }
}

/// `x` between `low` and `high`: `min(max(x, low), high)`.
#[inline(always)]
pub fn clamp(x: f32, low: f32, high: f32) -> f32 {
    min(max(x, low), high)
}

macro_rules! binary_function {
    ($name:ident, $op:ident) => {
        #[doc(hidden)]
        #[derive(Debug)]
        pub enum $name {}

        impl $name {
            #[doc(hidden)]
            #[inline(always)]
            pub fn on<M: Machine>(m: &M, a: impl Coerce<M, F<M>>, b: impl Coerce<M, F<M>>) -> F<M> {
                F(m.f32_binary(F32Binary::$op, a.coerce(m).0, b.coerce(m).0))
            }
        }
    };
}

binary_function!(min, Min);
binary_function!(max, Max);

#[doc(hidden)]
#[derive(Debug)]
pub enum clamp {}

impl clamp {
    #[doc(hidden)]
    #[inline(always)]
    pub fn on<M: Machine>(
        m: &M,
        x: impl Coerce<M, F<M>>,
        low: impl Coerce<M, F<M>>,
        high: impl Coerce<M, F<M>>,
    ) -> F<M> {
        let raised = m.f32_binary(F32Binary::Max, x.coerce(m).0, low.coerce(m).0);
        F(m.f32_binary(F32Binary::Min, raised, high.coerce(m).0))
    }
}

/// Associated functions of glam's vectors and of numbers, lifted.
#[expect(missing_docs, reason = "they are those of the host's types")]
pub trait VectorFunctions: Sized {
    type Twin<M: Machine>;
    fn splat_on<M: Machine>(m: &M, v: impl Coerce<M, F<M>>) -> Self::Twin<M>;
}

macro_rules! vector_functions {
    ($($host:ty => $twin:ident),+) => {
        $(
            impl VectorFunctions for $host {
                type Twin<M: Machine> = $twin<M>;

                #[inline(always)]
                fn splat_on<M: Machine>(m: &M, v: impl Coerce<M, F<M>>) -> $twin<M> {
                    $twin::splat(v.coerce(m))
                }
            }
        )+
    };
}

vector_functions!(Vec2 => V2, Vec3 => V3, Vec4 => V4);

macro_rules! new_function {
    ($trait:ident, $host:ty, $twin:ident, $($c:ident),+) => {
        #[doc = concat!("`", stringify!($host), "::new`, lifted.")]
        pub trait $trait {
            /// A vector of these components.
            fn new_on<M: Machine>(m: &M, $($c: impl Coerce<M, F<M>>),+) -> $twin<M>;
        }

        impl $trait for $host {
            #[inline(always)]
            fn new_on<M: Machine>(m: &M, $($c: impl Coerce<M, F<M>>),+) -> $twin<M> {
                $twin { $($c: $c.coerce(m)),+ }
            }
        }
    };
}

new_function!(Vec2New, Vec2, V2, x, y);
new_function!(Vec3New, Vec3, V3, x, y, z);
new_function!(Vec4New, Vec4, V4, x, y, z, w);

/// Associated functions of `f32`, lifted.
pub trait F32Functions {
    /// `f32::from_bits`.
    fn from_bits_on<M: Machine>(m: &M, bits: impl Coerce<M, U<M>>) -> F<M>;
}

impl F32Functions for f32 {
    #[inline(always)]
    fn from_bits_on<M: Machine>(m: &M, bits: impl Coerce<M, U<M>>) -> F<M> {
        F(m.f32_from_bits(bits.coerce(m).0))
    }
}
