//! A scanner over surfaces that are known in closed form, and over the landscape.

use std::path::PathBuf;
use std::{env, fs, process};

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl_examples::cloud::{Cover, Facets, facets};

use super::echoes::{Returns, Surfaces, range_error, returns};
use super::points::{Point, check_las, write_las};
use super::scanner::{Mirror, Scanner};

const STILL: Scanner = Scanner {
    altitude: 300.0,
    speed: 60.0,
    half_line: 100.0,
    spacing: 60.0,
    lines: 2,
    line_pulses: 2000,
    pulse_rate: 600.0,
    turn_pulses: 97,
    mirror: Mirror::Polygon,
    swing: 20.0 / 360.0,
    wobble: 0.0,
    half_divergence: 0.0,
    noise: 0.0,
    separation: 0.6,
    threshold: 0.01,
    seed: 1,
};
const SHAKEN: Scanner =
    Scanner { wobble: 1.0 / 360.0, half_divergence: 2.5e-4, noise: 0.02, ..STILL };

/// Level squares, wider than the flight, at these heights.
fn layers(heights: &[(Cover, f32)]) -> Facets {
    let corner = |x: f32, y: f32, z| vec3(400.0 * x, 400.0 * y, z);
    let halves = |&(cover, z): &(Cover, f32)| {
        let (low, high) = (corner(-1.0, -1.1, z), corner(1.0, 1.2, z));
        let lower = Triangle { v0: low, v1: corner(1.3, -1.0, z), v2: high };
        [lower, Triangle { v0: low, v1: high, v2: corner(-1.0, 1.0, z) }].map(|t| (cover, t))
    };
    Facets::new(heights.iter().flat_map(halves).collect())
}

fn scan(land: &Facets, scanner: Scanner) -> Vec<Returns> {
    let tree = Bvh::build(&land.triangles).expect("finite bounds");
    let surfaces = Surfaces::new(land.first_leaf());
    let kernel = kernel!(|pulse: u32| returns(&tree, surfaces, scanner, pulse));
    let inputs: Vec<(u32,)> = (0..scanner.lines * scanner.line_pulses).map(|i| (i,)).collect();
    let mut found = vec![Returns::default(); inputs.len()];
    kernel.run(Variant::widest(), &inputs, &mut found);
    found
}

/// Over level ground the range is the height over the cosine of the angle, in `f64`, and the
/// intensity has the same cosine three times: once of the surface, and of the distance squared.
#[test]
fn level_ground_is_as_far_as_trigonometry_says() {
    for mirror in [Mirror::Polygon, Mirror::Oscillating] {
        let scanner = Scanner { mirror, ..STILL };
        let found = scan(&layers(&[(Cover::Ground, 0.0)]), scanner);
        let mut largest = 0.0f64;
        for (pulse, returns) in (0u32..).zip(&found) {
            assert_eq!(returns.count, 1);
            let phase = f64::from(pulse % 2000 % 97) / 97.0;
            let share = match mirror {
                Mirror::Polygon => 2.0 * phase - 1.0,
                Mirror::Oscillating => (phase * std::f64::consts::TAU).sin(),
            };
            let cosine = (20.0 * share).to_radians().cos();
            let range = f64::from(returns.echoes[0].true_range);
            assert!((range * cosine / 300.0 - 1.0).abs() < 2e-6, "{pulse}: {range}");
            let intensity = f64::from(returns.echoes[0].intensity);
            assert!((intensity / (0.3 * cosine.powi(3)) - 1.0).abs() < 1e-5, "{pulse}");
            largest = largest.max(share.abs());
        }
        assert!(largest > 0.99, "{largest}");
    }
}

#[test]
fn lines_cover_the_square_there_and_back() {
    let places = [0, 1999, 2000, 3999].map(|pulse| STILL.beam(pulse).origin);
    let expected = [[-30.0, -100.0], [-30.0, 99.9], [30.0, 100.0], [30.0, -99.9]];
    for (place, [x, y]) in places.iter().zip(expected) {
        assert!(place.distance(vec3(x, y, 300.0)) < 1e-3, "{place}");
    }
    // The right of the flight is the other side of the world on the way back.
    let aside = |pulse| STILL.beam(pulse).axis.x;
    assert!(aside(0) < -0.3 && aside(2000) > 0.3);
}

#[test]
fn ranges_have_the_noise_that_was_asked_for() {
    let land = layers(&[(Cover::Ground, 0.0), (Cover::Leaves, 8.0)]);
    let found = scan(&land, SHAKEN);
    let count = found.iter().map(|r| r.count).sum::<u32>();
    assert_eq!(count, 8000);
    // Four standard errors of a standard deviation.
    let error = range_error(&found);
    assert!((error / 0.02 - 1.0).abs() < 4.0 / f64::from(2 * count).sqrt(), "{error}");
    let errors = found.iter().flat_map(Returns::iter).map(|e| f64::from(e.range - e.true_range));
    let mean = errors.sum::<f64>() / f64::from(count);
    assert!(mean.abs() < 4.0 * 0.02 / f64::from(count).sqrt(), "{mean}");
    assert_eq!(range_error(&scan(&land, Scanner { noise: 0.0, ..SHAKEN })), 0.0);
}

