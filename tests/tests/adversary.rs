//! Trees of what bytes say, against their primitives asked one by one.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use raydsl_tests::adversary;
use raydsl_tests::rng::Rng;
use raydsl_tests::{in_parallel, scaled};

/// Bytes of any length; long runs of zeros choose the first of everything.
fn bytes(seed: u64) -> Vec<u8> {
    let mut rng = Rng::new(seed);
    let len = 4 + rng.below(1500);
    let mut bytes: Vec<u8> = (0..len).map(|_| rng.bits() as u8).collect();
    if rng.below(3) == 0 {
        let from = rng.below(len);
        bytes[from..].fill(0);
    }
    bytes
}

#[test]
fn whatever_the_bytes_say() {
    let (count, hits) = (scaled(50_000), AtomicUsize::new(0));
    in_parallel(count, 100, |seeds| {
        for seed in seeds {
            let bytes = bytes(seed as u64);
            match catch_unwind(AssertUnwindSafe(|| adversary::scene(&bytes))) {
                Ok(met) => _ = hits.fetch_add(met, Ordering::Relaxed),
                Err(panic) => {
                    eprintln!("seed {seed} of {} bytes fails", bytes.len());
                    resume_unwind(panic);
                }
            }
        }
    });
    let hits = hits.into_inner();
    assert!(hits > 10 * count, "of {count} scenes {hits} rays hit");
}

#[test]
fn no_bytes_are_a_scene() {
    adversary::scene(&[]);
    for k in 0..=255 {
        adversary::scene(&[k]);
    }
}
