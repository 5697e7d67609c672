//! Builds with an observer.

use core::ops::ControlFlow;

use super::*;
use crate::bvh::BuildError;

/// Returns the tree, and the progress reported to the observer.
fn observed(
    balls: &[Ball],
    quality: BuildQuality,
    mut stop: impl FnMut(usize, f64) -> bool + Send,
) -> (Result<Bvh<'_, Ball>, BuildError>, Vec<f64>) {
    let mut told = Vec::new();
    let bvh = Bvh::build_observed(balls, &[], &quality.into(), |done| {
        told.push(done);
        if stop(told.len(), done) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    (bvh, told)
}

#[test]
fn observers_are_told_from_0_to_1() {
    let balls = Numbers::of(31).balls(50_000);
    for quality in BuildQuality::ALL {
        let (bvh, told) = observed(&balls, quality, |_, _| false);
        let bvh = bvh.expect("finite bounds");
        assert_eq!((told[0], told[told.len() - 1]), (0.0, 1.0));
        assert!(told.is_sorted_by(|a, b| a < b), "{told:?}");
        assert!(told.len() > 10 && told.len() < 202, "{} calls", told.len());
        let alone = Bvh::build_with(&balls, &quality.into()).expect("finite bounds");
        assert!(bvh.nodes() == alone.nodes() && bvh.indices() == alone.indices());
    }
}

#[test]
fn small_scenes_are_begun_and_finished() {
    for count in [0, 1, 5] {
        for quality in BuildQuality::ALL {
            let balls = Numbers::of(32).balls(count);
            let (bvh, told) = observed(&balls, quality, |_, _| false);
            assert_eq!(bvh.expect("finite bounds").primitives().len(), count);
            assert_eq!((told[0], told[told.len() - 1]), (0.0, 1.0));
        }
    }
}

#[test]
fn stops_are_heeded() {
    let balls = Numbers::of(33).balls(50_000);
    for quality in BuildQuality::ALL {
        let cancelled = |stop: &(dyn Fn(usize, f64) -> bool + Sync)| {
            let (bvh, told) = observed(&balls, quality, stop);
            assert_eq!(bvh.expect_err("it was stopped"), BuildError::Cancelled);
            told
        };
        assert_eq!(cancelled(&|_, _| true), [0.0], "nothing is told after a stop");
        let told = cancelled(&|_, done| done > 0.3);
        assert!(told[told.len() - 1] > 0.3 && told[told.len() - 2] <= 0.3, "{told:?}");
        assert_eq!(cancelled(&|_, done| done == 1.0).last(), Some(&1.0));
    }
    assert_eq!(BuildError::Cancelled.to_string(), "the build was stopped by its observer");
}

#[test]
fn what_is_wrong_is_told_before_a_stop() {
    let mut balls = Numbers::of(34).balls(100);
    balls[7].radius = f32::NAN;
    let (bvh, _) = observed(&balls, BuildQuality::Best, |_, _| false);
    assert_eq!(bvh.expect_err("no bounds"), BuildError::NanBounds { index: 7 });
}
