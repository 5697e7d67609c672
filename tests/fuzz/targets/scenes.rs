//! Builds, refits and traverses what the bytes say; see `raydsl_tests::adversary`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    raydsl_tests::adversary::scene(bytes);
});
