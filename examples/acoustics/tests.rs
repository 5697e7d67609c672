//! Image sources against closed forms, and rays against image sources.

use std::f64::consts::PI;

use glam::{DVec3, dvec3};
use raydsl::assert_variants_agree;
use raydsl::prelude::*;

use super::bins::{Bins, faded};
use super::decay::{backward_integral, relative_error, reverberation_time};
use super::images::{along, of_shell, response};
use super::mean_z2;
use super::paths::{Heard, Path, fly, trace};
use super::room::{Room, SPEED};

const ROOM: Room = Room {
    size: dvec3(7.1, 5.3, 3.7),
    absorption: [0.1, 0.3, 0.15, 0.25, 0.2, 0.4],
    air: 0.002,
    source: dvec3(1.6, 1.9, 1.5),
    receiver: dvec3(5.2, 3.4, 1.7),
    radius: 0.6,
};
const BINS: Bins = Bins { count: 100, length: 0.343 };

fn heard(room: &Room, bins: Bins, rays: u32, seed: u32) -> Heard {
    let walls = room.walls();
    let tree = Bvh::build(&walls).expect("finite bounds");
    let (receiver, reach) = (room.ball(), bins.reach() as f32);
    let kernel = kernel!(|path: Path| fly(&tree, receiver, reach, path));
    trace(room, bins, (rays, seed), &kernel)
}

#[test]
fn first_images_are_those_of_a_drawing() {
    let images = along(&ROOM, 0, 10.0);
    let expected = [
        (1.6 - 5.2, 1.0),                   // the source
        (-1.6 - 5.2, 0.9),                  // behind x = 0
        (2.0 * 7.1 - 1.6 - 5.2, 0.7),       // behind x = 7.1
        (1.6 - 2.0 * 7.1 + 5.2, f64::NAN),  // of no mirror
        (2.0 * 7.1 + 1.6 - 5.2, 0.9 * 0.7), // behind both, too far
    ];
    for (i, (offset, energy)) in expected.into_iter().enumerate() {
        let found = images.iter().find(|m| (m.offset - offset).abs() < 1e-12);
        match i {
            0..3 => assert!((found.expect("an image").energy - energy).abs() < 1e-15),
            _ => assert!(found.is_none(), "{i}"),
        }
    }
    assert_eq!(images.len(), 3);
    let both = along(&ROOM, 0, 10.7);
    assert!(both.iter().any(|m| (m.offset - 10.6).abs() < 1e-9 && (m.energy - 0.63).abs() < 1e-12));
}

/// Against a sum over small cubes of the ball.
#[test]
fn a_shell_is_the_mean_over_the_ball() {
    let (distance, from, to) = (1.4, 1.1, 1.7);
    let n = 60;
    let step = 2.0 * ROOM.radius / f64::from(n);
    let (mut sum, mut count) = (0.0, 0);
    for i in 0..n * n * n {
        let at = |k: i32| (f64::from(k % n) + 0.5) * step - ROOM.radius;
        let p = dvec3(at(i), at(i / n), at(i / n / n));
        if p.length() < ROOM.radius {
            count += 1;
            let r = (p + DVec3::X * distance).length();
            if (from..to).contains(&r) {
                sum += (-ROOM.air * r).exp() / (4.0 * PI * r * r);
            }
        }
    }
    let (found, brute) = (of_shell(&ROOM, distance, from, to), sum / f64::from(count));
    assert!((found / brute - 1.0).abs() < 5e-3, "{found} {brute}");
}

/// Where nothing is lost, energy spreads evenly: in a bin of `s` metres, `s` over the volume.
#[test]
fn without_losses_the_field_becomes_even() {
    let room = Room { absorption: [0.0; 6], air: 0.0, ..ROOM };
    let bins = Bins { count: 400, length: 0.343 };
    let late = &response(&room, bins)[200..];
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    let even = bins.length / room.size.element_product();
    assert!((mean / even - 1.0).abs() < 5e-3, "{mean} {even}");
}

#[test]
fn parts_add_up() {
    for (from, to) in [(0.0, 0.1), (0.2, 1.5), (-0.3, 0.4), (34.0, 36.0), (50.0, 51.0)] {
        let parts: Vec<_> = BINS.parts(from, to).collect();
        let sum: f64 = parts.iter().map(|(_, low, high)| high - low).sum();
        // What would be before the source is in no bin.
        let inside = (f64::min(to, BINS.reach()) - f64::max(from, 0.0)).max(0.0);
        assert!((sum - inside).abs() < 1e-12, "{from} {to}: {parts:?}");
        assert!(parts.iter().all(|(i, ..)| *i < BINS.count));
    }
    for air in [0.0, 1e-9, 0.1] {
        let whole = faded(air, 1.0, 9.0);
        assert!((faded(air, 1.0, 4.0) + faded(air, 4.0, 9.0) - whole).abs() < 1e-14);
    }
    assert!((faded(0.5, 0.0, 2.0) - 2.0 * (1.0 - (-1.0f64).exp())).abs() < 1e-15);
}

