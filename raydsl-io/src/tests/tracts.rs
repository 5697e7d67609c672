//! Tracts from TRK files.

use glam::{Affine3, Vec3, vec3};

use super::*;
use crate::tracts::{TractFile, load};

/// What a test writes.
#[derive(Clone)]
struct Trk {
    is_big: bool,
    dimensions: [i16; 3],
    spacing: [f32; 3],
    scalars: Vec<&'static str>,
    properties: Vec<&'static str>,
    /// By rows.
    matrix: [[f32; 4]; 4],
    order: &'static str,
    count: i32,
    version: i32,
    tracts: Vec<Vec<Vec3>>,
}

/// Three tracts, one of them without a point, with two numbers a point and one a tract.
fn small() -> Trk {
    let line = |n: i32| (0..n).map(|i| vec3(i as f32, 0.5 * (i * i) as f32, 2.0)).collect();
    Trk {
        is_big: false,
        dimensions: [10, 20, 30],
        spacing: [2.0, 1.0, 0.5],
        scalars: vec!["fa", "md"],
        properties: vec!["weight"],
        matrix: [
            [2.0, 0.0, 0.0, -9.0],
            [0.0, 1.0, 0.0, 5.0],
            [0.0, 0.0, 0.5, 7.0],
            [0.0, 0.0, 0.0, 1.0],
        ],
        order: "RAS",
        count: 3,
        version: 2,
        tracts: vec![line(5), line(0), line(2)],
    }
}

impl Trk {
    fn bytes(&self) -> Vec<u8> {
        let mut out = b"TRACK\0".to_vec();
        let order = |mut bytes: Vec<u8>| {
            if self.is_big {
                bytes.reverse();
            }
            bytes
        };
        let short = |v: i16| order(v.to_le_bytes().to_vec());
        let int = |v: i32| order(v.to_le_bytes().to_vec());
        let float = |v: f32| order(v.to_le_bytes().to_vec());
        let names = |names: &[&str]| {
            let mut room = [0u8; 200];
            for (i, name) in names.iter().take(10).enumerate() {
                room[20 * i..][..name.len()].copy_from_slice(name.as_bytes());
            }
            room
        };
        self.dimensions.iter().for_each(|v| out.extend(short(*v)));
        self.spacing.iter().for_each(|v| out.extend(float(*v)));
        out.extend([0; 12]);
        out.extend(short(self.scalars.len() as i16));
        out.extend(names(&self.scalars));
        out.extend(short(self.properties.len() as i16));
        out.extend(names(&self.properties));
        self.matrix.iter().flatten().for_each(|v| out.extend(float(*v)));
        out.resize(948, 0);
        out.extend(self.order.bytes());
        out.resize(988, 0);
        [self.count, self.version, 1000].iter().for_each(|v| out.extend(int(*v)));
        assert_eq!(out.len(), 1000);
        let mut number = 0.0;
        let mut next = || {
            number += 1.0;
            number
        };
        for tract in &self.tracts {
            out.extend(int(tract.len() as i32));
            for p in tract {
                p.to_array().iter().for_each(|v| out.extend(float(*v)));
                self.scalars.iter().for_each(|_| out.extend(float(next())));
            }
            self.properties.iter().for_each(|_| out.extend(float(next())));
        }
        out
    }

    fn load(&self) -> TractFile {
        load_bytes(&self.bytes()).expect("tracts")
    }
}

pub(super) fn files() -> Vec<Vec<u8>> {
    let big = Trk { is_big: true, ..small() };
    let unknown = Trk { count: 0, order: "", ..small() };
    [small(), big, unknown].iter().map(Trk::bytes).collect()
}

pub(super) fn load_bytes(bytes: &[u8]) -> Result<TractFile, LoadError> {
    load(&Temp::new("trk", bytes).0)
}

