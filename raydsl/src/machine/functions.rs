//! Functions and associated functions of lifted code: `vec3(..)`, `Vec3::splat(..)`.
//!
//! The type `vec3` stands beside glam's function `vec3`, in the namespace of types: `vec3::on` is
//! the lifted function. Functions over several argument types are in [`super::generic`].

#![allow(non_camel_case_types, reason = "they have the names of functions")]

use glam::{
    Affine3, BVec2, BVec3, BVec4, IVec2, IVec3, IVec4, Mat3, Mat4, UVec2, UVec3, UVec4, Vec2, Vec3,
    Vec4,
};

use super::index::choose;
use super::matrix::{A3, M3, M4, xyz};
use super::vector::Vector;
use super::{B, Coerce, F, Machine, Type, U, V3, V4, X2, X3, X4};

macro_rules! function {
    ($($name:ident($($c:ident: $at:ty),+) -> $host:ident;)+) => {
        $(
            #[doc(hidden)]
            #[derive(Debug)]
            pub enum $name {}

            impl $name {
                #[doc(hidden)]
                #[inline(always)]
                pub fn on<M: Machine>(
                    m: &M,
                    $($c: impl Coerce<M, <$at as Type>::On<M>>),+
                ) -> <$host as Type>::On<M> {
                    type Twin<M> = <$host as Type>::On<M>;
                    Twin::<M> { $($c: $c.coerce(m)),+ }
                }
            }
        )+
    };
}

function! {
    vec2(x: f32, y: f32) -> Vec2;
    vec3(x: f32, y: f32, z: f32) -> Vec3;
    vec4(x: f32, y: f32, z: f32, w: f32) -> Vec4;
    ivec2(x: i32, y: i32) -> IVec2;
    ivec3(x: i32, y: i32, z: i32) -> IVec3;
    ivec4(x: i32, y: i32, z: i32, w: i32) -> IVec4;
    uvec2(x: u32, y: u32) -> UVec2;
    uvec3(x: u32, y: u32, z: u32) -> UVec3;
    uvec4(x: u32, y: u32, z: u32, w: u32) -> UVec4;
    bvec2(x: bool, y: bool) -> BVec2;
    bvec3(x: bool, y: bool, z: bool) -> BVec3;
    bvec4(x: bool, y: bool, z: bool, w: bool) -> BVec4;
    mat3(x_axis: Vec3, y_axis: Vec3, z_axis: Vec3) -> Mat3;
    mat4(x_axis: Vec4, y_axis: Vec4, z_axis: Vec4, w_axis: Vec4) -> Mat4;
}

/// Associated functions of all of glam's vectors, lifted.
#[expect(missing_docs, reason = "they are those of the host's types")]
pub trait VectorFunctions: Sized {
    type Component: Type;
    type Twin<M: Machine>: Vector<M, Component = <Self::Component as Type>::On<M>>;
    fn splat_on<M: Machine>(
        m: &M,
        v: impl Coerce<M, <Self::Component as Type>::On<M>>,
    ) -> Self::Twin<M>;
    /// Selects the components of `if_true` where `mask` holds.
    fn select_on<M: Machine>(
        m: &M,
        mask: impl Coerce<M, <Self::Twin<M> as Vector<M>>::Of<B<M>>>,
        if_true: impl Coerce<M, Self::Twin<M>>,
        if_false: impl Coerce<M, Self::Twin<M>>,
    ) -> Self::Twin<M>;
}

macro_rules! new_trait {
    ($twin:ident $new:ident ($($c:ident)+)) => {
        #[doc = concat!("`new` and `from_array` of vectors, lifted to [`", stringify!($twin), "`].")]
        #[expect(missing_docs, reason = "they are those of the host's types")]
        pub trait $new {
            type Component: Type;
            fn new_on<M: Machine>(
                m: &M,
                $($c: impl Coerce<M, <Self::Component as Type>::On<M>>),+
            ) -> $twin<<Self::Component as Type>::On<M>> {
                $twin { $($c: $c.coerce(m)),+ }
            }
        }

    };
}

macro_rules! vector_functions {
    ($twin:ident $new:ident $all:tt: $($host:ident $element:ident),+) => {
        new_trait!($twin $new $all);
        $(vector_functions!(@one $twin $new $all $host $element);)+
    };
    (@one $twin:ident $new:ident ($($c:ident)+) $host:ident $element:ident) => {
            impl $new for $host {
                type Component = $element;
            }

            impl VectorFunctions for $host {
                type Component = $element;
                type Twin<M: Machine> = $twin<<$element as Type>::On<M>>;

                #[inline(always)]
                fn splat_on<M: Machine>(
                    m: &M,
                    v: impl Coerce<M, <$element as Type>::On<M>>,
                ) -> Self::Twin<M> {
                    $twin::splat(v.coerce(m))
                }

                #[inline(always)]
                fn select_on<M: Machine>(
                    m: &M,
                    mask: impl Coerce<M, $twin<B<M>>>,
                    if_true: impl Coerce<M, Self::Twin<M>>,
                    if_false: impl Coerce<M, Self::Twin<M>>,
                ) -> Self::Twin<M> {
                    let mask = mask.coerce(m);
                    let (a, b) = (if_true.coerce(m), if_false.coerce(m));
                    $twin { $($c: choose(m, mask.$c.0, a.$c, b.$c)),+ }
                }
            }
    };
}

