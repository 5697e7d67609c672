//! Values of grids.

use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl::volume::{Centering, Grid, GridConfig, Voxel};
use raydsl_tests::rng::Rng;

/// A grid in `f64`.
struct Oracle {
    numbers: Vec<f64>,
    size: [usize; 3],
    to_voxels: glam::DAffine3,
    scale: f64,
    offset: f64,
}

impl Oracle {
    fn new<T: Voxel>(voxels: &[T], size: UVec3, config: &GridConfig) -> Self {
        let Affine3 { matrix3, translation } = config.to_world;
        let columns = [matrix3.x_axis, matrix3.y_axis, matrix3.z_axis].map(|c| c.as_dvec3());
        let to_world = glam::DAffine3::from_mat3_translation(
            glam::DMat3::from_cols(columns[0], columns[1], columns[2]),
            translation.as_dvec3(),
        );
        Self {
            numbers: voxels.iter().map(|v| f64::from(v.number())).collect(),
            size: size.to_array().map(|n| n as usize),
            to_voxels: to_world.inverse(),
            scale: f64::from(config.scale),
            offset: f64::from(config.offset),
        }
    }

    fn voxel(&self, at: [i64; 3]) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|a| at[a].clamp(0, self.size[a] as i64 - 1) as usize);
        self.numbers[(z * self.size[1] + y) * self.size[0] + x]
    }

    fn place(&self, p: Vec3) -> glam::DVec3 {
        self.to_voxels.transform_point3(p.as_dvec3())
    }

    /// The sum of voxels with separable weights of `taps` voxels from `first` on.
    fn weighted<const N: usize>(&self, first: [i64; 3], weights: [[f64; N]; 3]) -> f64 {
        let mut sum = 0.0;
        for k in 0..N {
            for j in 0..N {
                for i in 0..N {
                    let at = [first[0] + i as i64, first[1] + j as i64, first[2] + k as i64];
                    sum += self.voxel(at) * weights[0][i] * weights[1][j] * weights[2][k];
                }
            }
        }
        sum
    }

    /// Cell and share along an axis.
    fn split(&self, axis: usize, x: f64) -> (i64, f64) {
        let last = self.size[axis] as f64 - 1.0;
        let x = x.clamp(0.0, last);
        let cell = x.floor().min((last - 1.0).max(0.0));
        (cell as i64, x - cell)
    }

    fn value(&self, p: Vec3) -> f64 {
        let q = self.place(p).to_array();
        let parts = [0, 1, 2].map(|a| self.split(a, q[a]));
        let sum = self.weighted(parts.map(|p| p.0), parts.map(|p| [1.0 - p.1, p.1]));
        sum * self.scale + self.offset
    }

    fn gradient(&self, p: Vec3) -> glam::DVec3 {
        let q = self.place(p).to_array();
        let parts = [0, 1, 2].map(|a| self.split(a, q[a]));
        let slopes = [0, 1, 2].map(|axis| {
            let mut weights = parts.map(|p| [1.0 - p.1, p.1]);
            weights[axis] = [-1.0, 1.0];
            self.weighted(parts.map(|p| p.0), weights)
        });
        self.to_voxels.matrix3.transpose() * glam::DVec3::from(slopes) * self.scale
    }

    fn b_spline(&self, p: Vec3, config: &GridConfig) -> f64 {
        let half = if config.centering == Centering::Cell { 0.5 } else { 0.0 };
        let q = self.place(p).to_array();
        let parts = [0, 1, 2].map(|a| {
            let x = q[a].clamp(-half, self.size[a] as f64 - 1.0 + half);
            (x.floor() as i64 - 1, x - x.floor())
        });
        let weights = parts.map(|(_, x)| {
            let cube = |x: f64| x * x * x;
            let around = |x: f64| {
                if x >= 2.0 {
                    0.0
                } else if x >= 1.0 {
                    cube(2.0 - x) / 6.0
                } else {
                    2.0 / 3.0 - x * x + cube(x) / 2.0
                }
            };
            [around(1.0 + x), around(x), around(1.0 - x), around(2.0 - x)]
        });
        self.weighted(parts.map(|p| p.0), weights) * self.scale + self.offset
    }
}

fn placements() -> [GridConfig; 3] {
    let turned = Affine3 {
        matrix3: Mat3::from_cols(vec3(0.6, 0.8, 0.0), vec3(-0.4, 0.3, 0.1), vec3(0.0, 0.1, 2.0)),
        translation: vec3(3.0, -2.0, 5.0),
    };
    [
        GridConfig::new(),
        GridConfig::new().spacing(vec3(0.5, 1.0, 2.5)).centering(Centering::Cell),
        GridConfig::new().to_world(turned).rescale(-0.25, 7.0),
    ]
}

fn points(rng: &mut Rng, size: UVec3, config: &GridConfig) -> Vec<(Vec3,)> {
    let point = |_| {
        let mut at = size.as_vec3() * (rng.point(0.7) + 0.5);
        if rng.below(4) == 0 {
            at = at.round();
        }
        (config.to_world.transform_point3(at),)
    };
    (0..300).map(point).collect()
}

