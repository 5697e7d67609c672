//! Coercion of host values to values of the machine.

use crate::machine::{B, F, I, Machine, Type, U, Usize, Value, Var};

/// A value of the host or of the machine that converts to the machine's type `T`.
#[diagnostic::on_unimplemented(
    message = "this value does not have the type that is wanted here",
    label = "a value of another type",
    note = "convert a number with `as`, as in `n as f32`"
)]
pub trait Coerce<M: Machine, T> {
    /// Converts the value.
    fn coerce(self, m: &M) -> T;
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Value<M>> Coerce<M, V> for V {
    #[inline(always)]
    fn coerce(self, _: &M) -> V {
        self
    }
}

/// Reads a `&mut` parameter used as a value.
#[diagnostic::do_not_recommend]
impl<M: Machine, V: Value<M>> Coerce<M, V> for &Var<V> {
    #[inline(always)]
    fn coerce(self, m: &M) -> V {
        self.get(m)
    }
}

macro_rules! coerce_host {
    ($($host:ty => $twin:ident $make:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Coerce<M, $twin<M>> for $host {
                #[inline(always)]
                fn coerce(self, m: &M) -> $twin<M> {
                    $twin(m.$make(self))
                }
            }
        )+
    };
}

coerce_host!(f32 => F f32, i32 => I i32, u32 => U u32, bool => B bool);

#[diagnostic::do_not_recommend]
impl<M: Machine> Coerce<M, Usize<M>> for usize {
    #[inline(always)]
    fn coerce(self, m: &M) -> Usize<M> {
        <usize as Type>::splat(m, self)
    }
}

/// A value that a variable can hold, converted to the machine whether or not it is one of the host.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot keep this value in a variable",
    label = "neither a number nor a value made of numbers",
    note = "name data that kernels read where it is used: `points[i]`, `bvh.closest_hit(ray)`"
)]
pub trait Varying<M: Machine> {
    /// The type on the machine.
    type Value: Value<M>;
    /// Converts the value.
    fn varying(self, m: &M) -> Self::Value;
}

macro_rules! varying {
    ($($t:ident),+; $($host:ty => $twin:ident $make:ident),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Varying<M> for $t<M> {
                type Value = Self;

                #[inline(always)]
                fn varying(self, _: &M) -> Self {
                    self
                }
            }
        )+
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Varying<M> for $host {
                type Value = $twin<M>;

                #[inline(always)]
                fn varying(self, m: &M) -> $twin<M> {
                    $twin(m.$make(self))
                }
            }
        )+
    };
}

varying!(F, I, U, Usize, B; i32 => I i32, u32 => U u32, bool => B bool);

#[diagnostic::do_not_recommend]
impl<M: Machine> Varying<M> for usize {
    type Value = Usize<M>;

    #[inline(always)]
    fn varying(self, m: &M) -> Usize<M> {
        Coerce::coerce(self, m)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Varying<M>, const N: usize> Varying<M> for [V; N] {
    type Value = [V::Value; N];

    #[inline(always)]
    fn varying(self, m: &M) -> Self::Value {
        self.map(|v| v.varying(m))
    }
}

macro_rules! varying_tuple {
    ($($name:ident . $index:tt),+) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, $($name: Varying<M>),+> Varying<M> for ($($name,)+) {
            type Value = ($($name::Value,)+);

            #[inline(always)]
            fn varying(self, m: &M) -> Self::Value {
                ($(self.$index.varying(m),)+)
            }
        }
    };
}

varying_tuple!(A.0);
varying_tuple!(A.0, C.1);
varying_tuple!(A.0, C.1, D.2);
varying_tuple!(A.0, C.1, D.2, E.3);
varying_tuple!(A.0, C.1, D.2, E.3, G.4);
varying_tuple!(A.0, C.1, D.2, E.3, G.4, H.5);
varying_tuple!(A.0, C.1, D.2, E.3, G.4, H.5, J.6);
varying_tuple!(A.0, C.1, D.2, E.3, G.4, H.5, J.6, K.7);

#[diagnostic::do_not_recommend]
impl<M: Machine> Varying<M> for () {
    type Value = ();

    #[inline(always)]
    fn varying(self, _: &M) {}
}

/// The two bounds of a `for`, converted to one type.
#[diagnostic::on_unimplemented(
    message = "the bounds of a kernel's `for` are two integers of one type",
    label = "not an integer of the other bound's type",
    note = "write for example `for i in 0..n` with a `u32`, `i32` or `usize`"
)]
pub trait Bounds<M: Machine, E> {
    /// The counter's type.
    type Counter: Value<M>;
    /// Converts both bounds.
    fn bounds(m: &M, start: Self, end: E) -> (Self::Counter, Self::Counter);
}

macro_rules! bounds {
    ($($t:ident $host:ty),+) => {
        $(
            bounds!(@one $t, $t<M>, $t<M>);
            bounds!(@one $t, $host, $t<M>);
            bounds!(@one $t, $t<M>, $host);
            bounds!(@one $t, $host, $host);
        )+
    };
    (@one $t:ident, $a:ty, $b:ty) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine> Bounds<M, $b> for $a {
            type Counter = $t<M>;

            #[inline(always)]
            fn bounds(m: &M, start: $a, end: $b) -> ($t<M>, $t<M>) {
                (Coerce::coerce(start, m), Coerce::coerce(end, m))
            }
        }
    };
}

bounds!(I i32, U u32, Usize usize);