vector_functions!(X2 Vec2New (x y): Vec2 f32, IVec2 i32, UVec2 u32, BVec2 bool);
vector_functions!(X3 Vec3New (x y z): Vec3 f32, IVec3 i32, UVec3 u32, BVec3 bool);
vector_functions!(X4 Vec4New (x y z w): Vec4 f32, IVec4 i32, UVec4 u32, BVec4 bool);

/// Associated functions of `f32`, lifted.
pub trait F32Functions {
    /// Lifts `f32::from_bits`.
    fn from_bits_on<M: Machine>(m: &M, bits: impl Coerce<M, U<M>>) -> F<M>;
}

impl F32Functions for f32 {
    #[inline(always)]
    fn from_bits_on<M: Machine>(m: &M, bits: impl Coerce<M, U<M>>) -> F<M> {
        F(m.f32_from_bits(bits.coerce(m).0))
    }
}

// Matrices

macro_rules! associated {
    ($($trait:ident for $host:ident { $($name:ident($($a:ident: $at:ty),+) |$m:ident| $e:expr;)+ })+) => {
        $(
            #[doc = concat!("Associated functions of `", stringify!($host), "`, lifted.")]
            #[expect(missing_docs, reason = "they are those of the host's types")]
            pub trait $trait {
                $(fn $name<M: Machine>(
                    m: &M,
                    $($a: impl Coerce<M, <$at as Type>::On<M>>),+
                ) -> <$host as Type>::On<M>;)+
            }

            impl $trait for $host {
                $(
                    #[inline(always)]
                    fn $name<M: Machine>(
                        $m: &M,
                        $($a: impl Coerce<M, <$at as Type>::On<M>>),+
                    ) -> <$host as Type>::On<M> {
                        $(let $a = $a.coerce($m);)+
                        $e
                    }
                )+
            }
        )+
    };
}

#[inline(always)]
fn number<M: Machine>(m: &M, v: f32) -> F<M> {
    F(m.f32(v))
}

#[inline(always)]
fn with_w<M: Machine>(m: &M, v: V3<M>, w: f32) -> V4<M> {
    V4 { x: v.x, y: v.y, z: v.z, w: number(m, w) }
}

#[inline(always)]
fn diagonal<M: Machine>(m: &M, v: V3<M>) -> M3<M> {
    let o = number(m, 0.0);
    M3 {
        x_axis: V3 { x: v.x, y: o, z: o },
        y_axis: V3 { x: o, y: v.y, z: o },
        z_axis: V3 { x: o, y: o, z: v.z },
    }
}

#[inline(always)]
fn enlarged<M: Machine>(m: &M, a: M3<M>, translation: V3<M>) -> M4<M> {
    M4 {
        x_axis: with_w(m, a.x_axis, 0.0),
        y_axis: with_w(m, a.y_axis, 0.0),
        z_axis: with_w(m, a.z_axis, 0.0),
        w_axis: with_w(m, translation, 1.0),
    }
}

#[inline(always)]
fn zero<M: Machine>(m: &M) -> V3<M> {
    V3::splat(number(m, 0.0))
}

associated! {
    Mat3Functions for Mat3 {
        from_cols_on(x_axis: Vec3, y_axis: Vec3, z_axis: Vec3) |m| M3 { x_axis, y_axis, z_axis };
        from_diagonal_on(v: Vec3) |m| diagonal(m, v);
        from_mat4_on(a: Mat4) |m| M3 {
            x_axis: xyz(a.x_axis),
            y_axis: xyz(a.y_axis),
            z_axis: xyz(a.z_axis),
        };
    }
    Mat4Functions for Mat4 {
        from_cols_on(x_axis: Vec4, y_axis: Vec4, z_axis: Vec4, w_axis: Vec4) |m|
            M4 { x_axis, y_axis, z_axis, w_axis };
        from_diagonal_on(v: Vec4) |m| {
            let o = number(m, 0.0);
            M4 {
                x_axis: V4 { x: v.x, y: o, z: o, w: o },
                y_axis: V4 { x: o, y: v.y, z: o, w: o },
                z_axis: V4 { x: o, y: o, z: v.z, w: o },
                w_axis: V4 { x: o, y: o, z: o, w: v.w },
            }
        };
        from_mat3_on(a: Mat3) |m| enlarged(m, a, zero(m));
        from_scale_on(v: Vec3) |m| enlarged(m, diagonal(m, v), zero(m));
        from_translation_on(v: Vec3) |m|
            enlarged(m, diagonal(m, V3::splat(number(m, 1.0))), v);
    }
    Affine3Functions for Affine3 {
        from_cols_on(x_axis: Vec3, y_axis: Vec3, z_axis: Vec3, w_axis: Vec3) |m|
            A3 { matrix3: M3 { x_axis, y_axis, z_axis }, translation: w_axis };
        from_mat3_on(matrix3: Mat3) |m| A3 { matrix3, translation: zero(m) };
        from_mat3_translation_on(matrix3: Mat3, translation: Vec3) |m| A3 { matrix3, translation };
        from_scale_on(v: Vec3) |m| A3 { matrix3: diagonal(m, v), translation: zero(m) };
        from_translation_on(translation: Vec3) |m|
            A3 { matrix3: diagonal(m, V3::splat(number(m, 1.0))), translation };
    }
}
