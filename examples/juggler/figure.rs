//! A juggler made of spheres, and the balls in the air.

use std::f32::consts::TAU;

use raydsl::prelude::*;

/// A sphere with a colour.
#[primitive(sphere(center, radius))]
#[derive(Debug)]
pub(crate) struct Ball {
    /// Its centre.
    pub(crate) center: Vec3,
    /// Its radius.
    pub(crate) radius: f32,
    /// Red, green, blue.
    pub(crate) color: [Unorm8; 3],
    /// How much of the light that it sends comes from elsewhere.
    pub(crate) mirror: Unorm8,
}

const SKIN: [f32; 3] = [0.94, 0.62, 0.5];
const SHIRT: [f32; 3] = [0.86, 0.1, 0.1];
const HAIR: [f32; 3] = [0.28, 0.14, 0.06];
const EYES: [f32; 3] = [0.1, 0.25, 0.85];
const GLASS: [f32; 3] = [0.95, 0.95, 0.97];

fn ball(center: Vec3, radius: f32, color: [f32; 3], mirror: f32) -> Ball {
    Ball { center, radius, color: color.map(Unorm8::new), mirror: Unorm8::new(mirror) }
}

/// `count` spheres from `a` to `b`, whose radius goes from `ra` to `rb`.
fn limb(
    (a, ra): (Vec3, f32),
    (b, rb): (Vec3, f32),
    count: u32,
    color: [f32; 3],
) -> impl Iterator<Item = Ball> {
    let share = move |i: u32| i as f32 / (count - 1) as f32;
    (0..count).map(move |i| ball(a.lerp(b, share(i)), ra + (rb - ra) * share(i), color, 0.0))
}

/// Where a joint is that bends towards `way`: `near` and `far` from the two ends.
fn joint(a: Vec3, b: Vec3, near: f32, far: f32, way: Vec3) -> Vec3 {
    let along = b - a;
    let d = along.length().min(near + far);
    let x = (d * d + near * near - far * far) / (2.0 * d);
    let axis = along.normalize();
    let aside = (way - axis * way.dot(axis)).normalize();
    a + axis * x + aside * (near * near - x * x).max(0.0).sqrt()
}

/// How much of the time between two throws a ball lies in a hand.
const HELD: f32 = 0.3;

/// The circle of a hand, where the ball in it is: caught at 0, thrown at half a turn, further
/// inside.
fn carried(side: f32, turns: f32) -> Vec3 {
    let (sin, cos) = (turns * TAU).sin_cos();
    vec3(side * (0.56 + 0.2 * cos), 1.45 - 0.12 * sin, 0.6)
}

/// A hand at `phase` of its round: it takes a ball inwards, and goes back without one.
fn hand(side: f32, phase: f32) -> Vec3 {
    // A round is two thirds of the time between two throws of a ball.
    let (phase, thrown) = (phase.rem_euclid(1.0), HELD * 1.5);
    let back = 0.5 + 0.5 * (phase - thrown) / (1.0 - thrown);
    let turns = if phase < thrown { 0.5 * phase / thrown } else { back };
    carried(side, turns) - Vec3::Y * 0.23
}

/// A ball at `phase` of its way, which is closed: from hand to hand and back.
fn thrown(phase: f32) -> Vec3 {
    let half = (2.0 * phase).rem_euclid(2.0);
    let (side, share) = if half < 1.0 { (1.0, half) } else { (-1.0, half - 1.0) };
    if share < HELD {
        return carried(side, 0.5 * share / HELD);
    }
    let s = (share - HELD) / (1.0 - HELD);
    carried(side, 0.5).lerp(carried(-side, 0.0), s) + Vec3::Y * (6.4 * s * (1.0 - s))
}

/// The juggler and three balls; at 1 all is again as at 0, but each ball where the next one was.
pub(crate) fn figure(phase: f32) -> Vec<Ball> {
    let bob = Vec3::Y * (0.035 * (2.0 * TAU * phase).cos());
    let (hips, chest) = (vec3(0.0, 0.98, 0.0) + bob, vec3(0.0, 1.56, 0.02) + bob);
    let head = chest + Vec3::Y * 0.6;
    let mut all: Vec<Ball> = limb((hips, 0.2), (chest, 0.31), 14, SHIRT).collect();
    all.extend(limb((chest, 0.1), (head, 0.1), 6, SKIN));
    for side in [-1.0, 1.0] {
        let (hip, foot) = (hips + Vec3::X * 0.14 * side, vec3(0.3 * side, 0.09, 0.0));
        let knee = joint(hip, foot, 0.47, 0.47, vec3(0.5 * side, 0.0, 1.0));
        all.extend(limb((hip, 0.15), (knee, 0.11), 12, SKIN));
        all.extend(limb((knee, 0.11), (foot, 0.08), 12, SKIN));
        all.extend(limb((foot, 0.085), (foot + vec3(0.03 * side, -0.01, 0.2), 0.07), 4, SHIRT));
        // The hands take turns.
        let hand = hand(side, phase + 0.25 * (1.0 - side));
        let shoulder = chest + vec3(0.33 * side, 0.12, 0.0);
        let elbow = joint(shoulder, hand, 0.5, 0.5, vec3(0.8 * side, -1.0, -0.4));
        all.extend(limb((shoulder, 0.12), (elbow, 0.085), 12, SKIN));
        all.extend(limb((elbow, 0.085), (hand, 0.06), 12, SKIN));
        all.push(ball(hand, 0.085, SKIN, 0.0));
    }
    all.push(ball(head, 0.25, SKIN, 0.0));
    all.push(ball(head + vec3(0.0, 0.05, -0.045), 0.257, HAIR, 0.0));
    all.extend(
        [-1.0, 1.0].map(|side| ball(head + vec3(0.09 * side, 0.03, 0.215), 0.042, EYES, 0.0)),
    );
    all.push(ball(head + vec3(0.0, -0.04, 0.25), 0.035, SKIN, 0.0));
    all.extend((0..3).map(|i| ball(thrown((phase + i as f32) / 3.0), 0.2, GLASS, 0.85)));
    all
}
