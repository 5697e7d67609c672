//! The instruction sets of this machine, and the lanes of each variant.

use fearless_simd::Level;

use super::Variant;
use crate::machine::{Counted, Lanes, Packet, Simd4, Simd8, Simd16};

/// The machines that closures are lifted for: the natural widths of the target's levels.
mod native {
    use super::{Counted, Packet, Simd4, Simd8, Simd16};

    /// The levels of 4, 8 and 16 lanes, and the baseline level of the target.
    #[cfg(target_arch = "x86_64")]
    pub(crate) mod level {
        pub(crate) use fearless_simd::{
            Avx2 as Middle, Avx512 as Wide, Sse2 as Least, Sse4_2 as Narrow,
        };
    }

    #[cfg(target_arch = "aarch64")]
    pub(crate) mod level {
        pub(crate) use fearless_simd::{
            Neon as Least, Neon as Middle, Neon as Narrow, Neon as Wide,
        };
    }

    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    pub(crate) mod level {
        pub(crate) use fearless_simd::{
            WasmSimd128 as Least, WasmSimd128 as Middle, WasmSimd128 as Narrow, WasmSimd128 as Wide,
        };
    }

    #[cfg(not(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        all(target_arch = "wasm32", target_feature = "simd128")
    )))]
    pub(crate) mod level {
        pub(crate) use fearless_simd::{
            Fallback as Least, Fallback as Middle, Fallback as Narrow, Fallback as Wide,
        };
    }

    /// Four lanes: SSE4.2, NEON, simd128, or the scalar fallback.
    pub(crate) type Lanes4 = Simd4<level::Narrow>;
    /// Eight lanes: AVX2, NEON, simd128.
    pub(crate) type Lanes8 = Simd8<level::Middle>;
    /// Sixteen lanes: AVX-512, NEON, simd128.
    pub(crate) type Lanes16 = Simd16<level::Wide>;
    /// Packets of four lanes: SSE4.2, NEON, simd128, or the scalar fallback.
    pub type Native4 = Packet<Lanes4>;
    /// Packets of eight lanes: AVX2, NEON, simd128.
    pub type Native8 = Packet<Lanes8>;
    /// Packets of sixteen lanes: AVX-512, NEON, simd128.
    pub type Native16 = Packet<Lanes16>;
    /// Eight lanes of the target's baseline level, which count active lanes by place in the kernel.
    pub type Counting = Packet<Counted<Simd8<level::Least>>>;
}

pub use native::{Counting, Native4, Native8, Native16};
pub(crate) use native::{Lanes4, Lanes8, Lanes16};

/// The level tokens of this machine.
#[derive(Clone, Copy)]
pub(crate) struct Levels {
    pub(crate) least: native::level::Least,
    pub(crate) narrow: Option<native::level::Narrow>,
    pub(crate) middle: Option<native::level::Middle>,
    pub(crate) wide: Option<native::level::Wide>,
}

impl Levels {
    pub(crate) fn detect() -> Self {
        Self::of(Level::new())
    }

    #[cfg(target_arch = "x86_64")]
    fn of(level: Level) -> Self {
        let Some(least) = level.as_sse2() else {
            unreachable!("SSE2 is a part of x86-64");
        };
        let (narrow, middle, wide) = (level.as_sse4_2(), level.as_avx2(), level.as_avx512());
        Self { least, narrow, middle, wide }
    }

    #[cfg(target_arch = "aarch64")]
    fn of(level: Level) -> Self {
        let Some(neon) = level.as_neon() else {
            unreachable!("NEON is a part of AArch64");
        };
        Self { least: neon, narrow: Some(neon), middle: Some(neon), wide: Some(neon) }
    }

    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    fn of(level: Level) -> Self {
        let Some(simd) = level.as_wasm_simd128() else {
            unreachable!("the module is compiled for simd128");
        };
        Self { least: simd, narrow: Some(simd), middle: Some(simd), wide: Some(simd) }
    }

