//! Integrals along rays: closed forms, and every tetrahedron by itself in `f64`.

use raydsl::prelude::*;
use raydsl::volume::cells::{CellData, CellGrid, CellMesh, CellVolume};
use raydsl::volume::{ExactCell, TransferFunction, VolumeLight};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::meshes::{Fill, filled, rays};
use super::walks::in_box;
use super::{functions, homogeneous, oracle, with_grid};

/// Opacity of a homogeneous mesh is that of its length.
#[test]
fn constant_extinction_is_exponential() {
    let mut rng = Rng::of("constant");
    let size = uvec3(6, 5, 4);
    let cells = filled(size, Fill::Mixed, 0.12, &mut rng);
    with_grid(
        &cells,
        |p| p.x,
        |grid| {
            for sigma in [1e-6f32, 1e-3, 0.3, 2.0, 1e3] {
                let volume = CellVolume::new(grid, homogeneous(sigma));
                let exact = ExactCell::new().least(0.0);
                let mut worst = 0.0f64;
                for ray in rays(&cells, scaled(1500), &mut rng) {
                    let (length, is_along) = in_box(size.as_vec3(), ray);
                    if is_along || length < 0.1 {
                        continue;
                    }
                    let light = volume.integrate(&exact, ray, VolumeLight::new());
                    let expected = -(-f64::from(sigma) * length).exp_m1();
                    worst = worst.max((f64::from(light.opacity()) / expected - 1.0).abs());
                    let radiance = f64::from(light.radiance.x) / expected;
                    worst = worst.max((radiance - 1.0).abs());
                }
                println!("extinction {sigma}: opacity within {worst:.1e}");
                assert!(worst < 4e-5, "{sigma}: {worst}");
            }
        },
    );
}

/// Integrals by the march are those over all tetrahedra, sorted.
#[test]
fn integrals_are_those_of_the_oracle() {
    let mut rng = Rng::of("integrals");
    for (fill, is_of_cells) in [(Fill::Hexahedra, false), (Fill::Mixed, false), (Fill::Mixed, true)]
    {
        let cells = filled(uvec3(3, 4, 3), fill, 0.12, &mut rng);
        let mesh = CellMesh::new(&cells.points, &cells.vertices, &cells.kinds).expect("a mesh");
        let count = if is_of_cells { mesh.cells() } else { cells.points.len() };
        let values: Vec<f32> = (0..count).map(|_| rng.unit()).collect();
        let data = if is_of_cells { CellData::Cells(&values) } else { CellData::Points(&values) };
        let grid = CellGrid::new(&mesh, data).expect("a grid");
        for (i, transfer) in functions().into_iter().enumerate() {
            let volume = CellVolume::new(&grid, transfer);
            let exact = ExactCell::new().least(0.0);
            let mut worst = 0.0f64;
            let mut all = rays(&cells, 150, &mut rng);
            if is_of_cells {
                // Along an edge rounding says which cell's value a ray has.
                all = (0..80).map(|_| through(rng.point(1.5) + 1.5, rng.direction())).collect();
            }
            for ray in all.into_iter().filter(is_general) {
                // From where the grid takes the ray: a place that is off by an ulp before makes
                // more of a difference than the march.
                let ray = grid.line(ray).ray.with_range(0.0, f32::MAX);
                let expected = oracle::integrate(&grid, volume.transfer(), ray, 2000);
                let light = volume.integrate(&exact, ray, VolumeLight::new());
                let opacity = -(-expected.depth).exp_m1();
                assert!((0.0..=1.0).contains(&light.opacity()), "{light:?}");
                let off = (light.radiance.as_dvec3() - expected.radiance).abs().max_element();
                let off = off.max((f64::from(light.opacity()) - opacity).abs());
                // A narrow peak and an extinction of 1e7 make much of a value's last bit, where a
                // ray touches their values.
                let least = if i % 2 == 1 { 1.0 } else { 1e-3 };
                worst = worst.max(off / opacity.max(least));
            }
            println!("{fill:?}, of cells: {is_of_cells}, function {i}: within {worst:.1e}");
            assert!(worst < 1e-4, "{fill:?}, {i}: {worst}");
        }
    }
}

/// A value on a step of the function is behind it, as for the function itself.
#[test]
fn values_on_a_step() {
    let cells = filled(uvec3(1, 1, 2), Fill::Hexahedra, 0.0, &mut Rng::of("step"));
    let mesh = CellMesh::new(&cells.points, &cells.vertices, &cells.kinds).expect("a mesh");
    let values = vec![1.0f32; mesh.cells()];
    let grid = CellGrid::new(&mesh, CellData::Cells(&values)).expect("a grid");
    let step = [(1.0, 0.0), (1.0, 2.0)];
    let step = TransferFunction::from_extinction(&[(1.0, Vec3::ONE)], &step).expect("sorted");
    let volume = CellVolume::new(&grid, step);
    let ray = Ray::new(vec3(0.3, 0.6, -1.0), Vec3::Z);
    let light = volume.integrate(&ExactCell::new().least(0.0), ray, VolumeLight::new());
    assert!((light.depth - 4.0).abs() < 1e-5, "{light:?}");
}

/// A ray through a point.
fn through(p: Vec3, direction: Vec3) -> Ray {
    Ray::new(p - direction * 8.0, direction)
}

/// Along the axes rays pass through edges of cells, where rounding says which cell has them: with
/// values that jump there, no oracle knows.
fn is_general(ray: &Ray) -> bool {
    ray.direction.abs().min_element() > 1e-3 && ray.direction != Vec3::ONE
}

/// The first surface of a value is where the oracle first passes it.
#[test]
fn surfaces_are_where_values_cross() {
    let mut rng = Rng::of("surfaces");
    let cells = filled(uvec3(4, 4, 4), Fill::Mixed, 0.12, &mut rng);
    let middle = Vec3::splat(2.0);
    with_grid(
        &cells,
        |p| (p - middle).length(),
        |grid| {
            let mut hits = 0;
            for ray in rays(&cells, scaled(1000), &mut rng).into_iter().filter(is_general) {
                let parts = oracle::parts(grid, ray);
                let first = parts.iter().find(|p| (p.from > 1.3) != (p.to > 1.3));
                let expected =
                    first.map(|p| p.enter + (p.leave - p.enter) * (1.3 - p.from) / (p.to - p.from));
                match (grid.first_surface(ray, 1.3), expected) {
                    (Some(hit), Some(t)) => {
                        hits += 1;
                        let part = first.expect("a part");
                        let along = (part.to - part.from) / (part.leave - part.enter);
                        let slope = f64::from(hit.gradient.dot(ray.direction));
                        // Where a ray touches the surface, rounding moves the place far.
                        let steep = along.abs().max(1e-2);
                        assert!(
                            (f64::from(hit.t) - t).abs() < 1e-5 / steep,
                            "{ray:?}: {hit:?}, {t}"
                        );
                        let is_thin = part.leave - part.enter < 1e-3;
                        assert!((slope - along).abs() < 1e-3 || is_thin, "{slope}, {along}");
                    }
                    (None, None) => {}
                    (hit, t) => {
                        let nearest =
                            parts.iter().map(|p| (p.from - 1.3).abs()).fold(9.0, f64::min);
                        assert!(nearest < 1e-4, "{ray:?}: {hit:?}, {t:?}");
                    }
                }
            }
            assert!(hits > 100, "{hits}");
        },
    );
}