/// What is loaded is whole, or an error of one line.
pub(super) fn check_tracts(bytes: &[u8], case: &str) -> Option<TractFile> {
    match load_bytes(bytes) {
        Ok(file) => {
            let points: u64 = file.lengths.iter().map(|n| u64::from(*n)).sum();
            assert_eq!(points, file.points.len() as u64, "{case}");
            assert_eq!(file.scalars.len(), file.points.len() * file.scalar_names.len(), "{case}");
            assert_eq!(file.properties.len(), file.lengths.len() * file.property_names.len());
            assert!(file.points.iter().all(|p| p.is_finite()), "{case}");
            assert!(file.to_world.is_none_or(|map| map.is_finite()), "{case}");
            Some(file)
        }
        Err(e) => {
            let text = e.to_string();
            assert!(!text.contains('\n') && text.contains(';'), "{case}: {text}");
            None
        }
    }
}

fn error(bytes: &[u8]) -> String {
    load_bytes(bytes).expect_err("an error").to_string()
}

#[test]
fn tracts_in_both_byte_orders() {
    for is_big in [false, true] {
        let written = Trk { is_big, ..small() };
        for count in [3, 0] {
            let file = Trk { count, ..written.clone() }.load();
            assert_eq!(file.lengths, [5, 0, 2]);
            let tracts: Vec<&[Vec3]> = file.tracts().collect();
            assert_eq!(tracts, written.tracts);
            assert_eq!(file.scalar_names, ["fa", "md"]);
            assert_eq!(file.property_names, ["weight"]);
            // Numbers were counted as they were written.
            assert_eq!(file.scalars[..4], [1.0, 2.0, 3.0, 4.0]);
            assert_eq!(file.properties, [11.0, 12.0, 17.0]);
        }
    }
}

/// Points count from the corner of the first voxel, the matrix from its middle.
#[test]
fn places_are_those_of_the_scanner() {
    let map = |trk: Trk| trk.load().to_world.expect("a map");
    let close = |a: Vec3, b: Vec3| assert!(a.distance(b) < 1e-5, "{a}, not {b}");
    // Half a voxel of (2, 1, 0.5) is the middle of the first one.
    let middle = vec3(1.0, 0.5, 0.25);
    close(map(small()).transform_point3(middle), vec3(-9.0, 5.0, 7.0));
    let last = vec3(19.0, 19.5, 14.75);
    close(map(small()).transform_point3(last), vec3(-9.0 + 18.0, 5.0 + 19.0, 7.0 + 14.5));
    // The matrix is RAS, the points are LPS: the first one is the last one of two axes.
    for order in ["LPS", "", "lps"] {
        let map = map(Trk { order, ..small() });
        close(map.transform_point3(middle), vec3(-9.0 + 18.0, 5.0 + 19.0, 7.0));
        close(map.transform_vector3(vec3(2.0, 1.0, 0.5)), vec3(-2.0, -1.0, 0.5));
    }
    // Both run to the left.
    let mut left = small();
    left.matrix[0] = [-2.0, 0.0, 0.0, 9.0];
    left.order = "LAS";
    close(map(left).transform_point3(middle), vec3(9.0, 5.0, 7.0));
    // The points' first axis is the matrix' second one.
    let swapped =
        Trk { order: "ARS", dimensions: [20, 10, 30], spacing: [1.0, 2.0, 0.5], ..small() };
    close(map(swapped.clone()).transform_vector3(vec3(1.0, 0.0, 0.0)), vec3(0.0, 1.0, 0.0));
    close(map(swapped).transform_point3(vec3(0.5, 1.0, 0.25)), vec3(-9.0, 5.0, 7.0));
    // All three are in another order, which is not its own inverse, and the second one is turned.
    let cycle = Trk { order: "SLA", dimensions: [30, 10, 20], spacing: [0.5, 2.0, 1.0], ..small() };
    let map_of_cycle = map(cycle);
    close(map_of_cycle.transform_point3(vec3(0.25, 1.0, 0.5)), vec3(-9.0 + 18.0, 5.0, 7.0));
    for (along, to) in [
        (vec3(0.5, 0.0, 0.0), vec3(0.0, 0.0, 0.5)),
        (vec3(0.0, 2.0, 0.0), vec3(-2.0, 0.0, 0.0)),
        (vec3(0.0, 0.0, 1.0), vec3(0.0, 1.0, 0.0)),
    ] {
        close(map_of_cycle.transform_vector3(along), to);
    }
    // It may not be recorded.
    let mut without = small();
    without.matrix[3][3] = 0.0;
    assert_eq!(without.load().to_world, None);
    assert_eq!(Trk { version: 1, ..small() }.load().to_world, None);
}

