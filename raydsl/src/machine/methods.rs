//! The methods of lifted code.
//!
//! A method of the source becomes `Method::<{ name("dot") }, M, _>::call(v, m, (w,))`: the name is
//! part of the trait, so that the methods of a user's types and those of the library meet without
//! an import.

use glam::Affine3;

use super::{A3, B, Coerce, Machine, Type, U, Usize, V3, Var, op};
use crate::bvh::{SceneView, View};
use crate::geometry::{HitOn, Primitive, RayOn, transform_normal_back};

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
    note = "a method of your own needs `#[kernel]` on its impl; the chapter \"The language\" of the \
            book lists those that are there",
    note = "a method of a trait on a member or an element of a generic type needs a variable with \
            the type: `let light: L = self.light;`"
)]
pub trait Method<const NAME: u64, M: Machine, A, Via = ()> {
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
pub fn is_mut<const NAME: u64, M: Machine, T: Method<NAME, M, A, Via>, A, Via>(
    _: &M,
    _: &T,
    _: &A,
) -> bool {
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
pub fn call_on_element<const NAME: u64, M: Machine, T: Method<NAME, M, A, Via>, A, Via>(
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
///
/// `Via` is [`Through`] the trait that has the method: two traits of one type may have methods of
/// one name. Calls do not name it; where one impl alone fits, rustc finds it.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot call this method of `{Self}` with these arguments",
    label = "not a kernel",
    note = "write `#[kernel]` on the impl that has the method; a method that a trait provides is \
            called by its path: `P::twice(&p)`"
)]
pub trait HostMethod<const NAME: u64, M: Machine, A, Via = ()> {
    /// The struct's twin.
    type This: Copy;
    /// The result.
    type Output;
    /// Whether it takes `&mut self`.
    const IS_MUT: bool = false;
    /// Calls the method.
    fn call(this: Self::This, m: &M, args: A) -> Self::Output;
    /// Calls the method on a variable, whose value is `this`.
    #[inline(always)]
    fn call_at(this: Self::This, variable: &Var<Self::This>, m: &M, args: A) -> Self::Output {
        let _ = variable;
        Self::call(this, m, args)
    }
}

/// An `impl` of a trait, by the number of its name, which has a method.
pub struct Through<const TRAIT: u64>;

/// `method!([generics] Type, "name", |m, self, argument: Type, ..| -> Result { .. })`.
macro_rules! method {
    ([$($g:tt)*] $t:ty, $name:literal, |$m:ident, $s:ident| -> $out:ty { $e:expr }) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, $($g)*> Method<{ name($name) }, M, ()> for $t {
            type Output = $out;

            #[inline(always)]
            fn call(self, $m: &M, (): ()) -> $out {
                let $s = self;
                $e
            }
        }
    };
    (
        [$($g:tt)*] $t:ty, $name:literal,
        |$m:ident, $s:ident, $a:ident: $at:ty| -> $out:ty { $e:expr }
    ) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, A1: Coerce<M, $at>, $($g)*> Method<{ name($name) }, M, (A1,)> for $t {
            type Output = $out;

            #[inline(always)]
            fn call(self, $m: &M, ($a,): (A1,)) -> $out {
                let $s = self;
                let $a: $at = $a.coerce($m);
                $e
            }
        }
    };
    (
        [$($g:tt)*] $t:ty, $name:literal,
        |$m:ident, $s:ident, $a:ident: $at:ty, $b:ident: $bt:ty| -> $out:ty { $e:expr }
    ) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, A1: Coerce<M, $at>, A2: Coerce<M, $bt>, $($g)*>
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

/// Methods that a type of glam's or std's has, but not with one result on every machine. The impl
/// asks for a bound that never holds, whose message is the error: it names the remedy.
macro_rules! denied {
    ($t:ty: $($marker:ident $what:literal $write:literal $($name:literal)+ -> $out:ty;)+) => {
        $(
            #[doc = $what]
            pub struct $marker<M>(core::marker::PhantomData<M>);

            const _: () = {
                #[diagnostic::on_unimplemented(
                    message = $what,
                    label = "not the same on every machine",
                    note = $write
                )]
                pub trait SameOnEveryMachine {}

                $(
                    impl<M: Machine, A> Method<{ name($name) }, M, A> for $t
                    where
                        $marker<M>: SameOnEveryMachine,
                    {
                        type Output = $out;

                        fn call(self, _: &M, _: A) -> $out {
                            unreachable!()
                        }
                    }
                )+
            };
        )+
    };
}

mod float;
mod integer;
mod matrix;
mod swizzle;
mod vector;

pub(crate) use matrix::{inverse, inverse_affine};
pub(crate) use vector::{cross, dot, normalize};

// Sizes

