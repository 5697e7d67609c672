//! The methods of lifted code.
//!
//! A method of the source becomes `Method::<{ name("dot") }, M, _>::call(v, m, (w,))`: the name is
//! part of the trait, so that the methods of a user's types and those of the library meet without
//! an import.

use super::{B, Coerce, F, F32Binary, F32Unary, I, IntBinary, Machine, Type, U, V2, V3, V4, Var};
use crate::bvh;
use crate::geometry::{HitOn, Primitive, Ray, RayOn};

/// The number of a method's name (FNV-1a, 64 bits).
pub const fn name(text: &str) -> u64 {
    let bytes = text.as_bytes();
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut i = 0;
    while i < bytes.len() {
        hash = (hash ^ bytes[i] as u64).wrapping_mul(0x0100_0000_01b3);
        i += 1;
    }
    hash
}

/// A method that kernels may call, on a machine.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot call this method with these arguments",
    label = "not an operation of the kernel language",
    note = "a method of your own needs `#[kernel]` on its impl; the book lists the others"
)]
pub trait Method<const NAME: u64, M: Machine, A> {
    /// The result.
    type Output;
    /// Whether it takes `&mut self`.
    const IS_MUT: bool = false;
    /// Calls the method.
    fn call(self, m: &M, args: A) -> Self::Output;
    /// Calls the method on a variable, whose value is `self`.
    #[inline(always)]
    fn call_at(self, variable: &Var<Self>, m: &M, args: A) -> Self::Output
    where
        Self: Copy,
    {
        let _ = variable;
        self.call(m, args)
    }
}

/// Whether a method takes `&mut self`.
#[inline(always)]
pub fn is_mut<const NAME: u64, M: Machine, T: Method<NAME, M, A>, A>(_: &M, _: &T, _: &A) -> bool {
    T::IS_MUT
}

/// Calls a method on an element whose place is computed. The call has a copy of the element, so a
/// method that changes it would change nothing.
///
/// ```compile_fail,E0080
/// use raydsl::kernel;
/// use raydsl::prelude::*;
///
/// #[derive(Clone, Copy, Type)]
/// struct Counter {
///     n: u32,
/// }
///
/// #[kernel]
/// impl Counter {
///     fn next(&mut self) -> u32 {
///         self.n += 1;
///         self.n
///     }
/// }
///
/// #[kernel]
/// fn f(i: u32) -> u32 {
///     let mut all = [Counter { n: 0 }; 2];
///     all[i as usize].next()
/// }
///
/// Kernel::of::<f>();
/// ```
#[inline(always)]
pub fn call_on_element<const NAME: u64, M: Machine, T: Method<NAME, M, A>, A>(
    m: &M,
    element: T,
    args: A,
) -> T::Output {
    const {
        assert!(
            !T::IS_MUT,
            "a kernel has no `&mut self` methods on a computed element: copy the element to a \
             variable, and assign it back after the call"
        );
    }
    element.call(m, args)
}

/// A method of a struct's kernels; the derived twin forwards [`Method`] to it.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot call this method of `{Self}` with these arguments",
    label = "not a kernel",
    note = "write `#[kernel]` on the impl that has the method"
)]
pub trait HostMethod<const NAME: u64, M: Machine, A>: Type {
    /// The result.
    type Output;
    /// Whether it takes `&mut self`.
    const IS_MUT: bool = false;
    /// Calls the method.
    fn call(this: Self::On<M>, m: &M, args: A) -> Self::Output;
    /// Calls the method on a variable, whose value is `this`.
    #[inline(always)]
    fn call_at(this: Self::On<M>, variable: &Var<Self::On<M>>, m: &M, args: A) -> Self::Output {
        let _ = variable;
        Self::call(this, m, args)
    }
}

macro_rules! method {
    ($t:ty, $name:literal, |$m:ident, $s:ident| -> $out:ty { $e:expr }) => {
        impl<M: Machine> Method<{ name($name) }, M, ()> for $t {
            type Output = $out;

            #[inline(always)]
            fn call(self, $m: &M, (): ()) -> $out {
                let $s = self;
                $e
            }
        }
    };
    ($t:ty, $name:literal, |$m:ident, $s:ident, $a:ident: $at:ty| -> $out:ty { $e:expr }) => {
        impl<M: Machine, A: Coerce<M, $at>> Method<{ name($name) }, M, (A,)> for $t {
            type Output = $out;

            #[inline(always)]
            fn call(self, $m: &M, ($a,): (A,)) -> $out {
                let $s = self;
                let $a: $at = $a.coerce($m);
                $e
            }
        }
    };
    (
        $t:ty, $name:literal,
        |$m:ident, $s:ident, $a:ident: $at:ty, $b:ident: $bt:ty| -> $out:ty { $e:expr }
    ) => {
        impl<M: Machine, A1: Coerce<M, $at>, A2: Coerce<M, $bt>>
            Method<{ name($name) }, M, (A1, A2)> for $t
        {
            type Output = $out;

            #[inline(always)]
            fn call(self, $m: &M, ($a, $b): (A1, A2)) -> $out {
                let $s = self;
                let $a: $at = $a.coerce($m);
                let $b: $bt = $b.coerce($m);
                $e
            }
        }
    };
}

