//! A few kernels in every variant of the CPU.

use raydsl_tests::check::{Wgsl, check};
use raydsl_tests::kernels;
use raydsl_tests::levels::level_names;
use raydsl_tests::values::Numbers;

macro_rules! tests {
    ($($kernel:ident: $numbers:ident $wgsl:ident;)+) => {
        $(
            #[test]
            fn $kernel() {
                check::<kernels::$kernel>(stringify!($kernel), Numbers::$numbers, Wgsl::$wgsl);
            }
        )+
    };
}

raydsl_tests::small_kernel_table!(tests);

/// The processor's own lanes are among those that the tests above ran on.
#[test]
fn levels_are_named() {
    let names = level_names();
    println!("levels: {names:?}");
    let own = match std::env::consts::ARCH {
        "aarch64" => "neon",
        "wasm32" => "simd128",
        _ => "sse2",
    };
    assert!(names.iter().any(|name| name.starts_with(own)), "{names:?}");
}
