//! Walks from cell to cell: nothing leaks through shared faces, edges and vertices.

use glam::DVec3;
use raydsl::prelude::*;
use raydsl::volume::cells::{CellGrid, CellKind, CellMesh};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::meshes::{Cells, Fill, filled, rays};
use super::{oracle, with_grid};

/// What a walk finds along a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Walked {
    length: f64,
    entries: usize,
    cells: usize,
    /// Gaps between cells that follow one another.
    gaps: usize,
    /// Cells whose ends are in the other order.
    folded: usize,
}

fn walk(grid: &CellGrid<'_>, ray: Ray) -> Walked {
    let line = grid.line(ray);
    let mut found = Walked::default();
    for hit in grid.entries().hits(line.ray) {
        let mut walk = grid.enter(line, hit.prim_id);
        let mut end = walk.enter();
        found.entries += 1;
        while walk.is_inside {
            found.cells += 1;
            found.gaps += usize::from(walk.enter() != end);
            found.folded += usize::from(walk.leave() < walk.enter());
            end = walk.leave();
            let part = walk.part(line.first, line.last);
            found.length += f64::from((part.leave - part.enter).max(0.0) * line.scale);
            walk.advance(grid, line);
        }
    }
    found
}

/// The length of a ray in the box from 0 to `size`, and whether it runs along its surface.
pub(crate) fn in_box(size: Vec3, ray: Ray) -> (f64, bool) {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (mut enter, mut leave, mut is_along) = (f64::NEG_INFINITY, f64::INFINITY, false);
    for a in 0..3 {
        let (p, q) = ((0.0 - o[a]) / d[a], (f64::from(size[a]) - o[a]) / d[a]);
        if d[a] == 0.0 {
            is_along |= o[a] == 0.0 || o[a] == f64::from(size[a]);
            if o[a] < 0.0 || o[a] > f64::from(size[a]) {
                return (0.0, is_along);
            }
        } else {
            enter = enter.max(p.min(q));
            leave = leave.min(p.max(q));
        }
    }
    ((leave - enter).max(0.0) * d.length(), is_along)
}

/// Every ray's length in cells is that in the box, in one walk without a gap.
#[test]
fn no_ray_leaks() {
    let mut rng = Rng::of("leaks");
    for (fill, jitter) in
        [(Fill::Hexahedra, 0.0), (Fill::Hexahedra, 0.12), (Fill::Mixed, 0.0), (Fill::Mixed, 0.12)]
    {
        let size = uvec3(6, 5, 7);
        let cells = filled(size, fill, jitter, &mut rng);
        with_grid(
            &cells,
            |_| 0.0,
            |grid| {
                let (mut worst, mut passed) = (0.0f64, 0);
                for ray in rays(&cells, scaled(40_000), &mut rng) {
                    let found = walk(grid, ray);
                    let (expected, is_along) = in_box(size.as_vec3(), ray);
                    assert_eq!(found.gaps, 0, "{fill:?}, {ray:?}: {found:?}");
                    if is_along {
                        continue;
                    }
                    passed += 1;
                    // Where a ray grazes a side, its length grows by more than its place is off.
                    let d = ray.direction.abs().to_array().into_iter().filter(|d| *d > 0.0);
                    let graze = f64::from(d.fold(1.0, f32::min));
                    let off = (found.length - expected).abs() * graze;
                    worst = worst.max(off);
                    assert!(off < 4e-6, "{fill:?}, {ray:?}: {found:?}, not {expected}");
                    let is_beside = expected * graze < 4e-6;
                    assert!(found.entries == 1 || is_beside, "{fill:?}, {ray:?}: {found:?}");
                }
                println!("{fill:?}, jitter {jitter}: {passed} rays, lengths within {worst:.1e}");
            },
        );
    }
}

/// Volumes of the tetrahedra add up to the box: every kind is divided as it is joined.
#[test]
fn tetrahedra_fill_the_box() {
    let mut rng = Rng::of("volumes");
    for fill in [Fill::Hexahedra, Fill::Mixed] {
        let size = uvec3(5, 4, 3);
        let cells = filled(size, fill, 0.1, &mut rng);
        let mesh = CellMesh::new(&cells.points, &cells.vertices, &cells.kinds).expect("a mesh");
        let of = |t: [u32; 4]| {
            let [a, b, c, d] = t.map(|i| cells.points[i as usize].as_dvec3());
            DVec3::dot((b - a).cross(c - a), d - a) / 6.0
        };
        let volumes: Vec<f64> =
            mesh.tetrahedra().iter().map(|t| of(t.vertices.to_array())).collect();
        assert!(volumes.iter().all(|v| *v > 0.0), "all are oriented alike");
        assert!((volumes.iter().sum::<f64>() - 60.0).abs() < 1e-5);
        let outer: usize = 4 * (5 * 4 + 4 * 3 + 3 * 5);
        assert_eq!(mesh.faces().len(), outer);
        if fill == Fill::Mixed {
            use CellKind::{Hexahedron, Pyramid, Tetrahedron, Wedge};
            for kind in [Tetrahedron, Pyramid, Wedge, Hexahedron] {
                assert!(cells.kinds.contains(&kind), "{kind:?}");
            }
        }
    }
}