#[test]
fn more_numbers_than_names() {
    let scalars = vec!["s"; 12];
    let file = Trk { scalars, ..small() }.load();
    assert_eq!(file.scalar_names.len(), 12);
    assert_eq!((&file.scalar_names[9][..], &file.scalar_names[11][..]), ("s", ""));
    // Of a name with numbers behind its end the name is kept.
    let mut bytes = small().bytes();
    bytes[38..43].copy_from_slice(b"ab\0\x33x");
    assert_eq!(load_bytes(&bytes).expect("tracts").scalar_names[0], "ab");
    let none = Trk { tracts: Vec::new(), count: 0, ..small() }.load();
    assert!(none.points.is_empty() && none.tracts().next().is_none());
}

#[test]
fn broken_files_are_named() {
    let whole = small().bytes();
    let with = |at: usize, bytes: &[u8]| {
        let mut all = whole.clone();
        all[at..at + bytes.len()].copy_from_slice(bytes);
        error(&all)
    };
    let f = |v: f32| v.to_le_bytes();
    assert!(with(0, b"TRUCK").contains("begin with 'TRACK'"));
    assert!(with(996, &999i32.to_le_bytes()).contains("not 1000"));
    assert!(with(992, &7i32.to_le_bytes()).contains("version is 7"));
    assert!(with(36, &(-1i16).to_le_bytes()).contains("-1 scalars"));
    assert!(with(238, &i16::MIN.to_le_bytes()).contains("properties"));
    assert!(with(988, &(-5i32).to_le_bytes()).contains("-5 tracts"));
    assert!(with(948, b"RAR").contains("order 'RAR'"));
    assert!(with(948, b"RA\0").contains("order 'RA'"));
    assert!(with(12, &f(0.0)).contains("size"));
    assert!(with(440, &f(f32::NAN)).contains("matrix"));
    assert!(with(440, &f(0.0)).contains("matrix"));
    // More than there are, and fewer.
    assert!(with(988, &4i32.to_le_bytes()).contains("tract 3 of 4"));
    assert!(with(988, &2i32.to_le_bytes()).contains("follow its last tract"));
    assert!(with(1000, &(-3i32).to_le_bytes()).contains("-3 points"));
    assert!(with(1000, &i32::MAX.to_le_bytes()).contains("tract 0 of 3"));
    assert!(with(1004, &f(f32::INFINITY)).contains("1 of 7 points"));
    // A scalar that is no number is one.
    let mut nan = whole.clone();
    nan[1016..1020].copy_from_slice(&f(f32::NAN));
    assert!(load_bytes(&nan).expect("tracts").scalars[0].is_nan());
    assert!(error(b"TRACK").contains("5 of 1000 bytes"));
    assert_modest();
}

#[test]
fn cut_and_damaged_tracts_never_panic() {
    for bytes in files() {
        let whole = load_bytes(&bytes).expect("tracts");
        for end in 0..bytes.len() {
            if let Some(part) = check_tracts(&bytes[..end], &format!("cut at {end}")) {
                // Without a count, a file may end behind each tract.
                assert!(part.lengths.len() < whole.lengths.len());
                assert_eq!(part.points[..], whole.points[..part.points.len()]);
            }
        }
        for at in 0..bytes.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                check_tracts(&damaged, &format!("byte {at}"));
            }
        }
    }
    assert_modest();
}

/// The fibres of the Fornix that DIPY has among its data.
#[test]
fn real_tracts_load() {
    let Some(path) = super::volumes::real("real_tracts_load", "tracks300.trk") else { return };
    let file = load(&path).expect("tracts");
    assert_eq!(file.lengths.len(), 300);
    assert_eq!(file.lengths.iter().map(|n| *n as usize).sum::<usize>(), file.points.len());
    assert!(file.lengths.iter().all(|n| (2..500).contains(n)));
    // Voxels of a millimetre, in the order of the matrix, which is the identity.
    let half = Affine3::from_translation(Vec3::splat(-0.5));
    assert_eq!(file.to_world, Some(half));
    let far = file.tracts().flat_map(|t| t.windows(2)).map(|p| p[0].distance(p[1]));
    assert!(far.fold(0.0, f32::max) < 2.0, "neighbours are near");
}
