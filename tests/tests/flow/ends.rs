//! Why lines end, and what is defined of fields and seeds that are none.

use raydsl::flow::{FlowEnd, FlowState, TRIES_PER_CALL, Ways, trace};
use raydsl::prelude::*;

use super::{follow, settings};

/// In a box the field ends: lines end there, to within the least step.
#[test]
fn lines_end_where_the_field_does() {
    let settings = settings(1e-5, 0.7).min_step(1e-6).expect("a step");
    let kernel = kernel!(|state: FlowState| {
        let field = |p: Vec3| {
            let is_inside = p.abs().max_element() <= 1.0;
            if is_inside { Some(vec3(1.0, 0.3 * p.x, 0.0)) } else { None }
        };
        trace(field, state, settings)
    });
    let seeds =
        [vec3(-0.9, 0.0, 0.0), vec3(0.5, 0.2, 0.9), vec3(1.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0)];
    let lines = follow(&kernel, &seeds, Ways::Forwards);
    for line in &lines[..3] {
        assert_eq!(line.end(), FlowEnd::Left);
        let last = line.points().last().expect("a point");
        assert!((last.at.x - 1.0).abs() <= 2e-6, "{last:?}");
        assert!(last.at.x <= 1.0, "the last point is inside: {last:?}");
    }
    assert_eq!(lines[3].end(), FlowEnd::NoField);
    assert!(lines[3].points().is_empty() && lines[3].polygon(0.1).is_empty());
    assert_eq!(lines[3].at(0.0), None);
    // Lines know their way back, too.
    let both = follow(&kernel, &seeds, Ways::Both);
    assert_eq!(both[0].begin(), Some(FlowEnd::Left));
    assert!((both[0].points()[0].at.x + 1.0).abs() <= 2e-6);
    assert_eq!(both[3].begin(), Some(FlowEnd::NoField));
}

#[test]
fn circles_close() {
    for tolerance in [1e-3, 1e-5] {
        let settings = settings(tolerance, 1.0).closing(0.02).expect("a distance");
        let kernel = kernel!(|state: FlowState| {
            trace(|p: Vec3| Some(vec3(-p.y, p.x, 0.0) * 3.0), state, settings)
        });
        for radius in [0.3, 1.0, 2.0] {
            let line = &follow(&kernel, &[vec3(0.0, radius, 0.0)], Ways::Forwards)[0];
            assert_eq!(line.end(), FlowEnd::Closed);
            let last = line.points().last().expect("a point");
            assert!((last.time * 3.0 - core::f32::consts::TAU).abs() < 0.01, "{last:?}");
            assert!(last.at.distance(vec3(0.0, radius, 0.0)) < 0.02);
        }
    }
    // A spiral comes back too far away, and is never closed.
    let settings = settings(1e-4, 1.0).closing(0.02).expect("a distance");
    let settings = settings.max_time(20.0).expect("a time");
    let kernel = kernel!(|state: FlowState| {
        trace(|p: Vec3| Some(vec3(-p.y, p.x, 0.0) + p * 0.01), state, settings)
    });
    assert_eq!(follow(&kernel, &[Vec3::X], Ways::Forwards)[0].end(), FlowEnd::Time);
}

#[test]
fn lengths_are_met() {
    for max_length in [0.37, 5.0, 20.0] {
        let settings = settings(1e-4, 0.6).max_length(max_length).expect("a length");
        // The speed grows by e in every unit of time, and turns.
        let kernel = kernel!(|state: FlowState| {
            trace(|p: Vec3| Some(vec3(-p.y, p.x, 0.2) + p), state, settings)
        });
        let line = &follow(&kernel, &[Vec3::X], Ways::Forwards)[0];
        assert_eq!(line.end(), FlowEnd::Length);
        let last = line.points().last().expect("a point");
        assert!((last.length / max_length - 1.0).abs() < 2e-4, "{last:?}");
    }
}

#[test]
fn still_points_end_lines() {
    let base = settings(1e-4, 1.0);
    let slow = base.still(1e-3).expect("a speed");
    let sink = kernel!(|state: FlowState| trace(|p: Vec3| Some(-p), state, slow));
    let lines = follow(&sink, &[Vec3::X, Vec3::ZERO, vec3(0.0, 5e-4, 0.0)], Ways::Forwards);
    let last = lines[0].points().last().expect("a point");
    assert_eq!(lines[0].end(), FlowEnd::Still);
    assert!(last.at.length() <= 1e-3, "{last:?}");
    for line in &lines[1..] {
        assert_eq!((line.end(), line.points().len()), (FlowEnd::Still, 1));
    }
    // Nothing moves anywhere.
    let zero = kernel!(|state: FlowState| trace(|_p: Vec3| Some(Vec3::ZERO), state, base));
    assert_eq!(follow(&zero, &[Vec3::ONE], Ways::Both)[0].end(), FlowEnd::Still);
    // Without such a speed the line comes ever nearer, until its steps are spent.
    let endless = kernel!(|state: FlowState| trace(|p: Vec3| Some(-p), state, base));
    let line = &follow(&endless, &[Vec3::X], Ways::Forwards)[0];
    assert_eq!(line.end(), FlowEnd::Attempts, "{:?} {:?}", line.attempts(), line.points().last());
    assert!(line.points().last().expect("a point").at.length() < 1e-3);
}