method!([] Usize<M>, "min", |m, a, b: Usize<M>| -> Usize<M> {
    Usize(m.u32_select(m.u32_compare(op::Lt, b.0, a.0), b.0, a.0))
});
method!([] Usize<M>, "max", |m, a, b: Usize<M>| -> Usize<M> {
    Usize(m.u32_select(m.u32_compare(op::Lt, a.0, b.0), b.0, a.0))
});
method!([] Usize<M>, "wrapping_add", |m, a, b: Usize<M>| -> Usize<M> {
    Usize(m.u32_binary(op::WrappingAdd, a.0, b.0))
});
method!([] Usize<M>, "wrapping_sub", |m, a, b: Usize<M>| -> Usize<M> {
    Usize(m.u32_binary(op::WrappingSub, a.0, b.0))
});
method!([] Usize<M>, "saturating_sub", |m, a, b: Usize<M>| -> Usize<M> {
    {
        let difference = m.u32_binary(op::WrappingSub, a.0, b.0);
        let below = m.u32_compare(op::Lt, a.0, b.0);
        Usize(m.u32_select(below, m.u32(0), difference))
    }
});

// Slices, and trees over primitives

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type, S: Type> Method<{ name("len") }, M, ()> for View<'_, T, S> {
    type Output = Usize<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> Usize<M> {
        Usize(m.len(&self).0)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type, S: Type> Method<{ name("is_empty") }, M, ()> for View<'_, T, S> {
    type Output = B<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> B<M> {
        B(m.u32_compare(op::Eq, m.len(&self).0, m.u32(0)))
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: super::Value<M>, const N: usize> Method<{ name("len") }, M, ()> for [V; N] {
    type Output = usize;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> usize {
        N
    }
}

/// Queries of a captured array, which is a value of the kernel: rays meet primitives in memory.
pub struct PrimitivesOfValue<M>(core::marker::PhantomData<M>);

const _: () = {
    #[diagnostic::on_unimplemented(
        message = "rays do not meet the primitives of a captured array",
        label = "an array is a value of the kernel, and a slice lies in memory",
        note = "capture a slice of it: `let shapes = &shapes[..];` before the kernel"
    )]
    pub trait InMemory {}

    macro_rules! queries {
        ($($name:literal -> $out:ty;)+) => {
            $(
                impl<M: Machine, A, V: super::Value<M>, const N: usize>
                    Method<{ name($name) }, M, A> for [V; N]
                where
                    PrimitivesOfValue<M>: InMemory,
                {
                    type Output = $out;

                    fn call(self, _: &M, _: A) -> $out {
                        unreachable!()
                    }
                }
            )+
        };
    }

    queries! {
        "closest_hit" -> HitOn<M>;
        "closest_hit_each" -> [HitOn<M>; 1];
        "closest_hit_where" -> HitOn<M>;
        "any_hit" -> B<M>;
        "any_hit_each" -> [B<M>; 1];
        "any_hit_where" -> B<M>;
        "multi_hit" -> [HitOn<M>; 1];
        "multi_hit_by" -> [HitOn<M>; 1];
        "multi_hit_where" -> [HitOn<M>; 1];
        "primitive" -> V;
        "to_object" -> A3<M>;
        "local_ray" -> RayOn<M>;
        "normal_in_scene" -> V3<M>;
    }
};

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("primitive") }, M, (HitOn<M>,)> for SceneView<'_, P> {
    type Output = P::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (hit,): (HitOn<M>,)) -> P::On<M> {
        let id = m.u32_select(hit.is_hit.0, hit.prim_id.0, m.u32(0));
        // The hit may be that of another scene.
        m.element(&self, U(id))
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("to_object") }, M, (HitOn<M>,)> for SceneView<'_, P> {
    type Output = A3<M>;

    #[inline(always)]
    fn call(self, m: &M, (hit,): (HitOn<M>,)) -> A3<M> {
        match self.placed() {
            Some(_) => m.to_object(&self, hit.inst_id),
            None => Affine3::splat(m, Affine3::IDENTITY),
        }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("local_ray") }, M, (RayOn<M>, HitOn<M>)>
    for SceneView<'_, P>
{
    type Output = RayOn<M>;

    #[inline(always)]
    fn call(self, m: &M, (ray, hit): (RayOn<M>, HitOn<M>)) -> RayOn<M> {
        match self.placed() {
            Some(_) => m.local_ray(&self, hit.inst_id, ray),
            None => ray,
        }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, P: Primitive> Method<{ name("normal_in_scene") }, M, (HitOn<M>, V3<M>)>
    for SceneView<'_, P>
{
    type Output = V3<M>;

    #[inline(always)]
    fn call(self, m: &M, (hit, normal): (HitOn<M>, V3<M>)) -> V3<M> {
        let map = Method::<{ name("to_object") }, M, (HitOn<M>,)>::call(self, m, (hit,));
        transform_normal_back::on(m, normal, map)
    }
}

#[diagnostic::do_not_recommend]
impl<'a, M: Machine, P: Primitive> Method<{ name("shared") }, M, ()> for SceneView<'a, P> {
    type Output = View<'a, P::Shared>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> View<'a, P::Shared> {
        View::shared(&self)
    }
}