// f32

/// std's `min` and `max`: where one operand is NaN they give the other.
#[inline(always)]
fn number_of<M: Machine>(m: &M, op: F32Binary, a: F<M>, b: F<M>) -> F<M> {
    let chosen = m.f32_binary(op, a.0, b.0);
    let a_is_nan = m.f32_compare(super::Compare::Ne, a.0, a.0);
    F(m.f32_select(a_is_nan, b.0, chosen))
}

macro_rules! f32_unary {
    ($($name:literal $op:ident),+) => {
        $(
            method!(F<M>, $name, |m, a| -> F<M> { F(m.f32_unary(F32Unary::$op, a.0)) });
            method!(V2<M>, $name, |m, a| -> V2<M> { V2::unary(m, F32Unary::$op, a) });
            method!(V3<M>, $name, |m, a| -> V3<M> { V3::unary(m, F32Unary::$op, a) });
            method!(V4<M>, $name, |m, a| -> V4<M> { V4::unary(m, F32Unary::$op, a) });
        )+
    };
}

f32_unary!("abs" Abs, "floor" Floor, "ceil" Ceil, "trunc" Trunc);

method!(F<M>, "sqrt", |m, a| -> F<M> { F(m.f32_unary(F32Unary::Sqrt, a.0)) });
method!(F<M>, "min", |m, a, b: F<M>| -> F<M> { number_of(m, F32Binary::Min, a, b) });
method!(F<M>, "max", |m, a, b: F<M>| -> F<M> { number_of(m, F32Binary::Max, a, b) });
method!(F<M>, "clamp", |m, a, lo: F<M>, hi: F<M>| -> F<M> {
    {
        let raised = m.f32_binary(F32Binary::Max, a.0, lo.0);
        F(m.f32_binary(F32Binary::Min, raised, hi.0))
    }
});
method!(F<M>, "mul_add", |m, a, b: F<M>, c: F<M>| -> F<M> { F(m.f32_mul_add(a.0, b.0, c.0)) });
method!(F<M>, "to_bits", |m, a| -> U<M> { U(m.f32_to_bits(a.0)) });
method!(F<M>, "recip", |m, a| -> F<M> { F(m.f32_binary(F32Binary::Div, m.f32(1.0), a.0)) });
method!(F<M>, "copysign", |m, a, sign: F<M>| -> F<M> { F(m.f32_copysign(a.0, sign.0)) });

// Integers

macro_rules! int_methods {
    ($($t:ident $binary:ident $compare:ident $select:ident),+) => {
        $(
            method!($t<M>, "wrapping_add", |m, a, b: $t<M>| -> $t<M> {
                $t(m.$binary(IntBinary::WrappingAdd, a.0, b.0))
            });
            method!($t<M>, "wrapping_sub", |m, a, b: $t<M>| -> $t<M> {
                $t(m.$binary(IntBinary::WrappingSub, a.0, b.0))
            });
            method!($t<M>, "wrapping_mul", |m, a, b: $t<M>| -> $t<M> {
                $t(m.$binary(IntBinary::WrappingMul, a.0, b.0))
            });
            method!($t<M>, "min", |m, a, b: $t<M>| -> $t<M> {
                $t(m.$select(m.$compare(super::Compare::Lt, b.0, a.0), b.0, a.0))
            });
            method!($t<M>, "max", |m, a, b: $t<M>| -> $t<M> {
                $t(m.$select(m.$compare(super::Compare::Lt, a.0, b.0), b.0, a.0))
            });
        )+
    };
}

int_methods!(I i32_binary i32_compare i32_select, U u32_binary u32_compare u32_select);

// Vectors