/// A call ends after some tries; lines that have taken none of them go on with the next call.
#[test]
fn refused_steps_are_tried_in_several_calls() {
    let settings = settings(1e-4, 1e30).min_step(1e-37).expect("a step");
    let kernel = kernel!(|state: FlowState| {
        // The field ends next to the seed, beyond which nothing is.
        let field = |p: Vec3| if p.x <= 0.0 { Some(vec3(1.0, 0.0, 0.0)) } else { None };
        trace(field, state, settings)
    });
    let first = kernel.call((FlowState::forwards(Vec3::ZERO),));
    assert_eq!((first.state.end, first.count), (FlowEnd::Going, 0));
    assert_eq!(first.state.attempts, TRIES_PER_CALL);
    let line = &follow(&kernel, &[Vec3::ZERO], Ways::Forwards)[0];
    assert_eq!((line.end(), line.points().len()), (FlowEnd::Left, 1));
    // Each is a quarter of the one before, from a sixteenth of 1e30 to 1e-37.
    assert_eq!(line.attempts(), 111);
}

#[test]
fn attempts_are_counted() {
    for most in [0, 1, 7, 8, 9, 100] {
        let settings = settings(1e-4, 0.1).max_attempts(most).expect("attempts");
        let kernel = kernel!(|state: FlowState| {
            trace(|p: Vec3| Some(vec3(-p.y, p.x, 1.0)), state, settings)
        });
        let line = &follow(&kernel, &[Vec3::X], Ways::Forwards)[0];
        assert_eq!((line.end(), line.attempts()), (FlowEnd::Attempts, most));
        assert_eq!(line.points().len() as u32, most + 1);
    }
}

/// At a jump to another direction no step is within the tolerance, but the shortest.
#[test]
fn jumps_are_passed_or_said() {
    let settings = settings(1e-3, 0.3).max_length(2.0).expect("a length");
    let jump = kernel!(|state: FlowState| {
        let field =
            |p: Vec3| Some(if p.x < 0.5 { vec3(1.0, 0.0, 0.0) } else { vec3(0.5, 1.0, 0.0) });
        trace(field, state, settings)
    });
    let line = &follow(&jump, &[Vec3::ZERO], Ways::Forwards)[0];
    assert_eq!(line.end(), FlowEnd::Length);
    // Half a unit, and one and a half along (0.5, 1).
    let expected = vec3(0.5, 0.0, 0.0) + vec3(0.5, 1.0, 0.0).normalize() * 1.5;
    let last = line.points().last().expect("a point");
    assert!(last.at.distance(expected) < 5e-3, "{last:?}");
    // Behind this one everything is a million times as fast.
    let wall = kernel!(|state: FlowState| {
        let field = |p: Vec3| Some(vec3(if p.x < 0.5 { 1.0 } else { 1e6 }, 0.0, 1.0));
        trace(field, state, settings)
    });
    let line = &follow(&wall, &[Vec3::ZERO], Ways::Forwards)[0];
    let last = line.points().last().expect("a point");
    assert_eq!(line.end(), FlowEnd::Tolerance, "{last:?}");
    assert!((0.499..0.5).contains(&last.at.x), "{last:?}");
}

#[test]
fn bad_seeds_and_values_are_defined() {
    let settings = settings(1e-4, 0.5);
    let kernel = kernel!(|state: FlowState| {
        trace(|p: Vec3| Some(vec3(1.0, 0.0, 0.0) / (1.0 - p.x)), state, settings)
    });
    let nan = vec3(f32::NAN, 0.0, 0.0);
    let infinite = vec3(1e38, f32::INFINITY, 0.0);
    let lines = follow(&kernel, &[nan, infinite, vec3(1.0, 0.0, 0.0)], Ways::Both);
    assert_eq!(lines[0].end(), FlowEnd::NoField);
    // 1 / 0 is infinite.
    assert_eq!(lines[2].end(), FlowEnd::NoField);
    for line in &lines {
        assert!(line.points().iter().all(|p| p.velocity.is_finite()), "{line:?}");
    }
    // Towards the pole it gets faster without bound: the line ends before.
    let line = &follow(&kernel, &[Vec3::ZERO], Ways::Forwards)[0];
    assert!(line.points().iter().all(|p| p.at.is_finite() && p.velocity.is_finite()));
    assert!(line.points().last().expect("a point").at.x > 0.99);
    // Speeds near the largest, and beyond.
    for (speed, end) in
        [(1e18, FlowEnd::Length), (1e20, FlowEnd::NoField), (f32::MAX, FlowEnd::NoField)]
    {
        let settings = settings.max_length(3.0).expect("a length");
        let fast =
            kernel!(|state: FlowState| trace(|_p: Vec3| Some(Vec3::X * speed), state, settings));
        assert_eq!(follow(&fast, &[Vec3::ZERO], Ways::Forwards)[0].end(), end, "{speed}");
    }
    // Places near the largest: the field grows with them, until it has no value.
    let huge = kernel!(|state: FlowState| trace(|p: Vec3| Some(p * 1e-18), state, settings));
    for seed in [vec3(1e30, 0.0, 0.0), vec3(3e38, 3e38, 0.0), Vec3::splat(f32::MAX)] {
        let line = &follow(&huge, &[seed], Ways::Forwards)[0];
        assert_ne!(line.end(), FlowEnd::Going);
        assert!(line.points().iter().all(|p| p.at.is_finite()), "{seed}: {:?}", line.end());
    }
}

#[test]
fn no_seed_no_line() {
    let settings = settings(1e-4, 0.5);
    let kernel = kernel!(|state: FlowState| trace(|p: Vec3| Some(p), state, settings));
    assert!(follow(&kernel, &[], Ways::Both).is_empty());
}