    #[cfg(not(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        all(target_arch = "wasm32", target_feature = "simd128")
    )))]
    fn of(_: Level) -> Self {
        let least = fearless_simd::Fallback::new();
        Self { least, narrow: Some(least), middle: None, wide: None }
    }
}

impl Levels {
    /// Runs a task as [`Variant::with_lanes`] does, on a machine with these levels.
    pub(super) fn with_lanes<T: LanesTask>(self, variant: Variant, task: T) -> Option<T::Output> {
        match variant {
            Variant::Packet16 if let Some(s) = self.wide => Some(task.run(Simd16(s))),
            Variant::Packet8 | Variant::Packet16 if let Some(s) = self.middle => {
                Some(task.run(Simd8(s)))
            }
            _ => self.narrow.map(|s| task.run(Simd4(s))),
        }
    }
}

/// Returns whether this machine has lanes that traverse wide trees: AVX-512, AVX2, NEON or simd128.
pub(crate) fn has_wide_lanes() -> bool {
    Levels::detect().middle.is_some()
}

/// Runs a task with the lanes that traverse wide trees at a level, or at this machine's level if
/// that one has none; returns `None` if the machine has none either.
///
/// The lanes do not depend on the width of a packet: a traversal is a lot of code, and every copy
/// of it costs compile time.
pub(crate) fn with_wide_lanes<T: LanesTask>(level: Option<Level>, task: T) -> Option<T::Output> {
    let levels = level.filter(|level| !level.is_fallback()).map(Levels::of);
    let levels = levels.filter(|levels| levels.middle.is_some()).unwrap_or_else(Levels::detect);
    #[cfg(not(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        all(target_arch = "wasm32", target_feature = "simd128")
    )))]
    let _: (Levels, T) = (levels, task);
    #[cfg(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        all(target_arch = "wasm32", target_feature = "simd128")
    ))]
    if let Some(s) = levels.wide {
        return Some(task.run(Simd16(s)));
    }
    #[cfg(target_arch = "x86_64")]
    if let Some(s) = levels.middle {
        return Some(task.run(Simd8(s)));
    }
    None
}

/// A task that is generic over lanes.
pub(crate) trait LanesTask {
    type Output;
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    struct Name;
    impl LanesTask for Name {
        type Output = (&'static str, usize);
        fn run<L: Lanes>(self, lanes: L) -> Self::Output {
            (lanes.isa(), L::N)
        }
    }

    fn lanes(level: Level) -> [Option<(&'static str, usize)>; 3] {
        let levels = Levels::of(level);
        [Variant::Packet4, Variant::Packet8, Variant::Packet16]
            .map(|variant| levels.with_lanes(variant, Name))
    }

    /// Tests each level as the highest of a machine.
    #[test]
    fn widths_that_a_machine_lacks_run_as_the_next_narrower_ones() {
        let best = Level::new();
        if let Some(s) = best.as_sse2() {
            assert_eq!(lanes(Level::Sse2(s)), [None; 3], "one ray after another");
        }
        match best.as_sse4_2() {
            Some(s) => assert_eq!(lanes(Level::Sse4_2(s)), [Some(("sse4.2", 4)); 3]),
            None => println!("SKIPPED: this machine has no SSE4.2"),
        }
        let narrow = Some(("sse4.2", 4));
        match best.as_avx2() {
            Some(s) => {
                let middle = Some(("avx2", 8));
                assert_eq!(lanes(Level::Avx2(s)), [narrow, middle, middle]);
            }
            None => println!("SKIPPED: this machine has no AVX2"),
        }
        match best.as_avx512() {
            Some(s) => {
                let found = lanes(Level::Avx512(s));
                assert_eq!(found, [narrow, Some(("avx2", 8)), Some(("avx512", 16))]);
            }
            None => println!("SKIPPED: this machine has no AVX-512"),
        }
    }
}
