//! Sets of an enum's kinds.

/// A set of the kinds of an enum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinds(u64);

impl Kinds {
    /// The set of every kind.
    pub const ALL: Self = Self(u64::MAX);

    /// The empty set.
    pub const NONE: Self = Self(0);

    /// Returns the set of one kind.
    pub const fn one(kind: u32) -> Self {
        Self(1 << kind)
    }

    /// Returns the union of both sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns whether `kind` is in the set.
    pub const fn has(self, kind: u32) -> bool {
        self.0 >> kind & 1 == 1
    }

    /// Returns whether `kind` is the only kind in the set.
    pub const fn is_only(self, kind: u32) -> bool {
        self.0 == 1 << kind
    }
}
