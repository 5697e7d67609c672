//! Random kernels agree with their source in every variant; `raydsl_tests::fuzz` says how.
//!
//! `RAYDSL_FUZZ_KERNELS` says how many, `RAYDSL_FUZZ_SEED` which ones, `RAYDSL_FUZZ_RESUME=1` that
//! a run which was ended goes on, and `RAYDSL_FUZZ_SHRUNK` how many failing kernels are made
//! smaller:
//!
//! ```text
//! RAYDSL_FUZZ_KERNELS=20000 RAYDSL_FUZZ_RESUME=1 cargo test --test fuzz -- --nocapture
//! ```

use std::path::Path;
use std::time::Instant;

use raydsl_tests::fuzz::batch::Workshop;
use raydsl_tests::fuzz::{generator, print, shrink};

fn number(name: &str, default: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|e| panic!("{name}={text}: {e}")),
        Err(_) => default,
    }
}

#[test]
fn random_kernels_agree() {
    let seed = number("RAYDSL_FUZZ_SEED", 1);
    let count = number("RAYDSL_FUZZ_KERNELS", 300) as usize;
    let shrunk = number("RAYDSL_FUZZ_SHRUNK", 3) as usize;
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let target = scratch.parent().expect("the scratch folder lies in the target folder");
    let workshop = Workshop::new(&scratch.join("fuzz"), target, "fuzz");
    let resume = number("RAYDSL_FUZZ_RESUME", 0) == 1;
    let start = Instant::now();
    let mut report = workshop.run_seeds(seed, count, resume);
    println!(
        "{} kernels from seed {seed} on in {:.0} s; WGSL compared for {} of them, {} inputs",
        report.kernels,
        start.elapsed().as_secs_f64(),
        report.on_wgsl,
        report.wgsl_inputs
    );
    let failed = report.failures.len();
    report.failures.sort_by_key(|(kernel, _)| kernel.seed);
    for (i, (kernel, text)) in report.failures.iter().enumerate() {
        println!("seed {}: {text}", kernel.seed);
        if i < shrunk {
            let (small, text) = workshop.shrunk(kernel, text);
            println!("made smaller:\n{}\nwhich fails with: {text}\n", print::kernel(&small));
        }
    }
    assert_eq!(
        failed, 0,
        "some of {count} kernels from seed {seed} on fail; their seeds are above"
    );
    assert_eq!(report.kernels, count);
    assert!(report.on_wgsl > 0 || raydsl_tests::gpu::gpu().is_none());
}

#[test]
fn a_seed_gives_one_text() {
    for seed in 0..200 {
        let text = print::kernel(&generator::kernel(seed));
        assert_eq!(text, print::kernel(&generator::kernel(seed)));
        assert_ne!(text, print::kernel(&generator::kernel(seed + 1)));
    }
}

#[test]
fn texts_are_rust() {
    for seed in 0..200 {
        let text = print::kernel(&generator::kernel(seed));
        let file = syn::parse_file(&text).unwrap_or_else(|e| panic!("seed {seed}: {e}\n{text}"));
        assert!(file.items.len() > 3);
    }
}

#[test]
fn cuts_are_smaller() {
    let length = |k: &_| print::kernel(k).len();
    let mut kernel = generator::kernel(3);
    loop {
        let cuts = shrink::cuts(&kernel);
        assert!(cuts.iter().all(|cut| *cut != kernel));
        let Some(least) = cuts.into_iter().min_by_key(length) else { break };
        kernel = least;
    }
    assert!(length(&kernel) < 500, "{}", print::kernel(&kernel));
}