/// Of the light of a Gaussian beam, 1/e² goes beyond its half angle.
#[test]
fn a_beam_has_its_divergence() {
    let wide = Scanner { half_divergence: 0.01, swing: 0.0, ..STILL };
    let found = scan(&layers(&[(Cover::Ground, 0.0)]), wide);
    let bound = 300.0 * (1.0 + 0.01f32.powi(2)).sqrt();
    let beyond = found.iter().filter(|r| r.echoes[0].true_range > bound).count() as f64;
    let (n, p) = (found.len() as f64, (-2.0f64).exp());
    assert!((beyond - n * p).abs() < 4.0 * (n * p * (1.0 - p)).sqrt(), "{beyond} of {n}");
}

#[test]
fn leaves_share_a_pulse() {
    let scanner = Scanner { swing: 0.0, ..STILL };
    let (leaf, ground) = (Cover::Leaves, Cover::Ground);
    // The second layer is too near behind the first one to be told from it, but takes its light.
    let land = layers(&[(ground, 0.0), (leaf, 10.0), (leaf, 9.7), (leaf, 4.0)]);
    for returns in scan(&land, scanner) {
        let found: Vec<_> = returns.iter().map(|e| (e.range, e.intensity)).collect();
        let expected = [
            (290.0, 0.45 * 0.5),
            (296.0, 0.55f32.powi(2) * 0.45 * 0.5),
            (300.0, 0.55f32.powi(3) * 0.3),
        ];
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for ((range, intensity), (far, light)) in found.iter().zip(expected) {
            let light = light * (300.0 / far) * (300.0 / far);
            assert!((range - far).abs() < 1e-3 && (intensity / light - 1.0).abs() < 1e-4);
        }
    }
    // Nothing is left for the ground, or no place in the list.
    let many: Vec<_> = (0..8).map(|i| (leaf, 2.0 * i as f32)).collect();
    assert!(scan(&layers(&many), scanner).iter().all(|r| r.count == 5));
    let high = Scanner { threshold: 0.1, ..scanner };
    assert!(scan(&layers(&many), high).iter().all(|r| r.count == 2));
}

#[test]
fn the_landscape_is_sorted_and_in_its_square() {
    let land = facets(7);
    let all = 0..land.triangles.len();
    let covers: Vec<Cover> = all.clone().map(|i| land.cover(i)).collect();
    assert!(covers.is_sorted());
    let count = |cover| covers.iter().filter(|c| **c == cover).count();
    for cover in [Cover::Ground, Cover::Built, Cover::Wood, Cover::Leaves] {
        assert!(count(cover) > 1000, "{cover:?}: {}", count(cover));
    }
    assert_eq!(all.len() - count(Cover::Leaves), land.first_leaf() as usize);
    // Branches reach beyond the square.
    let is_near = |v: Vec3| v.x.abs().max(v.y.abs()) < 105.0 && (-10.0..90.0).contains(&v.z);
    assert!(land.triangles.iter().all(|t| is_near(t.v0) && is_near(t.v1) && is_near(t.v2)));
}

#[test]
fn variants_agree_over_the_landscape() {
    let land = facets(7);
    let tree = Bvh::build(&land.triangles).expect("finite bounds");
    let surfaces = Surfaces::new(land.first_leaf());
    let kernel = kernel!(|pulse: u32| returns(&tree, surfaces, SHAKEN, pulse));
    let inputs: Vec<(u32,)> = (0..100).map(|i| (i * 37 + 5,)).collect();
    assert_variants_agree!(&kernel, &inputs);
    let found: Vec<Returns> = inputs.iter().map(|&input| kernel.call(input)).collect();
    assert!(found.iter().any(|r| r.count > 2) && found.iter().any(|r| r.count == 1));
}

fn folder() -> PathBuf {
    let folder = env::temp_dir().join(format!("raydsl-lidar-{}", process::id()));
    fs::create_dir_all(&folder).expect("a folder for files of tests");
    folder
}

#[test]
fn a_file_has_what_was_measured() {
    let land = layers(&[(Cover::Ground, 0.0), (Cover::Leaves, 8.0)]);
    let measured = scan(&land, SHAKEN);
    let all = (0u32..).zip(&measured);
    let points: Vec<Point> =
        all.flat_map(|(pulse, returns)| Point::of(&SHAKEN, &land, pulse, returns)).collect();
    let path = folder().join("lidar.las");
    write_las(&points, &path).expect("the folder is there");
    check_las(&points, &path).expect("the same points");
    let mut moved = points.clone();
    moved[17].position.y += 0.002;
    assert!(check_las(&moved, &path).is_err_and(|e| e.starts_with("point 17 ")));
    assert!(check_las(&points[1..], &path).is_err_and(|e| e.contains("8000 points of 7999")));

    let mut reader = las::Reader::from_path(&path).expect("a LAS file");
    let header = reader.header();
    assert_eq!((header.version().major, header.version().minor), (1, 4));
    assert_eq!(header.number_of_points_by_return(2), Some(4000));
    let read = reader.read_all().expect("all points");
    for (las, point) in read.points().zip(&points) {
        let las = las.expect("a point");
        assert_eq!(las.gps_time, Some(point.gps_time));
        assert_eq!((las.return_number, las.number_of_returns), (point.return_number, 2));
        assert_eq!((las.intensity, las.point_source_id), (point.intensity, point.line + 1));
        assert!((las.scan_angle - point.angle).abs() < 0.0061);
        let is_leaf = las.classification == las::point::Classification::HighVegetation;
        assert_eq!(is_leaf, point.return_number == 1);
    }
    // 2000 pulses of 600 a second, and the way round.
    assert!((points[4000].gps_time - points[0].gps_time - 2000.0 / 600.0 - 90.0).abs() < 1e-6);
    fs::remove_dir_all(folder()).expect("the folder is there");
}
