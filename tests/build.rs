//! Leaves out what the machine that builds the tests cannot run: without AVX-512, `packet16` runs the
//! copy of `packet8`, so the copy of sixteen lanes would only be compiled. The examples, the benchmarks
//! and the lints compile it everywhere.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=RAYDSL_VARIANTS");
    println!("cargo:rustc-check-cfg=cfg(has_avx512, chooses_variants)");
    if runs_avx512() {
        println!("cargo:rustc-cfg=has_avx512");
    } else if targets_x86() && std::env::var_os("RAYDSL_VARIANTS").is_none() {
        println!("cargo:rustc-env=RAYDSL_VARIANTS=packet4,packet8,wgsl,reference");
        println!("cargo:rustc-cfg=chooses_variants");
    }
}

fn targets_x86() -> bool {
    std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "x86_64")
}

/// Whether the tests run here, and on a machine with AVX-512.
#[cfg(target_arch = "x86_64")]
fn runs_avx512() -> bool {
    // The newest of what `fearless_simd` asks for, Ice Lake's: processors with less run AVX2.
    targets_x86()
        && std::arch::is_x86_feature_detected!("avx512f")
        && std::arch::is_x86_feature_detected!("avx512bitalg")
        && std::arch::is_x86_feature_detected!("avx512vbmi2")
}

#[cfg(not(target_arch = "x86_64"))]
fn runs_avx512() -> bool {
    false
}
