//! Operations on the floats of whole values.
//!
//! Each leaf is one call, compiled once here.

use super::arena::Bounded;
use super::interval::Interval;
use super::{Margin, Truth};
use crate::machine::Leaves;

/// Collects the floats of a value.
pub(super) struct Take(pub(super) Vec<Bounded>);

/// Replaces the floats of a value.
pub(super) struct Give(pub(super) std::vec::IntoIter<Bounded>);

/// Copies the floats, so that they can be slots, or survive when slots are overwritten.
pub(super) struct Copied;

/// Overwrites the slots of the second value with the first one.
pub(super) struct Assigned;

macro_rules! floats {
    ($name:ident, |$self:ident, $m:ident, $a:ident, $b:ident| $float:expr) => {
        impl Leaves<Margin> for $name {
            #[inline(never)]
            fn f32(&mut $self, $m: &Margin, $a: Bounded, $b: Bounded) -> Bounded {
                $float
            }

            #[inline]
            fn i32(&mut self, _: &Margin, a: i32, _: i32) -> i32 {
                a
            }

            #[inline]
            fn u32(&mut self, _: &Margin, a: u32, _: u32) -> u32 {
                a
            }

            #[inline]
            fn bool(&mut self, _: &Margin, a: Truth, _: Truth) -> Truth {
                a
            }
        }
    };
}

floats!(Take, |self, _m, a, _b| {
    self.0.push(a);
    a
});
floats!(Give, |self, m, a, _b| {
    self.0.next().unwrap_or_else(|| m.put(m.bounded(m.get(a).value, Interval::ALL)))
});
floats!(Copied, |self, m, a, _b| m.put(m.get(a)));
floats!(Assigned, |self, m, a, slot| {
    m.floats.set(slot, m.get(a));
    slot
});