/// Bin by bin, and in sum. A wrong loss at a wall or in the air, or a wrong volume, is found.
#[test]
fn rays_hear_what_image_sources_say() {
    let truth = response(&ROOM, BINS);
    let heard = heard(&ROOM, BINS, 16_000, 1);
    assert!(heard.lost < 3, "{}", heard.lost);
    let z2 = mean_z2(&heard, &truth, 20, 5);
    assert!((0.2..2.3).contains(&z2), "{z2}");
    let sum = |r: &[f64]| r.iter().sum::<f64>();
    for part in [0..30, 30..60, 60..100, 0..100] {
        let found = sum(&heard.response()[part.clone()]);
        let (expected, error) = (sum(&truth[part.clone()]), heard.standard_error(part.clone()));
        assert!((found - expected).abs() < 4.0 * error, "{part:?}: {found} {expected} ± {error}");
        assert!(error < 0.07 * expected, "{part:?}: {error} of {expected}");
    }
}

#[test]
fn errors_fall_with_the_root_of_rays() {
    let bins = Bins { count: 60, ..BINS };
    let truth = response(&ROOM, bins);
    let error = |rays: u32| {
        let square = |seed| relative_error(&heard(&ROOM, bins, rays, seed).response(), &truth, 25);
        ((2..6).map(|seed| square(seed).powi(2)).sum::<f64>() / 4.0).sqrt()
    };
    let slope = (error(3200) / error(400)).log(8.0);
    assert!((slope + 0.5).abs() < 0.12, "{slope}");
}

/// More arrivals than a flight returns: the rest follows, so a small list loses nothing. A large
/// receiver is crossed after almost each reflection.
#[test]
fn long_paths_are_continued() {
    let room = Room {
        source: dvec3(0.05, 0.1, 0.1),
        radius: 1.75,
        receiver: dvec3(3.5, 2.6, 1.85),
        ..ROOM
    };
    room.check().expect("a room");
    let bins = Bins { count: 300, ..BINS };
    let truth = response(&room, bins);
    let heard = heard(&room, bins, 1600, 3);
    let late = |r: &[f64]| r[150..].iter().sum::<f64>();
    let (found, error) = (late(&heard.response()), heard.standard_error(150..300));
    assert!((found - late(&truth)).abs() < 4.0 * error, "{found} {} ± {error}", late(&truth));
    assert!(error < 0.25 * found, "{error} of {found}");
}

#[test]
fn variants_agree() {
    let walls = ROOM.walls();
    let tree = Bvh::build(&walls).expect("finite bounds");
    let (receiver, reach) = (ROOM.ball(), 20.0);
    let kernel = kernel!(|path: Path| fly(&tree, receiver, reach, path));
    let source = ROOM.source.as_vec3();
    let inputs: Vec<(Path,)> = (0..200).map(|i| (Path::emitted(source, 1, i),)).collect();
    assert_variants_agree!(&kernel, &inputs);
}

#[test]
fn an_exponential_has_its_time() {
    let (step, time) = (1e-3, 0.4);
    let response: Vec<f64> =
        (0..800).map(|i| 10f64.powf(-6.0 * f64::from(i) * step / time)).collect();
    for low in [-25.0, -35.0] {
        let found = reverberation_time(&response, step, low).expect("it is long enough");
        assert!((found / time - 1.0).abs() < 1e-4, "{found}");
        assert_eq!(reverberation_time(&response[..160], step, low), None);
    }
    assert_eq!(backward_integral(&response)[0], 0.0);
}

/// The formulas against their usual form in metric units, 0.161 V / A.
#[test]
fn formulas_are_those_of_textbooks() {
    let room = Room { absorption: [0.2; 6], air: 0.0, ..ROOM };
    let (v, s) = (7.1 * 5.3 * 3.7, 2.0 * (7.1 * 5.3 + 7.1 * 3.7 + 5.3 * 3.7));
    assert!((room.sabine() / (0.1611 * v / (0.2 * s)) - 1.0).abs() < 1e-3);
    assert!((room.eyring() / (0.1611 * v / (s * -(0.8f64.ln()))) - 1.0).abs() < 1e-3);
    let air = Room { absorption: [1e-12; 6], air: 0.003, ..ROOM };
    assert!((air.sabine() / (60.0 / (10.0 * 0.003 * SPEED / 10f64.ln())) - 1.0).abs() < 1e-6);
}

#[test]
fn rooms_are_checked() {
    let wrong = [
        (Room { size: dvec3(7.0, 0.0, 3.0), ..ROOM }, "--room"),
        (Room { size: dvec3(7.0, f64::NAN, 3.0), ..ROOM }, "--room"),
        (Room { absorption: [1.1; 6], ..ROOM }, "--absorption"),
        (Room { source: dvec3(-1.0, 1.0, 1.0), ..ROOM }, "--source"),
        (Room { receiver: dvec3(0.5, 1.0, 1.0), ..ROOM }, "--receiver"),
        (Room { source: ROOM.receiver, ..ROOM }, "within the receiver"),
    ];
    assert_eq!(ROOM.check(), Ok(()));
    for (room, remedy) in wrong {
        assert!(room.check().is_err_and(|e| e.contains(remedy)), "{room:?}");
    }
}
