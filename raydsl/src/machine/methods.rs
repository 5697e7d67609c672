//! Method calls of lifted code.
//!
//! A method call of the source becomes `Method::<{ name("dot") }, M, _>::call(v, m, (w,))`: the
//! name is part of the trait, so that methods of the user's types and the library's need no import.

use super::{Coerce, Machine, Usize, Var, op};

/// Returns the hash of a method's name (FNV-1a, 64 bits).
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

/// A method that kernels may call on a machine.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot call this method with these arguments",
    label = "not an operation of the kernel language",
    note = "a method of your own needs `#[kernel]` on its impl; the chapter \"The language\" of the \
            book lists those that are there",
    note = "a method of a trait on a member or an element of a generic type needs a variable with \
            the type: `let light: L = self.light;`"
)]
pub trait Method<const NAME: u64, M: Machine, A, Via = ()> {
    /// The result type.
    type Output;
    /// Whether it takes `&mut self`.
    const IS_MUT: bool = false;
    /// Calls the method.
    fn call(self, m: &M, args: A) -> Self::Output;
    /// Calls the method on a variable with the value `self`.
    #[inline(always)]
    fn call_at(self, variable: &Var<Self>, m: &M, args: A) -> Self::Output
    where
        Self: Copy,
    {
        let _ = variable;
        self.call(m, args)
    }
}

/// Returns whether a method takes `&mut self`.
#[inline(always)]
pub fn is_mut<const NAME: u64, M: Machine, T: Method<NAME, M, A, Via>, A, Via>(
    _: &M,
    _: &T,
    _: &A,
) -> bool {
    T::IS_MUT
}

/// Calls a method on an element at a computed index. The call has a copy of the element, so a
/// method with `&mut self` is refused: it would change nothing.
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

/// A number as a const generic argument.
#[derive(Clone, Copy, Debug, Default)]
pub struct Const<const N: usize>;

/// A method in a `#[kernel] impl` of a struct; the derived twin forwards [`Method`] to it.
///
/// `Via` is [`Through`] the method's trait: two traits of one type may have methods of one name.
/// Calls do not name it; if only one impl fits, rustc finds it.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot call this method of `{Self}` with these arguments",
    label = "not a kernel",
    note = "write `#[kernel]` on the impl that has the method; a method that a trait provides is \
            called by its path: `P::twice(&p)`"
)]
pub trait HostMethod<const NAME: u64, M: Machine, A, Via = ()> {
    /// The struct's twin.
    type This: Copy;
    /// The result type.
    type Output;
    /// Whether it takes `&mut self`.
    const IS_MUT: bool = false;
    /// Calls the method.
    fn call(this: Self::This, m: &M, args: A) -> Self::Output;
    /// Calls the method on a variable with the value `this`.
    #[inline(always)]
    fn call_at(this: Self::This, variable: &Var<Self::This>, m: &M, args: A) -> Self::Output {
        let _ = variable;
        Self::call(this, m, args)
    }
}

/// An `impl` of a trait, identified by the hash of the trait's name.
pub struct Through<const TRAIT: u64>;

/// Implements a method: `method!([generics] Type, "name", |m, self, argument: Type, ..| -> Result {
/// .. })`.
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

/// Refuses methods of glam or std whose result differs between machines. The impl asks for a bound
/// that never holds; its message is the error, with the remedy.
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

/// The lengths of arrays are numbers of the host.
#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("min") }, M, (Self,)> for usize {
    type Output = Self;

    #[inline(always)]
    fn call(self, _: &M, (other,): (Self,)) -> Self {
        Ord::min(self, other)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Method<{ name("min") }, M, (Usize<M>,)> for usize {
    type Output = Usize<M>;

    #[inline(always)]
    fn call(self, m: &M, (other,): (Usize<M>,)) -> Usize<M> {
        Method::<{ name("min") }, M, (Self,)>::call(other, m, (self,))
    }
}

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

// Arrays

/// Exchanges two elements of a variable.
#[diagnostic::do_not_recommend]
impl<M, V, I, J, const N: usize> Method<{ name("swap") }, M, (I, J)> for [V; N]
where
    M: Machine,
    V: super::Value<M> + super::Varying<M, Value = V> + Coerce<M, V>,
    I: super::Index<M>,
    J: super::Index<M>,
{
    type Output = ();
    const IS_MUT: bool = true;

    /// Changes nothing: a copy has no name.
    #[inline(always)]
    fn call(self, _: &M, _: (I, J)) {}

    #[inline(always)]
    fn call_at(self, variable: &Var<Self>, m: &M, (i, j): (I, J)) {
        let (i, j) = (Usize(i.index(m).0), Usize(j.index(m).0));
        let (a, b) = (super::lowered::element(m, self, i), super::lowered::element(m, self, j));
        let changed = super::index::with_element(m, self, i, b);
        variable.set(m, super::index::with_element(m, changed, j, a));
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
