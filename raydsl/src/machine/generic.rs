//! Prelude functions over several types: `min`, `select`, `dot`, `inverse` and their like.
//!
//! Each is a generic function of the host, and beside it a type of the same name whose `on` is the
//! lifted function. Every sum has its documented order on every machine.

#![allow(non_camel_case_types, reason = "they have the names of functions")]

use core::ops::{Mul, Sub};

use glam::{
    Affine3, BVec2, BVec3, BVec4, BVec4A, IVec2, IVec3, IVec4, Mat3, Mat4, UVec2, UVec3, UVec4,
    Vec2, Vec3, Vec4,
};

use super::index::choose;
use super::matrix::{A3, M3, M4};
use super::methods as lifted;
use super::vector::{Arithmetic, Floats, Vector};
use super::{
    B, BoolBinary, Coerce, F, F32Binary, I, Machine, Op, U, V3, Value, Varying, X2, X3, X4, op,
};

/// The types of [`min()`], [`max()`] and [`clamp()`]: numbers and vectors of numbers.
pub trait Ordered: Copy {
    /// Returns `if b < a { b } else { a }`, for each component.
    fn least(a: Self, b: Self) -> Self;
    /// Returns `if a < b { b } else { a }`, for each component.
    fn greatest(a: Self, b: Self) -> Self;
}

macro_rules! ordered {
    ($($t:ty),+; $($v:ident($($c:ident)+)),+) => {
        $(
            impl Ordered for $t {
                #[inline(always)]
                fn least(a: Self, b: Self) -> Self {
                    if b < a { b } else { a }
                }

                #[inline(always)]
                fn greatest(a: Self, b: Self) -> Self {
                    if a < b { b } else { a }
                }
            }
        )+
        $(
            impl Ordered for $v {
                #[inline(always)]
                fn least(a: Self, b: Self) -> Self {
                    Self::new($(min(a.$c, b.$c)),+)
                }

                #[inline(always)]
                fn greatest(a: Self, b: Self) -> Self {
                    Self::new($(max(a.$c, b.$c)),+)
                }
            }
        )+
    };
}

ordered!(
    f32, i32, u32;
    Vec2(x y), Vec3(x y z), Vec4(x y z w),
    IVec2(x y), IVec3(x y z), IVec4(x y z w),
    UVec2(x y), UVec3(x y z), UVec4(x y z w)
);

/// Returns the smaller number, for vectors of each component: `if b < a { b } else { a }`, so a NaN
/// `b` gives `a`.
#[inline(always)]
pub fn min<T: Ordered>(a: T, b: T) -> T {
    T::least(a, b)
}

/// Returns the larger number, for vectors of each component: `if a < b { b } else { a }`, so a NaN
/// `b` gives `a`.
#[inline(always)]
pub fn max<T: Ordered>(a: T, b: T) -> T {
    T::greatest(a, b)
}

/// Clamps `x` to `low` and `high`: `min(max(x, low), high)`.
#[inline(always)]
pub fn clamp<T: Ordered>(x: T, low: T, high: T) -> T {
    min(max(x, low), high)
}

/// Returns `a` where `c` holds, else `b`. Both are evaluated: in packets this is faster than an
/// `if` for cheap sides.
#[inline(always)]
pub fn select<T>(c: bool, a: T, b: T) -> T {
    if c { a } else { b }
}

/// The mask types of glam's comparisons.
pub trait MaskVector: Copy {
    /// Returns whether any component holds.
    fn has_any(self) -> bool;
    /// Returns whether all components hold.
    fn has_all(self) -> bool;
}

macro_rules! mask_vector {
    ($($t:ty),+) => {
        $(
            impl MaskVector for $t {
                #[inline(always)]
                fn has_any(self) -> bool {
                    self.any()
                }

                #[inline(always)]
                fn has_all(self) -> bool {
                    self.all()
                }
            }
        )+
    };
}

mask_vector!(BVec2, BVec3, BVec4, BVec4A);

/// Returns whether any component of a mask holds, as in `any(a.cmplt(b))`. It concerns one ray
/// alone, never others of a packet.
#[inline(always)]
pub fn any(mask: impl MaskVector) -> bool {
    mask.has_any()
}

/// Returns whether all components of a mask hold.
#[inline(always)]
pub fn all(mask: impl MaskVector) -> bool {
    mask.has_all()
}

