//! Methods of glam's matrices.

use super::super::matrix::{A3, M3, M4};
use super::super::{
    Coerce, F, Machine, V3, V4,
    vector::{Arithmetic, Vector},
};
use super::float::{div, number};
use super::vector::{cross, dot};
use super::{Method, name, op};

macro_rules! of_matrices {
    ($($t:ident $name:literal, |$m:ident, $s:ident $(, $a:ident: $at:ty)*| -> $out:ty { $e:expr };)+) => {
        $(method!([] $t<M>, $name, |$m, $s $(, $a: $at)*| -> $out { $e });)+
    };
}

of_matrices! {
    M3 "mul_vec3", |m, a, v: V3<M>| -> V3<M> { a.times(m, v) };
    M3 "mul_mat3", |m, a, b: M3<M>| -> M3<M> { super::super::OpMul::mul(m, a, b) };
    M3 "transpose", |_m, a| -> M3<M> { a.transpose() };
    M3 "determinant", |m, a| -> F<M> { dot(m, a.x_axis, cross(m, a.y_axis, a.z_axis)) };
    M3 "inverse", |m, a| -> M3<M> { inverse(m, a) };
    M4 "mul_vec4", |m, a, v: V4<M>| -> V4<M> { a.times(m, v) };
    M4 "mul_mat4", |m, a, b: M4<M>| -> M4<M> { super::super::OpMul::mul(m, a, b) };
    M4 "transpose", |_m, a| -> M4<M> { a.transpose() };
    M4 "transform_point3", |m, a, p: V3<M>| -> V3<M> { a.transform_point(m, p) };
    M4 "transform_vector3", |m, a, v: V3<M>| -> V3<M> { a.transform_vector(m, v) };
    M4 "project_point3", |m, a, p: V3<M>| -> V3<M> { a.project_point(m, p) };
    A3 "transform_point3", |m, a, p: V3<M>| -> V3<M> { a.transform_point(m, p) };
    A3 "transform_vector3", |m, a, v: V3<M>| -> V3<M> { a.transform_vector(m, v) };
    A3 "inverse", |m, a| -> A3<M> { inverse_affine(m, a) };
}

/// Inverts by cofactors, as glam does on every platform.
#[inline(always)]
pub(crate) fn inverse<M: Machine>(m: &M, a: M3<M>) -> M3<M> {
    let yz = cross(m, a.y_axis, a.z_axis);
    let zx = cross(m, a.z_axis, a.x_axis);
    let xy = cross(m, a.x_axis, a.y_axis);
    let scale = V3::splat(div(m, number(m, 1.0), dot(m, a.x_axis, yz)));
    let scaled = |v| Vector::arithmetic(m, op::Mul, v, scale);
    M3 { x_axis: scaled(yz), y_axis: scaled(zx), z_axis: scaled(xy) }.transpose()
}

#[inline(always)]
pub(crate) fn inverse_affine<M: Machine>(m: &M, a: A3<M>) -> A3<M> {
    let matrix3 = inverse(m, a.matrix3);
    let moved = matrix3.times(m, a.translation);
    A3 {
        matrix3,
        translation: moved.each(
            #[inline(always)]
            |c| Arithmetic::neg(m, c),
        ),
    }
}

denied! { M4<M>:
    InverseInOrder "`Mat4::inverse` has other results on other machines"
        "write `inverse(m)`, the function of raydsl's prelude"
        "inverse" -> M4<M>;
    DeterminantInOrder "`Mat4::determinant` has other results on other machines"
        "write `determinant(m)`, the function of raydsl's prelude"
        "determinant" -> F<M>;
}
