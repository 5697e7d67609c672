//! Rays through lenses of gradient index, those of the example `luneburg`, against closed forms.

use std::f32::consts::FRAC_PI_2;

use raydsl::prelude::*;
use raydsl::testing::{can_run, run, validate};
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::rng::Rng;

#[expect(unreachable_pub, reason = "a module of the examples' library")]
#[path = "../../../examples/src/lens.rs"]
mod example;

use example::{
    BogackiShampine, FishEye, Luneburg, Medium, Passage, RungeKutta, State, Stepper, Verlet,
    excess, through,
};

const LUNEBURG: Luneburg = Luneburg { radius: 1.0 };
const FISH_EYE: FishEye = FishEye { radius: 1.0 };

/// Rays that enter a ball of radius 1, some close to its middle and some close to its rim.
fn entries(count: u32) -> Vec<State> {
    let mut rng = Rng::of("lens");
    let mut entry = || {
        let (along, around) = (rng.point(1.0).normalize(), rng.point(1.0));
        let across = 0.95 * rng.point(1.0).x * along.cross(around).normalize();
        State { at: across - along * (1.0 - across.length_squared()).sqrt(), momentum: along }
    };
    (0..count).map(|_| entry()).collect()
}

/// Where a ray leaves a Luneburg lens, after a quarter of a turn of a harmonic oscillator.
fn behind_luneburg(entry: State) -> State {
    State { at: entry.momentum, momentum: -entry.at }
}

/// Where a ray leaves a fish-eye: opposite to its entry, in the direction that the symmetry of its
/// arc gives.
fn behind_fish_eye(entry: State) -> State {
    let State { at, momentum } = entry;
    State { at: -at, momentum: 2.0 * momentum.dot(at) * at - momentum }
}

fn distance(a: State, b: State) -> f32 {
    a.at.distance(b.at).max(a.momentum.distance(b.momentum))
}

#[track_caller]
fn assert_ends<S: Stepper>(stepper: S, first: f32, exact: fn(State) -> State, bound: f32) -> f32 {
    let mut most = 0.0f32;
    for entry in entries(500) {
        let found = through(stepper, 1.0, entry, first, 1000);
        let off = distance(found.end, exact(entry));
        assert!(found.is_out && off <= bound, "{entry:?} {found:?} {off:e}");
        assert!((found.end.at.length() - 1.0).abs() < 1e-6, "{found:?}");
        most = most.max(off);
    }
    most
}

#[test]
fn rays_end_where_closed_forms_say() {
    let medium = LUNEBURG;
    let step = FRAC_PI_2 / 32.0;
    assert_ends(Verlet { medium }, step, behind_luneburg, 2e-3);
    assert_ends(RungeKutta { medium }, step, behind_luneburg, 4e-6);
    let medium = FISH_EYE;
    assert_ends(Verlet { medium }, step, behind_fish_eye, 1e-2);
    assert_ends(RungeKutta { medium }, step, behind_fish_eye, 2e-5);
}

/// The pair's error is at most ten times its tolerance, and at least a tenth of it.
#[test]
fn tolerances_are_kept() {
    for tolerance in [1e-3f32, 1e-4, 1e-5] {
        let range = 0.1 * tolerance..10.0 * tolerance;
        let stepper = BogackiShampine { medium: LUNEBURG, tolerance };
        let most = assert_ends(stepper, 0.1, behind_luneburg, range.end);
        assert!(range.contains(&most), "{tolerance:e}: {most:e}");
        let stepper = BogackiShampine { medium: FISH_EYE, tolerance };
        let most = assert_ends(stepper, 0.1, behind_fish_eye, range.end);
        assert!(range.contains(&most), "{tolerance:e}: {most:e}");
    }
}

/// The force is half of the gradient of the square: against differences of that.
#[test]
fn forces_are_gradients() {
    #[track_caller]
    fn check<M: Medium>(medium: M, at: Vec3) {
        const H: f32 = 1e-2;
        let along = |axis: Vec3| {
            let (a, b) = (at + axis * H, at - axis * H);
            (medium.index_squared(a) - medium.index_squared(b)) / (4.0 * H)
        };
        let found = vec3(along(Vec3::X), along(Vec3::Y), along(Vec3::Z));
        assert!(found.distance(medium.force(at)) < 1e-3, "{at:?} {found:?}");
    }
    for radius in [1.0, 2.5] {
        for entry in entries(50) {
            let at = radius * 0.7 * entry.at;
            check(Luneburg { radius }, at);
            check(FishEye { radius }, at);
        }
        let rim = vec3(0.6, 0.0, 0.8) * radius;
        assert!((Luneburg { radius }.index_squared(rim) - 1.0).abs() < 1e-6);
        assert!((FishEye { radius }.index_squared(rim) - 1.0).abs() < 1e-6);
    }
}

