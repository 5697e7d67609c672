//! Of kernels that are recorded, the packets and the reference would only be compiled.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-env=RAYDSL_VARIANTS=wgsl");
}