/// The sum of products, left to right.
#[inline(always)]
fn dot<M: Machine, const N: usize>(m: &M, a: [M::F32; N], b: [M::F32; N]) -> M::F32 {
    let mut sum = m.f32_binary(F32Binary::Mul, a[0], b[0]);
    for i in 1..N {
        sum = m.f32_binary(F32Binary::Add, sum, m.f32_binary(F32Binary::Mul, a[i], b[i]));
    }
    sum
}

macro_rules! vector_methods {
    ($($v:ident),+) => {
        $(
            method!($v<M>, "dot", |m, a, b: $v<M>| -> F<M> { F(dot(m, a.array(), b.array())) });
            method!($v<M>, "length_squared", |m, a| -> F<M> {
                F(dot(m, a.array(), a.array()))
            });
            method!($v<M>, "length", |m, a| -> F<M> {
                F(m.f32_unary(F32Unary::Sqrt, dot(m, a.array(), a.array())))
            });
            method!($v<M>, "normalize", |m, a| -> $v<M> {{
                let length = m.f32_unary(F32Unary::Sqrt, dot(m, a.array(), a.array()));
                let scale = m.f32_binary(F32Binary::Div, m.f32(1.0), length);
                $v::binary(m, F32Binary::Mul, a, $v::splat(F(scale)))
            }});
            method!($v<M>, "min", |m, a, b: $v<M>| -> $v<M> {
                $v::binary(m, F32Binary::Min, b, a)
            });
            method!($v<M>, "max", |m, a, b: $v<M>| -> $v<M> {
                $v::binary(m, F32Binary::Max, b, a)
            });
        )+
    };
}

// Not `Vec4`: glam sums its products in another order on some platforms.
vector_methods!(V2, V3);

method!(V3<M>, "cross", |m, a, b: V3<M>| -> V3<M> {
    {
        let mul = |x: F<M>, y: F<M>| m.f32_binary(F32Binary::Mul, x.0, y.0);
        let minor = |x, y, z, w| F(m.f32_binary(F32Binary::Sub, mul(x, y), mul(z, w)));
        V3 {
            x: minor(a.y, b.z, b.y, a.z),
            y: minor(a.z, b.x, b.z, a.x),
            z: minor(a.x, b.y, b.x, a.y),
        }
    }
});

// glam's `min` and `max` of vectors give the second operand where one is NaN, and its elements are
// compared from the last to the first.
macro_rules! element {
    ($v:ident: $last:ident $($c:ident)*) => {
        method!($v<M>, "min_element", |m, a| -> F<M> {
            [$(a.$c),*].into_iter().fold(a.$last, |x, y| F(m.f32_binary(F32Binary::Min, x.0, y.0)))
        });
        method!($v<M>, "max_element", |m, a| -> F<M> {
            [$(a.$c),*].into_iter().fold(a.$last, |x, y| F(m.f32_binary(F32Binary::Max, x.0, y.0)))
        });
    };
}

element!(V2: y x);
element!(V3: z y x);

method!(V4<M>, "truncate", |_m, a| -> V3<M> { V3 { x: a.x, y: a.y, z: a.z } });
method!(V3<M>, "extend", |_m, a, w: F<M>| -> V4<M> { V4 { x: a.x, y: a.y, z: a.z, w } });

// Rays

impl<M: Machine, A: Coerce<M, F<M>>> HostMethod<{ name("at") }, M, (A,)> for Ray {
    type Output = V3<M>;

    #[inline(always)]
    fn call(ray: RayOn<M>, m: &M, (t,): (A,)) -> V3<M> {
        let way = V3::binary(m, F32Binary::Mul, ray.direction, V3::splat(t.coerce(m)));
        V3::binary(m, F32Binary::Add, ray.origin, way)
    }
}

// Trees and slices of primitives

impl<M: Machine, P: Primitive> Method<{ name("closest_hit") }, M, (RayOn<M>,)> for bvh::On<'_, P> {
    type Output = HitOn<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray,): (RayOn<M>,)) -> HitOn<M> {
        m.closest_hit(&self, ray)
    }
}

impl<M: Machine, P: Primitive> Method<{ name("any_hit") }, M, (RayOn<M>,)> for bvh::On<'_, P> {
    type Output = B<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray,): (RayOn<M>,)) -> B<M> {
        m.any_hit(&self, ray)
    }
}

impl<M: Machine, P: Primitive> Method<{ name("primitive") }, M, (HitOn<M>,)> for bvh::On<'_, P> {
    type Output = P::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (hit,): (HitOn<M>,)) -> P::On<M> {
        let id = m.u32_select(hit.is_hit.0, hit.prim_id.0, m.u32(0));
        m.fetch(&self, U(id))
    }
}
