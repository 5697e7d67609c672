//! Errors of lines against `f64`.

use raydsl::flow::{FlowEnd, FlowPoint, FlowState, Ways, trace};
use raydsl::prelude::*;

use super::fields::{Field, velocity};
use super::{follow, settings};

/// What a line with a tolerance is off at its end, and how many steps it tried.
fn error_of(field: Field, tolerance: f32) -> (f64, u32) {
    let (seed, time, max_step) = field.case();
    let settings = settings(tolerance, max_step).max_time(time).expect("a time");
    let number = field.number();
    let kernel =
        kernel!(|state: FlowState| trace(|p: Vec3| Some(velocity(number, p)), state, settings));
    let lines = follow(&kernel, &[seed], Ways::Forwards);
    assert_eq!(lines[0].end(), FlowEnd::Time, "{field:?} {tolerance}");
    let last = lines[0].points().last().expect("a point");
    assert_eq!(last.time, time);
    (last.at.as_dvec3().distance(field.exact(seed, time)), lines[0].attempts())
}

/// How many times the tolerance of a step a line may be off in the end. The field amplifies errors: by
/// e^3 on the saddle, more in Lorenz' butterfly, and around the vortex, where a line turns faster the
/// nearer it is to the axis.
fn factor(field: Field) -> f64 {
    match field {
        Field::Rotation => 8.0,
        // An error at a corner has the sign of the corner, not of chance.
        Field::Corners => 40.0,
        Field::Abc => 30.0,
        Field::Saddle => 20.0,
        Field::Lorenz => 60.0,
        Field::Vortex => 150.0,
        Field::Stiff => 3.0,
    }
}

#[test]
fn tolerances_are_honoured() {
    for field in Field::ALL {
        let mut row = format!("{field:?}:");
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            let (error, attempts) = error_of(field, tolerance);
            row += &format!("  {tolerance:.0e}: {error:.1e} {attempts}");
            // Rounding of the field itself, some ulps of the place in each step.
            let rounding = 2e-6 * f64::from(factor(field) as f32 / 8.0).max(1.0);
            let allowed = factor(field) * f64::from(tolerance) + rounding;
            assert!(error <= allowed, "{row}: at most {allowed:.1e}");
        }
        println!("{row}");
    }
}

/// One step, as a tolerance above every error has it, in `f64`: that of half the time has an error
/// that is 2^6 times as small.
#[test]
fn steps_have_order_five() {
    for field in [Field::Rotation, Field::Saddle, Field::Abc] {
        let (seed, ..) = field.case();
        let error = |steps: u32| {
            let time = 1.0 / steps as f32;
            let settings = settings(1e6, 1e6).max_time(time).expect("a time");
            let number = field.number();
            let kernel = kernel!(|state: FlowState| {
                trace(|p: Vec3| Some(velocity(number, p)), state, settings).points[0].at
            });
            let found = kernel.reference((FlowState::forwards(seed),));
            field.exact(seed, time).distance(glam::DVec3::from_slice(&found))
        };
        let (coarse, fine) = (error(1), error(2));
        let order = (coarse / fine).log2();
        println!("{field:?}: {coarse:.2e} {fine:.2e}, order {order:.2}");
        assert!((5.6..7.3).contains(&order), "{field:?}: {order}");
    }
}

/// A tenth of the tolerance needs 10^(1/5) times as many steps.
#[test]
fn steps_grow_with_the_fifth_root() {
    for field in [Field::Rotation, Field::Abc, Field::Vortex, Field::Lorenz, Field::Stiff] {
        let (_, few) = error_of(field, 1e-4);
        let (_, many) = error_of(field, 1e-6);
        let ratio = f64::from(many) / f64::from(few);
        let expected = 100f64.powf(0.2);
        println!("{field:?}: {few} {many} {ratio:.2}");
        assert!((0.65..1.3).contains(&(ratio / expected)), "{field:?}: {few} {many}");
    }
}

/// Between the ends of steps the curve of order 4 is about as good, against time too.
#[test]
fn dense_output_is_as_good_as_steps() {
    for field in [Field::Rotation, Field::Saddle, Field::Abc, Field::Vortex] {
        let (seed, time, max_step) = field.case();
        for (tolerance, ways) in
            [(1e-3, Ways::Forwards), (1e-5, Ways::Forwards), (1e-5, Ways::Backwards)]
        {
            let sign = if ways == Ways::Backwards { -1.0 } else { 1.0 };
            let settings = settings(tolerance, max_step).max_time(time).expect("a time");
            let number = field.number();
            let kernel = kernel!(|state: FlowState| {
                trace(|p: Vec3| Some(velocity(number, p)), state, settings)
            });
            let line = &follow(&kernel, &[seed], ways)[0];
            let mut worst = 0.0f64;
            for i in 0..=40 {
                let at = sign * time * i as f32 / 40.0;
                let found = line.at(at).expect("a time of the line");
                let exact = field.exact(seed, at);
                worst = worst.max(found.at.as_dvec3().distance(exact));
                let speed = field.at(exact);
                let off = found.velocity.as_dvec3().distance(speed) / speed.length();
                assert!(off <= 300.0 * f64::from(tolerance) + 1e-4, "{field:?} {at}: {off}");
            }
            let allowed = 2.0 * factor(field) * f64::from(tolerance) + 4e-6;
            assert!(worst <= allowed, "{field:?} {tolerance}: {worst:.1e}");
            assert_eq!((line.at(-0.1 * sign), line.at(sign * time * 1.1)), (None, None));
        }
    }
}