/// A vector with a [`dot()`] product.
pub trait Dot: Copy {
    /// The component type.
    type Component;
    /// Returns the sum of products from the first component to the last.
    fn dot_in_order(self, b: Self) -> Self::Component;
}

macro_rules! dot {
    ($($t:ident $c:ident: $x:ident $($y:ident)+;)+) => {
        $(
            impl Dot for $t {
                type Component = $c;

                #[inline(always)]
                fn dot_in_order(self, b: Self) -> $c {
                    self.$x * b.$x $(+ self.$y * b.$y)+
                }
            }
        )+
    };
}

dot! {
    Vec2 f32: x y;
    Vec3 f32: x y z;
    Vec4 f32: x y z w;
    IVec2 i32: x y;
    IVec3 i32: x y z;
    IVec4 i32: x y z w;
    UVec2 u32: x y;
    UVec3 u32: x y z;
    UVec4 u32: x y z w;
}

/// Returns the dot product, summed from `x` to the last component. For `Vec2` and `Vec3` it is
/// glam's; `Vec4::dot` sums in another order on some machines, so kernels do not have it:
///
/// ```compile_fail,E0277
/// use raydsl::kernel;
/// use raydsl::prelude::*;
///
/// #[kernel]
/// fn f(a: Vec4, b: Vec4) -> f32 {
///     a.dot(b) // note: write `dot(a, b)`
/// }
/// ```
#[inline(always)]
pub fn dot<V: Dot>(a: V, b: V) -> V::Component {
    a.dot_in_order(b)
}

/// Returns the length: `dot(v, v).sqrt()`.
#[inline(always)]
pub fn length<V: Dot<Component = f32>>(v: V) -> f32 {
    dot(v, v).sqrt()
}

/// Returns the distance between two points: `length(a - b)`.
#[inline(always)]
pub fn distance<V: Dot<Component = f32> + Sub<Output = V>>(a: V, b: V) -> f32 {
    length(a - b)
}

/// Returns `v * (1.0 / length(v))`: not finite for a vector of length 0.
#[inline(always)]
pub fn normalize<V: Dot<Component = f32> + Mul<f32, Output = V>>(v: V) -> V {
    v * (1.0 / length(v))
}

/// A matrix with an [`inverse()`].
pub trait Invertible: Copy {
    /// Returns the inverse; not finite if there is none.
    fn inverted(self) -> Self;
}

impl Invertible for Mat3 {
    #[inline(always)]
    fn inverted(self) -> Self {
        self.inverse()
    }
}

impl Invertible for Affine3 {
    #[inline(always)]
    fn inverted(self) -> Self {
        self.inverse()
    }
}

impl Invertible for Mat4 {
    #[inline(always)]
    fn inverted(self) -> Self {
        super::inverse::inverse_mat4(self)
    }
}

/// Returns the inverse of a matrix; not finite if there is none. For `Mat3` and `Affine3` it is
/// glam's. `Mat4::inverse` differs from one machine to the next; this is Lengyel's ("Foundations of
/// Game Engine Development", volume 1, 2016, section 1.7), by cross products of its columns.
#[inline(always)]
pub fn inverse<T: Invertible>(m: T) -> T {
    m.inverted()
}

/// A matrix with a [`determinant()`].
pub trait Square: Copy {
    /// Returns the determinant.
    fn determined(self) -> f32;
}

impl Square for Mat3 {
    #[inline(always)]
    fn determined(self) -> f32 {
        self.determinant()
    }
}

impl Square for Mat4 {
    #[inline(always)]
    fn determined(self) -> f32 {
        super::inverse::determinant_mat4(self)
    }
}

/// Returns the determinant of a matrix. For `Mat3` it is glam's, for `Mat4` that of [`inverse()`].
#[inline(always)]
pub fn determinant<T: Square>(m: T) -> f32 {
    m.determined()
}

/// A transform of points and directions.
pub trait Transform: Copy {
    /// Transforms a point.
    fn point(self, p: Vec3) -> Vec3;
    /// Transforms a direction, without translation.
    fn vector(self, v: Vec3) -> Vec3;
}

