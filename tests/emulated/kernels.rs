//! Kernels in every variant of the CPU: one or two of each kind of statement and operation, of those
//! that `raydsl-tests` has.

use raydsl_tests::check::{Wgsl, check};
use raydsl_tests::kernels;
use raydsl_tests::levels::level_names;
use raydsl_tests::values::Numbers;

macro_rules! tests {
    ($($kernel:ident: $numbers:ident;)+) => {
        $(
            #[test]
            fn $kernel() {
                check::<kernels::$kernel>(stringify!($kernel), Numbers::$numbers, Wgsl::Same);
            }
        )+
    };
}

tests! {
    else_arms: Tame;
    labelled: Tame;
    return_in_loops: Tame;
    early_returns: Any;
    masked_division: Any;
    vector_places: Any;
    calls_in_branches: Tame;
    methods: Tame;
    struct_branches: Tame;
    integers: Any;
    bits: Any;
    shifts: Any;
    signed: Any;
    hash: Any;
    from_float: Any;
    to_float: Any;
    truths: Any;
    clamped: Any;
    float_methods: Any;
    float_bits: Any;
    fused: Any;
    vectors: Tame;
    transforms: Any;
    unorms: Any;
    arrays: Any;
    match_tuples: Tame;
    loops_with_values: Tame;
    array_of_structs: Tame;
    enums: Tame;
    angles: Any;
    growth: Any;
}

/// The processor's own lanes are among those that the tests above ran on.
#[test]
fn levels_are_named() {
    let names = level_names();
    println!("levels: {names:?}");
    let own = if cfg!(target_arch = "aarch64") { "neon" } else { "sse2" };
    assert!(names.iter().any(|name| name.starts_with(own)), "{names:?}");
}