/// A line that is followed back from its end comes back to the seed, and lengths are right.
#[test]
fn ways_are_joined() {
    let settings = settings(1e-6, 1.0).max_time(2.0).expect("a time");
    let kernel = kernel!(|state: FlowState| {
        trace(|p: Vec3| Some(vec3(-p.y, p.x, 0.75)), state, settings)
    });
    let seed = vec3(1.0, 0.0, 0.0);
    let line = &follow(&kernel, &[seed], Ways::Both)[0];
    assert_eq!((line.begin(), line.end()), (Some(FlowEnd::Time), FlowEnd::Time));
    let points = line.points();
    assert!(points.windows(2).all(|p| p[0].time < p[1].time && p[0].length < p[1].length));
    assert!(points.iter().any(|p| p.at == seed && p.time == 0.0));
    for i in -20..=20 {
        let t = i as f32 * 0.1;
        let found = line.at(t).expect("a time of the line");
        let (sin, cos) = t.sin_cos();
        assert!(found.at.distance(vec3(cos, sin, 0.75 * t)) < 1e-5, "{t}: {found:?}");
        assert!(found.velocity.distance(vec3(-sin, cos, 0.75)) < 1e-4, "{t}: {found:?}");
        // The speed is 1.25.
        assert!((found.length - 1.25 * t).abs() < 1e-5, "{t}: {found:?}");
    }
    let polygon = line.polygon(0.1);
    for pair in polygon.windows(2) {
        assert!(pair[0].velocity.angle_between(pair[1].velocity) < 0.12);
    }
}

/// At a speed of e^t from x = 1 the length is e^t - 1, at the ends of steps and between them, and of
/// the sign of time.
#[test]
fn lengths_follow_the_speed() {
    let settings = settings(1e-6, 0.5).max_time(2.0).expect("a time");
    let kernel = kernel!(|state: FlowState| trace(|p: Vec3| Some(p), state, settings));
    let line = &follow(&kernel, &[Vec3::X], Ways::Both)[0];
    let off = |point: FlowPoint| {
        let length = f64::from(point.time).exp_m1();
        (f64::from(point.length) - length).abs() / f64::from(point.time).exp()
    };
    let ends = line.points().iter().map(|point| off(*point)).fold(0.0, f64::max);
    let all = (-200..=200).map(|i| line.at(i as f32 * 0.01).expect("a time of the line"));
    let between = all.map(off).fold(0.0, f64::max);
    let steps = line.points().windows(2).map(|pair| f64::from(pair[1].time - pair[0].time));
    let longest = steps.fold(0.0, f64::max);
    // The remainder of a cubic of Hermite, whose fourth derivative grows by e^step within a step.
    let remainder = longest.powi(4) / 384.0 * longest.exp();
    assert!(ends < 2e-6, "{ends:.1e}");
    assert!(between < remainder + 2e-6, "{between:.1e}, and a remainder of {remainder:.1e}");
}

/// What rounding loses of places is carried along: far away from the origin, where a place has an ulp
/// of 6e-5, a circle of 12,566 steps closes to within five of them.
#[test]
fn many_steps_lose_nothing() {
    let time = core::f32::consts::TAU;
    let center = vec3(1000.0, -800.0, 0.0);
    let error = |max_step: f32| {
        let settings = settings(1e-4, max_step).max_time(time).expect("a time");
        let settings = settings.max_attempts(60_000).expect("attempts");
        let kernel = kernel!(|state: FlowState| {
            let field = |p: Vec3| {
                let off = p - center;
                Some(vec3(off.y, -off.x, 0.0))
            };
            trace(field, state, settings)
        });
        let line = &follow(&kernel, &[center + vec3(2.0, 0.0, 0.0)], Ways::Forwards)[0];
        let last = line.points().last().expect("a point");
        assert_eq!(line.end(), FlowEnd::Time);
        println!("{max_step}: {} after {} steps", last.at - center, line.attempts());
        last.at.distance(center + vec3(2.0, 0.0, 0.0))
    };
    // Half an ulp of 6e-5 in each of 12,566 steps would be off by some 2e-3.
    assert!(error(1e-3) < 3e-4);
    assert!(error(1.0) < 3e-3);
}