macro_rules! transform {
    ($($t:ty),+) => {
        $(
            impl Transform for $t {
                #[inline(always)]
                fn point(self, p: Vec3) -> Vec3 {
                    self.transform_point3(p)
                }

                #[inline(always)]
                fn vector(self, v: Vec3) -> Vec3 {
                    self.transform_vector3(v)
                }
            }
        )+
    };
}

transform!(Mat4, Affine3);

/// Transforms the point `p` by an affine transform, a `Mat4` with last row `0 0 0 1` or an
/// `Affine3`: glam's `transform_point3`.
#[inline(always)]
pub fn transform_point<T: Transform>(t: T, p: Vec3) -> Vec3 {
    t.point(p)
}

/// Transforms the direction `v` by an affine transform, without translation: glam's
/// `transform_vector3`.
#[inline(always)]
pub fn transform_vector<T: Transform>(t: T, v: Vec3) -> Vec3 {
    t.vector(v)
}

// Lifted

/// Two arguments of one type, either of which may be a number of the source.
#[diagnostic::on_unimplemented(
    message = "these two values do not have one type",
    label = "another type than the value beside it",
    note = "convert a number with `as`, as in `max(x, n as f32)`"
)]
pub trait Alike<M: Machine, R> {
    /// The common type on the machine.
    type Value: Value<M>;
    /// Converts both arguments.
    fn alike(self, m: &M, r: R) -> (Self::Value, Self::Value);
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Varying<M>> Alike<M, V> for V {
    type Value = V::Value;

    #[inline(always)]
    fn alike(self, m: &M, r: V) -> (V::Value, V::Value) {
        (self.varying(m), r.varying(m))
    }
}

macro_rules! alike {
    ($($host:ident $twin:ident),+) => {
        $(
            alike!(@one $host, $twin<M>, $twin);
            alike!(@one $twin<M>, $host, $twin);
        )+
    };
    (@one $a:ty, $b:ty, $twin:ident) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> Alike<M, $b> for $a {
            type Value = $twin<M>;

            #[inline(always)]
            fn alike(self, m: &M, r: $b) -> ($twin<M>, $twin<M>) {
                (self.coerce(m), r.coerce(m))
            }
        }
    };
}

alike!(i32 I, u32 U, bool B);

/// [`Ordered`] on a machine.
#[diagnostic::on_unimplemented(
    message = "a kernel has no `min`, `max` and `clamp` of this value",
    label = "neither a number nor a vector of numbers"
)]
pub trait OrderedOn<M: Machine>: Value<M> {
    /// Returns the minimum or the maximum.
    fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self;
}

macro_rules! ordered_on {
    ($($t:ident),+; $($v:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> OrderedOn<M> for $t<M> {
                #[inline(always)]
                fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self {
                    Arithmetic::extreme(m, op, a, b)
                }
            }
        )+
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine, E: Arithmetic<M>> OrderedOn<M> for $v<E> {
                #[inline(always)]
                fn extreme<O: Op<F32Binary>>(m: &M, op: O, a: Self, b: Self) -> Self {
                    Vector::extreme(m, op, a, b)
                }
            }
        )+
    };
}

ordered_on!(F, I, U; X2, X3, X4);

/// [`Invertible`] on a machine.
pub trait InvertibleOn<M: Machine>: Value<M> {
    /// Returns the inverse.
    fn inverted(m: &M, a: Self) -> Self;
}

impl<M: Machine> InvertibleOn<M> for M3<M> {
    #[inline(always)]
    fn inverted(m: &M, a: Self) -> Self {
        lifted::inverse(m, a)
    }
}

impl<M: Machine> InvertibleOn<M> for A3<M> {
    #[inline(always)]
    fn inverted(m: &M, a: Self) -> Self {
        lifted::inverse_affine(m, a)
    }
}

impl<M: Machine> InvertibleOn<M> for M4<M> {
    #[inline(always)]
    fn inverted(m: &M, a: Self) -> Self {
        super::inverse::inverse_mat4::on(m, a)
    }
}

/// [`Square`] on a machine.
pub trait SquareOn<M: Machine>: Value<M> {
    /// Returns the determinant.
    fn determined(m: &M, a: Self) -> F<M>;
}

impl<M: Machine> SquareOn<M> for M3<M> {
    #[inline(always)]
    fn determined(m: &M, a: Self) -> F<M> {
        lifted::dot(m, a.x_axis, lifted::cross(m, a.y_axis, a.z_axis))
    }
}