/// In a hundred turns of a ray in a medium that goes on beyond the lens, the invariant stays what
/// it is by symplectic steps, and is lost by others of a higher order.
#[test]
fn symplectic_steps_keep_the_invariant() {
    #[track_caller]
    fn drifts<S: Stepper>(stepper: S, turns: u32) -> f32 {
        let mut state = State { at: vec3(0.6, 0.0, 0.8), momentum: -Vec3::Z };
        let mut most = 0.0f32;
        for _ in 0..16 * turns {
            state = stepper.step(state, 0.25 * FRAC_PI_2).end;
            most = most.max(excess(LUNEBURG, state).abs());
        }
        most
    }
    let (verlet, runge_kutta) = (Verlet { medium: LUNEBURG }, RungeKutta { medium: LUNEBURG });
    assert!(drifts(runge_kutta, 1) < 0.01, "{}", drifts(runge_kutta, 1));
    assert!(drifts(runge_kutta, 100) > 0.1, "{}", drifts(runge_kutta, 100));
    for turns in [1, 10, 100, 1000] {
        assert!(drifts(verlet, turns) < 0.05, "{turns}: {}", drifts(verlet, turns));
    }
}

/// Whatever cannot be followed ends after as many steps as are allowed.
#[test]
fn every_ray_ends() {
    let entry = State { at: Vec3::Z, momentum: -Vec3::Z };
    let of = |tolerance: f32, entry: State, first: f32| {
        through(BogackiShampine { medium: LUNEBURG, tolerance }, 1.0, entry, first, 300)
    };
    let nan = State { at: Vec3::splat(f32::NAN), ..entry };
    let resting = State { at: 0.5 * Vec3::Z, momentum: Vec3::ZERO };
    let given_up = |p: Passage| !p.is_out && p.steps == 300;
    for tolerance in [0.0, -1.0, f32::NAN] {
        assert!(given_up(of(tolerance, entry, 0.1)), "{tolerance}");
    }
    assert!(given_up(of(1e-4, nan, 0.1)));
    assert!(given_up(of(1e-4, entry, f32::NAN)));
    assert!(given_up(of(1e-4, entry, 0.0)));
    let verlet = Verlet { medium: LUNEBURG };
    assert!(given_up(through(verlet, 1.0, nan, 0.1, 300)));
    assert!(given_up(through(verlet, 1.0, resting, 0.1, 300)));
    assert!(given_up(through(verlet, 1.0, entry, 0.0, 300)));
    // One step is longer than the way.
    let found = through(RungeKutta { medium: LUNEBURG }, 1.0, entry, 1.8, 300);
    assert!(found.is_out && found.steps == 1 && found.end.at.distance(-Vec3::Z) < 0.1, "{found:?}");
}

#[kernel]
fn passage<S: Stepper>(stepper: S, at: Vec3, momentum: Vec3) -> Passage {
    through::<S>(stepper, 1.0, State { at, momentum }, 0.11, 100)
}

/// Of those close to the rim the bounds of rounding become too wide to mean much.
fn inputs() -> Vec<(Vec3, Vec3)> {
    let is_steep = |e: &State| e.at.dot(e.momentum) < -0.65;
    entries(250).into_iter().filter(is_steep).map(|e| (e.at, e.momentum)).collect()
}

#[track_caller]
fn assert_passages(kernel: &Kernel<'_, (Vec3, Vec3), Passage>) {
    assert!(inputs().iter().all(|&input| kernel.call(input).is_out));
    assert_variants_agree!(&*kernel, &inputs());
}

#[test]
fn variants_agree_on_fixed_steps() {
    let medium = LUNEBURG;
    let (verlet, runge_kutta) = (Verlet { medium }, RungeKutta { medium });
    assert_passages(&kernel!(|at: Vec3, momentum: Vec3| passage(verlet, at, momentum)));
    assert_passages(&kernel!(|at: Vec3, momentum: Vec3| passage(runge_kutta, at, momentum)));
    let medium = FISH_EYE;
    let (verlet, runge_kutta) = (Verlet { medium }, RungeKutta { medium });
    assert_passages(&kernel!(|at: Vec3, momentum: Vec3| passage(verlet, at, momentum)));
    assert_passages(&kernel!(|at: Vec3, momentum: Vec3| passage(runge_kutta, at, momentum)));
}

/// Packets have the same bits. The error of a step is a small difference of slopes, so a device's
/// rounding may change the length of the next one by much: its ends differ by no more than the
/// tolerance, and its steps by one.
#[track_caller]
fn assert_adaptive(kernel: &Kernel<'_, (Vec3, Vec3), Passage>, tolerance: f32) {
    let inputs = inputs();
    let expected = run(kernel, Variant::Scalar, &inputs);
    assert!(expected.iter().all(|p| p.is_out));
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        assert_eq!(run(kernel, variant, &inputs), expected, "{variant:?}");
    }
    validate(kernel).expect("valid WGSL");
    if !can_run(Variant::Wgsl, "assert_adaptive") {
        return;
    }
    let mut most = 0.0f32;
    for (a, b) in expected.iter().zip(run(kernel, Variant::Wgsl, &inputs)) {
        let off = distance(a.end, b.end);
        assert!(off <= tolerance && a.steps.abs_diff(b.steps) <= 1 && b.is_out, "{a:?} {b:?}");
        most = most.max(off);
    }
    println!("a device's ends differ by {most:e}");
}

#[test]
fn variants_agree_on_adaptive_steps() {
    let tolerance = 1e-4;
    let pair = BogackiShampine { medium: LUNEBURG, tolerance };
    assert_adaptive(&kernel!(|at: Vec3, momentum: Vec3| passage(pair, at, momentum)), tolerance);
    let pair = BogackiShampine { medium: FISH_EYE, tolerance };
    assert_adaptive(&kernel!(|at: Vec3, momentum: Vec3| passage(pair, at, momentum)), tolerance);
}
