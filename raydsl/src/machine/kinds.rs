//! Sets of an enum's kinds: the numbers of its variants.

use super::{LaneMachine, Machine, Schema, Type, U, kernel_type};

/// A set of the kinds of an enum. The last of 64 members stands for all kinds from number 63 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinds(u64);

/// The last member of a set.
const LAST: u32 = u64::BITS - 1;

impl Kinds {
    /// The set of every kind.
    pub const ALL: Self = Self(u64::MAX);

    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Returns the set of one kind.
    pub const fn one(kind: u32) -> Self {
        Self(1 << if kind < LAST { kind } else { LAST })
    }

    /// Returns the set of the kinds below `count`.
    pub const fn first(count: u32) -> Self {
        if count < LAST { Self((1 << count) - 1) } else { Self::ALL }
    }

    /// Returns the set as bits, the first kind's the lowest.
    pub const fn bits(self) -> u64 {
        self.0
    }

    /// Returns the union of both sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the kinds that are in both sets.
    #[must_use]
    pub const fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns the set without `kind`.
    #[must_use]
    pub const fn without(self, kind: u32) -> Self {
        if kind < LAST { Self(self.0 & !(1 << kind)) } else { self }
    }

    /// Returns whether `kind` is in the set.
    pub const fn has(self, kind: u32) -> bool {
        self.intersection(Self::one(kind)).0 != 0
    }

    /// Returns whether the set has all members of `other`.
    pub const fn has_all(self, other: Self) -> bool {
        self.union(other).0 == self.0
    }

    /// Returns whether `kind` is the only kind in the set.
    pub const fn is_only(self, kind: u32) -> bool {
        kind < LAST && self.0 == 1 << kind
    }
}

/// The number of a variant among `COUNT`, a member of the struct that represents an enum.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Kind<const COUNT: u32>(pub u32);

kernel_type!((const COUNT: u32) Kind<COUNT>);

#[diagnostic::do_not_recommend]
impl<const COUNT: u32> Type for Kind<COUNT> {
    type On<M: Machine> = U<M>;

    const SCHEMA: &'static Schema = &Schema::Kind { count: COUNT };

    #[inline(always)]
    fn splat<M: Machine>(m: &M, v: Self) -> U<M> {
        u32::splat(m, v.0)
    }

    #[inline(always)]
    fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> U<M> {
        u32::from_lanes(
            m,
            #[inline(always)]
            |lane| f(lane).0,
        )
    }

    #[inline(always)]
    fn lane<M: LaneMachine>(v: &U<M>, lane: usize) -> Self {
        Self(u32::lane(v, lane))
    }

    fn write(&self, out: &mut [u8]) {
        self.0.write(out);
    }

    fn read(bytes: &[u8]) -> Self {
        Self(u32::read(bytes))
    }
}