impl<M: Machine> SquareOn<M> for M4<M> {
    #[inline(always)]
    fn determined(m: &M, a: Self) -> F<M> {
        super::inverse::determinant_mat4::on(m, a)
    }
}

/// [`Transform`] on a machine.
pub trait TransformOn<M: Machine>: Value<M> {
    /// Transforms a point.
    fn point(m: &M, t: Self, p: V3<M>) -> V3<M>;
    /// Transforms a direction, without translation.
    fn vector(m: &M, t: Self, v: V3<M>) -> V3<M>;
}

macro_rules! transform_on {
    ($($t:ident),+) => {
        $(
            impl<M: Machine> TransformOn<M> for $t<M> {
                #[inline(always)]
                fn point(m: &M, t: Self, p: V3<M>) -> V3<M> {
                    t.transform_point(m, p)
                }

                #[inline(always)]
                fn vector(m: &M, t: Self, v: V3<M>) -> V3<M> {
                    t.transform_vector(m, v)
                }
            }
        )+
    };
}

transform_on!(M4, A3);

macro_rules! lifted {
    ($($name:ident [$($g:tt)*]($m:ident $(, $a:ident: $at:ty)+) -> $out:ty { $e:expr })+) => {
        $(
            #[doc(hidden)]
            #[derive(Debug)]
            pub enum $name {}

            impl $name {
                #[doc(hidden)]
                #[inline(always)]
                pub fn on<M: Machine, $($g)*>($m: &M $(, $a: $at)+) -> $out {
                    $e
                }
            }
        )+
    };
}

#[inline(always)]
fn join<M: Machine, V: Vector<M, Component = B<M>>>(m: &M, op: impl Op<BoolBinary>, v: V) -> B<M> {
    v.fold(
        #[inline(always)]
        |x, y| B(m.bool_binary(op, x.0, y.0)),
    )
}

lifted! {
    min[A: Alike<M, R, Value: OrderedOn<M>>, R](m, a: A, b: R) -> A::Value {{
        let (a, b) = a.alike(m, b);
        OrderedOn::extreme(m, op::Min, a, b)
    }}
    max[A: Alike<M, R, Value: OrderedOn<M>>, R](m, a: A, b: R) -> A::Value {{
        let (a, b) = a.alike(m, b);
        OrderedOn::extreme(m, op::Max, a, b)
    }}
    clamp[A: Alike<M, R, Value: OrderedOn<M>>, R](
        m, x: A, low: R, high: impl Coerce<M, A::Value>
    ) -> A::Value {{
        let (x, low) = x.alike(m, low);
        OrderedOn::extreme(m, op::Min, OrderedOn::extreme(m, op::Max, x, low), high.coerce(m))
    }}
    select[A: Alike<M, R>, R](m, c: impl Coerce<M, B<M>>, a: A, b: R) -> A::Value {{
        let (a, b) = a.alike(m, b);
        choose(m, c.coerce(m).0, a, b)
    }}
    any[V: Vector<M, Component = B<M>>](m, mask: V) -> B<M> { join(m, op::Or, mask) }
    all[V: Vector<M, Component = B<M>>](m, mask: V) -> B<M> { join(m, op::And, mask) }
    dot[C: Arithmetic<M>, V: Vector<M, Component = C, Of<C> = V>](m, a: V, b: V) -> C {
        lifted::dot(m, a, b)
    }
    length[V: Floats<M>](m, v: V) -> F<M> {
        F(m.f32_unary(op::Sqrt, lifted::dot(m, v, v).0))
    }
    distance[V: Floats<M>](m, a: V, b: V) -> F<M> {
        length::on(m, V::arithmetic(m, op::Sub, a, b))
    }
    normalize[V: Floats<M>](m, v: V) -> V { lifted::normalize(m, v) }
    inverse[T: InvertibleOn<M>](m, a: T) -> T { T::inverted(m, a) }
    determinant[T: SquareOn<M>](m, a: T) -> F<M> { T::determined(m, a) }
    transform_point[T: TransformOn<M>](m, t: T, p: V3<M>) -> V3<M> { T::point(m, t, p) }
    transform_vector[T: TransformOn<M>](m, t: T, v: V3<M>) -> V3<M> { T::vector(m, t, v) }
}
