//! Variants: the ways to run a kernel.

use super::LanesTask;
use super::levels::Levels;
use crate::machine::Lanes;

/// One way to run a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Variant {
    /// The user's own function.
    Scalar,
    /// SIMD packets of 4 rays.
    Packet4,
    /// SIMD packets of 8 rays.
    Packet8,
    /// SIMD packets of 16 rays.
    Packet16,
    /// WGSL on a GPU.
    Wgsl,
}

impl Variant {
    /// Every variant, in the order of tables.
    pub const ALL: [Self; 5] =
        [Self::Scalar, Self::Packet4, Self::Packet8, Self::Packet16, Self::Wgsl];

    /// Returns `scalar`, `packet4`, `packet8`, `packet16` or `wgsl`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Packet4 => "packet4",
            Self::Packet8 => "packet8",
            Self::Packet16 => "packet16",
            Self::Wgsl => "wgsl",
        }
    }

    /// Returns the variant of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|v| v.name() == name)
    }

    /// Returns the packet variant that fills the widest registers of this machine.
    pub fn widest() -> Self {
        let levels = Levels::detect();
        if levels.wide.is_some() {
            Self::Packet16
        } else if levels.middle.is_some() {
            Self::Packet8
        } else {
            Self::Packet4
        }
    }

    /// Returns the instruction set that runs the variant on this machine, and its lanes.
    ///
    /// A width whose level the machine lacks runs as several packets of the next narrower one;
    /// without SSE4.2 or NEON, one ray after another.
    pub fn isa(self) -> (&'static str, usize) {
        struct Name;
        impl LanesTask for Name {
            type Output = (&'static str, usize);
            fn run<L: Lanes>(self, lanes: L) -> Self::Output {
                (lanes.isa(), L::N)
            }
        }
        match self {
            Self::Scalar => ("scalar", 1),
            Self::Wgsl => ("wgsl", 1),
            packet => packet.with_lanes(Name).unwrap_or(("scalar", 1)),
        }
    }

    /// Returns whether this machine has registers for the variant; false for WGSL. Packets that it
    /// lacks run as several of the next narrower width.
    pub fn is_native(self) -> bool {
        let levels = Levels::detect();
        match self {
            Self::Scalar => true,
            Self::Packet4 => {
                let has_any = cfg!(any(
                    target_arch = "x86_64",
                    target_arch = "aarch64",
                    all(target_arch = "wasm32", target_feature = "simd128")
                ));
                has_any && levels.narrow.is_some()
            }
            Self::Packet8 => levels.middle.is_some(),
            Self::Packet16 => levels.wide.is_some(),
            Self::Wgsl => false,
        }
    }

    /// Runs a task with the lanes of the variant's packets; returns `None` if the machine has none.
    pub(crate) fn with_lanes<T: LanesTask>(self, task: T) -> Option<T::Output> {
        Levels::detect().with_lanes(self, task)
    }
}

/// A set of variants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variants(Vec<Variant>);

impl Variants {
    /// Returns every variant.
    pub fn all() -> Self {
        Self(Variant::ALL.to_vec())
    }

    /// Returns the variants that run on the CPU.
    pub fn cpu() -> Self {
        Self(Variant::ALL.into_iter().filter(|v| *v != Variant::Wgsl).collect())
    }

    /// Returns these variants, each once, in the order of tables. The scalar one is always among
    /// them, since the others are compared with it.
    pub fn of(variants: &[Variant]) -> Self {
        Self(
            Variant::ALL
                .into_iter()
                .filter(|v| *v == Variant::Scalar || variants.contains(v))
                .collect(),
        )
    }

    /// Iterates over the variants in the order of tables.
    pub fn iter(&self) -> impl Iterator<Item = Variant> + '_ {
        self.0.iter().copied()
    }
}
