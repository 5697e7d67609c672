//! Host values within kernels: known before the kernel runs and while it is recorded.

use super::{Capture, Coerce, F, Machine};

/// Marks a number as the host's, to specialise the kernel for it: branches and loops that depend on
/// it alone are decided before the kernel runs, and generated code has only the arms taken.
///
/// Its argument is a captured number, a constant, or computed from such; a `let` or a parameter
/// with `#[host]` holds such a value. A kernel recorded with another value is another kernel:
/// numbers that change from frame to frame are better left to the machine.
///
/// ```
/// use raydsl::prelude::*;
///
/// let samples = 3u32;
/// let k = kernel!(|x: f32| {
///     #[host]
///     let twice = host(samples) * 2;
///     let mut sum = 0.0;
///     for i in 0..twice {
///         sum += x * i as f32;
///     }
///     if host(samples) > 8 { -sum } else { sum }
/// });
/// assert_eq!(k.call((2.0,)), 30.0);
/// assert!(k.wgsl().contains("i < 6u") && !k.wgsl().contains("else"));
/// ```
#[inline(always)]
pub fn host<T>(x: T) -> T {
    x
}

/// A captured value that a kernel may use as a host value.
#[diagnostic::on_unimplemented(
    message = "`host(..)` takes numbers and truth values",
    label = "not a number of the host"
)]
pub trait HostCapture {
    /// The value's type.
    type Value: Copy;
    /// Returns the host value.
    fn host(&self) -> Self::Value;
    /// Returns a number that another value does not have, if there is one.
    #[doc(hidden)]
    fn fact(&self) -> Option<u64> {
        None
    }
}

#[diagnostic::do_not_recommend]
impl<T: HostCapture + ?Sized> HostCapture for &T {
    type Value = T::Value;

    #[inline(always)]
    fn host(&self) -> T::Value {
        T::host(self)
    }

    fn fact(&self) -> Option<u64> {
        T::fact(self)
    }
}

/// A host value used together with a value of the machine.
pub trait HostUse<M: Machine> {
    /// Its type on the machine; integers remain host values until combined with others.
    type Used;
    /// Returns the value.
    fn value(self, m: &M) -> Self::Used;
}

macro_rules! host_number {
    ($($host:ty),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl HostCapture for $host {
                type Value = Self;

                #[inline(always)]
                fn host(&self) -> Self {
                    *self
                }

                fn fact(&self) -> Option<u64> {
                    Some(*self as u64)
                }
            }

            #[diagnostic::do_not_recommend]
            impl<M: Machine> HostUse<M> for $host {
                type Used = Self;

                #[inline(always)]
                fn value(self, _: &M) -> Self {
                    self
                }
            }
        )+
    };
}

host_number!(i32, u32, usize, bool);

#[diagnostic::do_not_recommend]
impl HostCapture for f32 {
    type Value = Self;

    #[inline(always)]
    fn host(&self) -> Self {
        *self
    }

    fn fact(&self) -> Option<u64> {
        Some(self.to_bits().into())
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> HostUse<M> for f32 {
    type Used = F<M>;

    #[inline(always)]
    fn value(self, m: &M) -> F<M> {
        Coerce::coerce(self, m)
    }
}

/// A constant of the source as an argument. An integer remains a host value, as the parameter may
/// be one.
pub struct Constant<'c, T>(pub &'c T);

macro_rules! constant_of_the_host {
    ($($host:ty),+) => {
        $(
            impl Constant<'_, $host> {
                /// Returns the constant; method resolution prefers this to [`GiveConstant::give`].
                #[inline(always)]
                pub fn give<M: Machine>(self, _: &M) -> $host {
                    *self.0
                }
            }
        )+
    };
}

constant_of_the_host!(i32, u32, usize, bool);

/// Lets options of a ready kernel be host values: captured, constants, and their fields and methods.
macro_rules! host_options {
    ($($host:ty),+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl $crate::machine::lifted::HostCapture for $host {
                type Value = Self;

                #[inline(always)]
                fn host(&self) -> Self {
                    *self
                }

                fn fact(&self) -> Option<u64> {
                    use core::hash::BuildHasher as _;
                    type Hash = core::hash::BuildHasherDefault<std::hash::DefaultHasher>;
                    Some(Hash::default().hash_one(self))
                }
            }

            #[diagnostic::do_not_recommend]
            impl<M: $crate::machine::Machine> $crate::machine::lifted::HostUse<M> for $host {
                type Used = Self;

                #[inline(always)]
                fn value(self, _: &M) -> Self {
                    self
                }
            }

            impl $crate::machine::lifted::Constant<'_, $host> {
                /// Returns the constant, which remains a host value.
                #[inline(always)]
                pub fn give<M: $crate::machine::Machine>(self, _: &M) -> $host {
                    *self.0
                }
            }
        )+
    };
}

pub(crate) use host_options;

/// Converts constants of other types to values of the machine.
pub trait GiveConstant<M: Machine> {
    /// The converted type.
    type Given;
    /// Converts the constant.
    fn give(self, m: &M) -> Self::Given;
}

#[diagnostic::do_not_recommend]
impl<'c, M: Machine, T: Capture<M>> GiveConstant<M> for Constant<'c, T> {
    type Given = T::On<'c>;

    #[inline(always)]
    fn give(self, m: &M) -> T::On<'c> {
        self.0.constant(m)
    }
}
