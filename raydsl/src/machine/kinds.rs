//! Which kinds of an enum there are.

/// A set of the kinds of an enum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinds(u64);

impl Kinds {
    /// Every kind.
    pub const ALL: Self = Self(u64::MAX);

    /// No kind.
    pub const NONE: Self = Self(0);

    /// One kind.
    pub const fn one(kind: u32) -> Self {
        Self(1 << kind)
    }

    /// Those of both.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether `kind` is among them.
    pub const fn has(self, kind: u32) -> bool {
        self.0 >> kind & 1 == 1
    }

    /// Whether there is no other than `kind`.
    pub const fn is_only(self, kind: u32) -> bool {
        self.0 == 1 << kind
    }
}