fn check<T: Voxel>(name: &str, make: impl Fn(&mut Rng) -> T)
where
    [T]: ToOwned<Owned = Vec<T>>,
{
    let mut rng = Rng::of(name);
    for config in placements() {
        for size in [uvec3(5, 4, 3), uvec3(1, 1, 1), uvec3(2, 1, 9), uvec3(11, 17, 2)] {
            let count = (size.x * size.y * size.z) as usize;
            let voxels: Vec<T> = (0..count).map(|_| make(&mut rng)).collect();
            let oracle = Oracle::new(&voxels, size, &config);
            let grid = Grid::new(&voxels[..], size, config).expect("a grid");
            let inputs = points(&mut rng, size, &config);
            let most = voxels.iter().map(|v| f64::from(v.number().abs())).fold(0.0, f64::max);
            let most = most * oracle.scale.abs() + oracle.offset.abs();
            // Places are off by some ulps of coordinates of up to 50, and values with them.
            let bound = most * 3e-5;
            for &(p,) in &inputs {
                let off = (f64::from(grid.value(p)) - oracle.value(p)).abs();
                assert!(off <= bound, "{name} {size}: value at {p} off by {off}");
                let spline = f64::from(grid.b_spline(p));
                let off = (spline - oracle.b_spline(p, &config)).abs();
                assert!(off <= bound, "{name} {size}: B-spline at {p} off by {off}");
                let q = oracle.place(p);
                let near_plane = (q - q.round()).abs().min_element() < 1e-4;
                if !near_plane {
                    let off = (grid.gradient(p).as_dvec3() - oracle.gradient(p)).length();
                    assert!(off <= 20.0 * bound, "{name} {size}: gradient at {p} off by {off}");
                    let nearest = q.clamp(glam::DVec3::ZERO, glam::DVec3::splat(1e9)).to_array();
                    let nearest = oracle.voxel(nearest.map(|x| (x + 0.5).floor() as i64));
                    let expected = nearest * oracle.scale + oracle.offset;
                    let is_half = (q - q.floor() - 0.5).abs().min_element() < 1e-4;
                    let off = (f64::from(grid.nearest(p)) - expected).abs();
                    assert!(is_half || off <= bound, "{name} {size}: nearest at {p} off by {off}");
                }
            }
            let all = kernel!(|p: Vec3| {
                (grid.value(p), grid.nearest(p), grid.b_spline(p), grid.gradient(p))
            });
            assert_variants_agree!(&all, &inputs);
        }
    }
}

#[test]
fn values_are_those_of_the_interpolant() {
    check("u8", |rng| rng.below(256) as u8);
    check("u16", |rng| rng.below(65536) as u16);
    check("i16", |rng| rng.below(65536) as u16 as i16);
    check("f16", |rng| F16::new(rng.range(-100.0, 100.0)));
    check("f32", |rng| rng.range(-1.0, 1.0));
}

#[test]
fn constant_grids_are_constant() {
    let voxels = [77u16; 60];
    for config in placements() {
        let grid = Grid::new(&voxels[..], uvec3(5, 4, 3), config).expect("a grid");
        let expected = 77.0 * config.scale + config.offset;
        for (p,) in points(&mut Rng::of("constant"), grid.size(), &config) {
            assert_eq!(grid.value(p), expected);
            assert_eq!(grid.b_spline(p), expected);
            assert_eq!(grid.gradient(p), Vec3::ZERO);
        }
    }
}

#[test]
fn missing_voxels_empty_their_cells() {
    let mut voxels = [1.0f32; 27];
    voxels[13] = f32::NAN;
    voxels[26] = f32::INFINITY;
    let grid = Grid::new(&voxels[..], uvec3(3, 3, 3), GridConfig::new()).expect("a grid");
    let inputs: Vec<(Vec3,)> = points(&mut Rng::of("gaps"), grid.size(), grid.config());
    for &(p,) in &inputs {
        assert!(!grid.has_value(p), "every cell has the middle voxel: {p}");
        assert_eq!(grid.value(p), 0.0);
    }
    let kernel =
        kernel!(|p: Vec3| (grid.value(p), grid.nearest(p), grid.b_spline(p), grid.has_value(p)));
    assert_variants_agree!(&kernel, &inputs);

    let mut voxels = [1.0f32; 27];
    voxels[26] = f32::INFINITY;
    let grid = Grid::new(&voxels[..], uvec3(3, 3, 3), GridConfig::new()).expect("a grid");
    assert!(!grid.has_value(vec3(1.5, 1.5, 1.5)));
    assert!(grid.has_value(vec3(0.5, 1.5, 1.5)));
    assert_eq!(grid.value(vec3(0.5, 1.5, 1.5)), 1.0);

    let marked = Grid::without(&[3u8, 0, 3, 3, 3, 3, 3, 3], 0, uvec3(2, 2, 2), GridConfig::new());
    let marked = marked.expect("a grid");
    assert!(!marked.has_value(vec3(0.5, 0.5, 0.5)));
    assert_eq!(marked.nearest(vec3(0.1, 0.9, 0.1)), 3.0);
}

#[test]
fn spans_are_those_of_the_domain() {
    let voxels = [0u8; 8];
    let ray = Ray::new(vec3(0.25, 0.5, -10.0), vec3(0.0, 0.0, 2.0));
    let span = |config| Grid::new(&voxels[..], uvec3(2, 2, 2), config).expect("a grid").span(ray);
    assert_eq!(span(GridConfig::new()), (5.0, 5.5));
    assert_eq!(span(GridConfig::new().centering(Centering::Cell)), (4.75, 5.75));
    let (enter, leave) = span(GridConfig::new().origin(vec3(9.0, 0.0, 0.0)));
    assert!(enter > leave);
}