/// One cell of any size, seen from anywhere.
#[test]
fn one_cell_has_its_chord() {
    let mut rng = Rng::of("one");
    for exponent in [-12, -6, 0, 6, 11] {
        let size = 10f32.powi(exponent);
        for _ in 0..scaled(400) {
            let mut cells = Cells::default();
            let p = [0, 1, 2, 3].map(|_| rng.point(1.0));
            // Of a sliver rays beside it miss what a ray along its edge may pass.
            if (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]).abs() < 0.5 {
                continue;
            }
            cells.points.extend(p.map(|p| p * size));
            cells.push(CellKind::Tetrahedron, &[0, 1, 2, 3]);
            with_grid(
                &cells,
                |_| 0.0,
                |grid| {
                    for ray in rays(&cells, 12, &mut rng) {
                        let ray = Ray::new(ray.origin, ray.direction * rng.range(0.1, 10.0));
                        let found = f64::from(grid.length_inside(ray));
                        // Rays beside it, as far as rounding may move it: one along an edge may be in
                        // the cell or not.
                        let far = ray.origin.length() + size;
                        let (u, v) = ray.direction.normalize().any_orthonormal_pair();
                        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
                        for (side, share) in
                            (0..48).flat_map(|i| [0.0, 0.1, 0.5, 1.0].map(|s| (i, s)))
                        {
                            let (sin, cos) =
                                (side as f32 * core::f32::consts::TAU / 48.0).sin_cos();
                            let by = u * cos + v * sin;
                            let by = by.as_dvec3() * f64::from(far) * 6e-7 * share;
                            let chord = chord(grid, ray, by);
                            (least, most) = (least.min(chord), most.max(chord));
                        }
                        let off = (least - found).max(found - most) / f64::from(far);
                        assert!(off < 4e-6, "{size:e}: {found:e}, not {least:e} to {most:e}");
                    }
                },
            );
        }
    }
}

/// Returns the length in the cells of a ray that is moved.
fn chord(grid: &CellGrid<'_>, ray: Ray, by: DVec3) -> f64 {
    let parts = oracle::parts_of(grid, ray.origin.as_dvec3() + by, ray);
    parts.iter().map(|p| (p.leave - p.enter) * ray.direction.as_dvec3().length()).sum()
}

/// Parts of a ray add up, from inside too.
#[test]
fn parts_add_up() {
    let mut rng = Rng::of("parts");
    let cells = filled(uvec3(4, 4, 4), Fill::Mixed, 0.1, &mut rng);
    with_grid(
        &cells,
        |_| 0.0,
        |grid| {
            for ray in rays(&cells, scaled(2000), &mut rng) {
                let whole = grid.length_inside(ray);
                let at = ray.origin.length() * rng.range(0.8, 1.2);
                let halves = [ray.with_range(0.0, at), ray.with_range(at, f32::MAX)];
                let sum: f32 = halves.iter().map(|r| grid.length_inside(*r)).sum();
                assert!(
                    (sum - whole).abs() < 2e-6 * ray.origin.length(),
                    "{ray:?}: {sum}, {whole}"
                );
            }
        },
    );
}

/// A linear field is itself, at points and along rays, whatever the cells.
#[test]
fn linear_fields_are_reproduced() {
    let mut rng = Rng::of("linear");
    for fill in [Fill::Hexahedra, Fill::Mixed] {
        let size = uvec3(5, 4, 6);
        let cells = filled(size, fill, 0.12, &mut rng);
        let (slope, rest) = (vec3(0.7, -1.3, 0.4), 2.5);
        let field = |p: Vec3| slope.dot(p) + rest;
        let exact = |p: DVec3| slope.as_dvec3().dot(p) + rest as f64;
        with_grid(&cells, field, |grid| {
            let mut worst = 0.0f64;
            for _ in 0..scaled(4000) {
                let p = (rng.point(0.5) + 0.5) * size.as_vec3();
                let found = grid.value(p).expect("a point inside");
                worst = worst.max((f64::from(found) - exact(p.as_dvec3())).abs());
            }
            for ray in rays(&cells, scaled(4000), &mut rng) {
                let line = grid.line(ray);
                for hit in grid.entries().hits(line.ray) {
                    let mut walk = grid.enter(line, hit.prim_id);
                    while walk.is_inside {
                        let part = walk.part(-f32::MAX, f32::MAX);
                        let at = line.ray.origin.as_dvec3()
                            + line.ray.direction.as_dvec3() * f64::from(part.leave);
                        worst = worst.max((f64::from(part.to) - exact(at)).abs());
                        walk.advance(grid, line);
                    }
                }
            }
            println!("{fill:?}: values within {worst:.1e}");
            assert!(worst < 1e-5, "{fill:?}: {worst}");
            assert_eq!(grid.value(vec3(-0.1, 1.0, 1.0)), None);
            assert_eq!(grid.value(vec3(1.0, 1.0, 6.1)), None);
        });
    }
}
