//! The variants of lines through fields of every kind.

use raydsl::flow::{FlowState, FlowSteps, Streamline, Ways, streamlines, trace};
use raydsl::kernel::{Kernel, Variant};
use raydsl::prelude::*;
use raydsl::testing;
use raydsl::volume::cells::{CellKind, CellMesh, CellVectors};
use raydsl::volume::{GridConfig, VectorGrid};
use raydsl_tests::gpu::{gpu, keeps_denormals};
use raydsl_tests::rng::Rng;

use super::fields::{Field, velocity};
use super::settings;

/// Asserts that all variants on the CPU find the same lines, bit by bit, and so does WGSL where a device
/// has the bits of the other variants; otherwise its lines are within `bound` of the same at all times.
#[track_caller]
fn assert_lines_agree(
    kernel: &Kernel<'_, (FlowState,), FlowSteps>,
    seeds: &[Vec3],
    bound: f32,
) -> Vec<Streamline> {
    let of =
        |variant| streamlines(&TiledScheduler::new().variant(variant), kernel, seeds, Ways::Both);
    let expected = of(Variant::Scalar);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        if testing::can_run(variant, "flow") {
            assert_eq!(of(variant), expected, "{}", variant.name());
        }
    }
    if let Some(gpu) = gpu() {
        let found = streamlines(gpu, kernel, seeds, Ways::Both).expect("a device that runs it");
        if gpu.context().is_exact() {
            assert_eq!(found.len(), expected.len());
            if keeps_denormals(gpu) {
                assert_eq!(found, expected, "WGSL");
            }
            found.iter().zip(&expected).for_each(|(a, b)| assert_same(a, b));
        } else {
            assert_eq!(found.len(), expected.len());
            found.iter().zip(&expected).for_each(|(a, b)| assert_near(a, b, bound));
        }
    }
    expected
}

/// Asserts that two lines are the same but for what denormals may be, which some devices take for 0.
#[track_caller]
fn assert_same(line: &Streamline, other: &Streamline) {
    // A speed is up to 100 times a place.
    let is_same = |a: Vec3, b: Vec3| (a - b).abs().max_element() <= 1000.0 * f32::MIN_POSITIVE;
    assert_eq!((line.begin(), line.end()), (other.begin(), other.end()));
    assert_eq!((line.attempts(), line.points().len()), (other.attempts(), other.points().len()));
    for (p, q) in line.points().iter().zip(other.points()) {
        let is_same = p.time == q.time
            && p.length == q.length
            && is_same(p.at, q.at)
            && is_same(p.velocity, q.velocity)
            && is_same(p.bend, q.bend);
        assert!(is_same, "{p:?} {q:?}");
    }
}

/// Asserts that a line is within `bound` of another wherever both are, and is as long.
#[track_caller]
fn assert_near(line: &Streamline, other: &Streamline, bound: f32) {
    assert_eq!((line.begin(), line.end()), (other.begin(), other.end()));
    for p in line.points() {
        if let Some(q) = other.at(p.time) {
            assert!(p.at.distance(q.at) <= bound, "{p:?} {q:?}");
        }
    }
    for (p, q) in [line.points().first(), line.points().last()]
        .into_iter()
        .zip([other.points().first(), other.points().last()])
    {
        let length = [p, q].map(|end| end.map_or(0.0, |end| end.length));
        assert!((length[0] - length[1]).abs() <= bound * length[1].abs().max(1.0), "{p:?} {q:?}");
    }
}

fn seeds(count: usize, size: f32) -> Vec<Vec3> {
    let mut rng = Rng::of("seeds of lines");
    (0..count).map(|_| rng.point(size)).collect()
}

#[test]
fn closed_forms() {
    for field in Field::ALL {
        let (_, time, max_step) = field.case();
        let settings = settings(1e-4, max_step).max_time(time).expect("a time");
        let settings = settings.closing(0.01).expect("a distance").relative(1e-6).expect("a share");
        let number = field.number();
        let kernel = kernel!(|state: FlowState| {
            trace(|p: Vec3| Some(velocity(number, p)), state, settings)
        });
        let lines = assert_lines_agree(&kernel, &seeds(41, 2.0), 1e-2);
        assert!(lines.iter().any(|line| line.points().len() > 8), "{field:?}");
    }
}

/// Vectors at the corners of a grid, some of them missing.
#[test]
fn grids_of_vectors() {
    let mut rng = Rng::of("a grid of vectors");
    let size = uvec3(7, 6, 5);
    let mut vectors: Vec<Vec3> = (0..7 * 6 * 5).map(|_| rng.direction()).collect();
    vectors[100] = Vec3::NAN;
    let config = GridConfig::new().origin(vec3(-2.0, -1.5, -1.0)).spacing(vec3(0.6, 0.7, 0.5));
    let grid = VectorGrid::new(&vectors[..], size, config).expect("a grid");
    let settings = settings(1e-4, 0.5).max_length(20.0).expect("a length");
    let kernel = kernel!(|state: FlowState| trace(|p: Vec3| grid.value(p), state, settings));
    let lines = assert_lines_agree(&kernel, &seeds(60, 2.0), 1e-2);
    assert!(lines.iter().any(|line| line.points().len() > 20));
}

#[test]
fn cells() {
    let mut rng = Rng::of("vectors of cells");
    let points: Vec<Vec3> = (0..4 * 4 * 4)
        .map(|i| uvec3(i % 4, i / 4 % 4, i / 16).as_vec3() + rng.point(0.2) - 1.5)
        .collect();
    let vectors: Vec<Vec3> = points.iter().map(|p| vec3(-p.y, p.x, 0.3) + rng.point(0.2)).collect();
    let mut vertices = Vec::new();
    for i in 0..27u32 {
        let first = i % 3 + 4 * (i / 3 % 3) + 16 * (i / 9);
        vertices.extend([0, 1, 5, 4, 16, 17, 21, 20].map(|n| first + n));
    }
    let mesh = CellMesh::new(&points, &vertices, &[CellKind::Hexahedron; 27]).expect("a mesh");
    let wind = CellVectors::new(&mesh, &vectors).expect("a field");
    let settings = settings(1e-4, 0.5).max_length(10.0).expect("a length");
    let kernel = kernel!(|state: FlowState| trace(|p: Vec3| wind.value(p), state, settings));
    let lines = assert_lines_agree(&kernel, &seeds(60, 1.6), 1e-2);
    assert!(lines.iter().any(|line| line.points().len() > 20));
}
