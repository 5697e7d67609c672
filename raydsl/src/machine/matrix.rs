//! Matrices: the twins of glam's `Mat3`, `Mat4` and `Affine3`, stored as columns.
//!
//! Products are sums of scaled columns from the first to the last, as glam has them on every
//! platform; nothing is fused. WGSL has matrices too, but leaves the order of its sums open, so
//! there a matrix is a struct of columns.

use glam::{Affine3, Mat3, Mat4, Vec3, Vec4};

use super::vector::Floats;
use super::{
    F, Field, LaneMachine, Leaves, Machine, OpAdd, OpDiv, OpMul, OpNeg, OpSub, Schema, Type, V3,
    V4, Value, Varying, kernel_type, op,
};

macro_rules! columns {
    ($host:ident => $twin:ident { $($c:ident: $t:ty),+ }) => {
        #[doc = concat!("`", stringify!($host), "` on machine `M`.")]
        #[allow(missing_docs, reason = "the members are those of glam's type")]
        pub struct $twin<M: Machine> {
            $(pub $c: <$t as Type>::On<M>,)+
        }

        impl<M: Machine> Clone for $twin<M> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<M: Machine> Copy for $twin<M> {}

        impl<M: Machine> Value<M> for $twin<M> {
            const SCHEMA: &'static Schema = <$host as Type>::SCHEMA;

            #[inline(always)]
            fn zero(m: &M) -> Self {
                Self { $($c: Value::zero(m)),+ }
            }

            #[inline(always)]
            fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
                Self { $($c: Value::zip(m, a.$c, b.$c, f)),+ }
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine> Varying<M> for $twin<M> {
            type Value = Self;

            #[inline(always)]
            fn varying(self, _: &M) -> Self {
                self
            }
        }

        kernel_type!(() $host);

        impl Type for $host {
            type On<M: Machine> = $twin<M>;

            const SCHEMA: &'static Schema = &Schema::Struct {
                name: stringify!($host),
                fields: &[$(Field {
                    name: stringify!($c),
                    offset: core::mem::offset_of!($host, $c),
                    schema: <$t as Type>::SCHEMA,
                }),+],
                size: size_of::<$host>(),
            };

            #[inline(always)]
            fn splat<M: Machine>(m: &M, v: Self) -> $twin<M> {
                $twin { $($c: <$t as Type>::splat(m, v.$c)),+ }
            }

            #[inline(always)]
            fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> $twin<M> {
                $twin { $($c: <$t as Type>::from_lanes(m, #[inline(always)] |l| f(l).$c)),+ }
            }

            #[inline(always)]
            fn lane<M: LaneMachine>(v: &$twin<M>, lane: usize) -> Self {
                Self { $($c: <$t as Type>::lane(&v.$c, lane)),+ }
            }

            fn write(&self, out: &mut [u8]) {
                $(Type::write(&self.$c, &mut out[core::mem::offset_of!($host, $c)..]);)+
            }

            fn read(bytes: &[u8]) -> Self {
                Self { $($c: <$t as Type>::read(&bytes[core::mem::offset_of!($host, $c)..])),+ }
            }
        }
    };
}

columns!(Mat3 => M3 { x_axis: Vec3, y_axis: Vec3, z_axis: Vec3 });
columns!(Mat4 => M4 { x_axis: Vec4, y_axis: Vec4, z_axis: Vec4, w_axis: Vec4 });
columns!(Affine3 => A3 { matrix3: Mat3, translation: Vec3 });

/// Adds `column * v` to the sum, or begins it.
macro_rules! sum_of_columns {
    ($m:ident: $v:ident; $first:expr, $s:expr $(; $next:expr, $t:expr)*) => {{
        let sum = $v::binary($m, op::Mul, $first, $v::splat($s));
        $(
            let part = $v::binary($m, op::Mul, $next, $v::splat($t));
            let sum = $v::binary($m, op::Add, sum, part);
        )*
        sum
    }};
}

impl<M: Machine> M3<M> {
    #[inline(always)]
    pub(super) fn times(self, m: &M, v: V3<M>) -> V3<M> {
        sum_of_columns!(m: V3; self.x_axis, v.x; self.y_axis, v.y; self.z_axis, v.z)
    }

    #[inline(always)]
    pub(super) fn transpose(self) -> Self {
        let (a, b, c) = (self.x_axis, self.y_axis, self.z_axis);
        Self {
            x_axis: V3 { x: a.x, y: b.x, z: c.x },
            y_axis: V3 { x: a.y, y: b.y, z: c.y },
            z_axis: V3 { x: a.z, y: b.z, z: c.z },
        }
    }

    #[inline(always)]
    fn each(self, f: impl Fn(V3<M>) -> V3<M>) -> Self {
        Self { x_axis: f(self.x_axis), y_axis: f(self.y_axis), z_axis: f(self.z_axis) }
    }

    #[inline(always)]
    fn both(self, b: Self, f: impl Fn(V3<M>, V3<M>) -> V3<M>) -> Self {
        Self {
            x_axis: f(self.x_axis, b.x_axis),
            y_axis: f(self.y_axis, b.y_axis),
            z_axis: f(self.z_axis, b.z_axis),
        }
    }
}

impl<M: Machine> M4<M> {
    #[inline(always)]
    pub(super) fn times(self, m: &M, v: V4<M>) -> V4<M> {
        sum_of_columns!(m: V4;
            self.x_axis, v.x; self.y_axis, v.y; self.z_axis, v.z; self.w_axis, v.w)
    }

    #[inline(always)]
    pub(super) fn transpose(self) -> Self {
        let (a, b, c, d) = (self.x_axis, self.y_axis, self.z_axis, self.w_axis);
        Self {
            x_axis: V4 { x: a.x, y: b.x, z: c.x, w: d.x },
            y_axis: V4 { x: a.y, y: b.y, z: c.y, w: d.y },
            z_axis: V4 { x: a.z, y: b.z, z: c.z, w: d.z },
            w_axis: V4 { x: a.w, y: b.w, z: c.w, w: d.w },
        }
    }

    #[inline(always)]
    fn each(self, f: impl Fn(V4<M>) -> V4<M>) -> Self {
        Self {
            x_axis: f(self.x_axis),
            y_axis: f(self.y_axis),
            z_axis: f(self.z_axis),
            w_axis: f(self.w_axis),
        }
    }

    #[inline(always)]
    fn both(self, b: Self, f: impl Fn(V4<M>, V4<M>) -> V4<M>) -> Self {
        Self {
            x_axis: f(self.x_axis, b.x_axis),
            y_axis: f(self.y_axis, b.y_axis),
            z_axis: f(self.z_axis, b.z_axis),
            w_axis: f(self.w_axis, b.w_axis),
        }
    }

    /// Returns the sum of the first three columns without their last row, each scaled by a
    /// component of `v`.
    #[inline(always)]
    fn upper(self, m: &M, v: V3<M>) -> V3<M> {
        let (a, b, c) = (xyz(self.x_axis), xyz(self.y_axis), xyz(self.z_axis));
        M3 { x_axis: a, y_axis: b, z_axis: c }.times(m, v)
    }

    #[inline(always)]
    pub(super) fn transform_vector(self, m: &M, v: V3<M>) -> V3<M> {
        self.upper(m, v)
    }

    #[inline(always)]
    pub(super) fn transform_point(self, m: &M, p: V3<M>) -> V3<M> {
        V3::binary(m, op::Add, xyz(self.w_axis), self.upper(m, p))
    }

    #[inline(always)]
    pub(super) fn project_point(self, m: &M, p: V3<M>) -> V3<M> {
        let sum = sum_of_columns!(m: V4; self.x_axis, p.x; self.y_axis, p.y; self.z_axis, p.z);
        let sum = V4::binary(m, op::Add, self.w_axis, sum);
        xyz(V4::binary(m, op::Div, sum, V4::splat(sum.w)))
    }
}

#[inline(always)]
pub(super) fn xyz<M: Machine>(v: V4<M>) -> V3<M> {
    V3 { x: v.x, y: v.y, z: v.z }
}

impl<M: Machine> A3<M> {
    #[inline(always)]
    pub(super) fn transform_vector(self, m: &M, v: V3<M>) -> V3<M> {
        self.matrix3.times(m, v)
    }

    #[inline(always)]
    pub(super) fn transform_point(self, m: &M, p: V3<M>) -> V3<M> {
        V3::binary(m, op::Add, self.matrix3.times(m, p), self.translation)
    }
}

macro_rules! operator {
    ($trait:ident :: $method:ident, $a:ty, $b:ty => $out:ty, |$m:ident, $x:ident, $y:ident| $e:expr) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> $trait<M, $b> for $a {
            type Output = $out;

            #[inline(always)]
            fn $method($m: &M, $x: $a, $y: $b) -> $out {
                $e
            }
        }
    };
}

macro_rules! matrix_operators {
    ($t:ident of $v:ident) => {
        operator!(OpMul::mul, $t<M>, $v<M> => $v<M>, |m, a, b| a.times(m, b));
        operator!(OpMul::mul, $t<M>, $t<M> => $t<M>, |m, a, b| {
            b.each(#[inline(always)] |column| a.times(m, column))
        });
        operator!(OpMul::mul, $t<M>, F<M> => $t<M>, |m, a, b| {
            a.each(#[inline(always)] |column| $v::binary(m, op::Mul, column, $v::splat(b)))
        });
        operator!(OpMul::mul, F<M>, $t<M> => $t<M>, |m, a, b| OpMul::mul(m, b, a));
        operator!(OpDiv::div, $t<M>, F<M> => $t<M>, |m, a, b| {
            a.each(#[inline(always)] |column| $v::binary(m, op::Div, column, $v::splat(b)))
        });
        operator!(OpAdd::add, $t<M>, $t<M> => $t<M>, |m, a, b| {
            a.both(b, #[inline(always)] |x, y| $v::binary(m, op::Add, x, y))
        });
        operator!(OpSub::sub, $t<M>, $t<M> => $t<M>, |m, a, b| {
            a.both(b, #[inline(always)] |x, y| $v::binary(m, op::Sub, x, y))
        });

        #[diagnostic::do_not_recommend]
        impl<M: Machine> OpNeg<M> for $t<M> {
            #[inline(always)]
            fn neg(m: &M, a: Self) -> Self {
                a.each(#[inline(always)] |column| OpNeg::neg(m, column))
            }
        }
    };
}

matrix_operators!(M3 of V3);
matrix_operators!(M4 of V4);

operator!(OpMul::mul, A3<M>, A3<M> => A3<M>, |m, a, b| A3 {
    matrix3: OpMul::mul(m, a.matrix3, b.matrix3),
    translation: OpAdd::add(m, a.matrix3.times(m, b.translation), a.translation),
});
