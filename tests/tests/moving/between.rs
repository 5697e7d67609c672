//! Grids between two steps in time, against grids of blended voxels.

use proptest::prelude::*;
use raydsl::assert_variants_agree;
use raydsl::prelude::*;
use raydsl::volume::{
    Adaptive, Centering, ExactCell, Grid, GridConfig, Labels, Midpoint, PreIntegrated, ShadedCell,
    TransferFunction, TransferFunction2d, Volume, Volume2d, VolumeIntegrator, VolumeLight, Voxel,
};
use raydsl_tests::close::assert_close;
use raydsl_tests::rng::Rng;

/// Shares on both sides of the middle, from which on the steps change places.
const SHARES: [f32; 5] = [0.0, 0.2, 0.5, 0.83, 1.0];

/// The grid of blended voxels.
fn copied<T: Voxel>(
    before: &[T],
    after: &[T],
    share: f32,
    size: UVec3,
    config: GridConfig,
) -> Grid<'static, f32> {
    let blend = |(a, b): (&T, &T)| {
        let (a, b) = (f64::from(a.number()), f64::from(b.number()));
        (a + (b - a) * f64::from(share)) as f32
    };
    let voxels: Vec<f32> = before.iter().zip(after).map(blend).collect();
    Grid::new(voxels, size, config).expect("a small grid")
}

fn made<T>(size: UVec3, mut make: impl FnMut() -> T) -> [Vec<T>; 2] {
    [(); 2].map(|()| (0..size.element_product()).map(|_| make()).collect())
}

fn fields<T: Voxel>(name: &str, make: impl Fn(&mut Rng) -> T)
where
    [T]: ToOwned<Owned = Vec<T>>,
{
    let mut rng = Rng::of(name);
    let config = GridConfig::new().spacing(vec3(0.5, 1.0, 2.5)).centering(Centering::Cell);
    let config = config.rescale(-0.25, 7.0);
    for size in [uvec3(5, 4, 3), uvec3(1, 1, 1), uvec3(11, 17, 2)] {
        let [a, b] = made(size, || make(&mut rng));
        let most = a.iter().chain(&b).map(|v| v.number().abs()).fold(0.0, f32::max) * 0.25 + 7.0;
        let [before, after] =
            [&a, &b].map(|v| Grid::new(&v[..], size, config).expect("a small grid"));
        let place =
            |_| (config.to_world.transform_point3(size.as_vec3() * (rng.point(0.7) + 0.5)),);
        let inputs: Vec<(Vec3,)> = (0..100).map(place).collect();
        for share in SHARES {
            let now = Grid::between(&before, &after, share).expect("steps that match");
            let copy = copied(&a, &b, share, size, config);
            for &(p,) in &inputs {
                let off = [
                    now.value(p) - copy.value(p),
                    now.nearest(p) - copy.nearest(p),
                    now.b_spline(p) - copy.b_spline(p),
                    (now.gradient(p) - copy.gradient(p)).length() * 0.1,
                ];
                let off = off.map(f32::abs).into_iter().fold(0.0, f32::max);
                assert!(off <= most * 4e-6, "{name} {size}: off by {off} at {p}, share {share}");
            }
            let all = kernel!(|p: Vec3| {
                (now.value(p), now.nearest(p), now.b_spline(p), now.gradient(p))
            });
            assert_variants_agree!(&all, &inputs);
        }
        for (share, step) in [(0.0, &before), (1.0, &after)] {
            let now = Grid::between(&before, &after, share).expect("steps that match");
            for &(p,) in &inputs {
                let bits = |grid: &Grid<'_, T>| {
                    (grid.value(p).to_bits(), grid.gradient(p).to_array().map(f32::to_bits))
                };
                assert_eq!(bits(&now), bits(step), "{name} {size}: {p}, share {share}");
            }
        }
    }
}

#[test]
fn values_are_those_of_blended_voxels() {
    fields("u8", |rng| rng.below(256) as u8);
    fields("i16", |rng| rng.below(65536) as u16 as i16);
    fields("f16", |rng| F16::new(rng.range(-100.0, 100.0)));
    fields("f32", |rng| rng.range(-1.0, 1.0));
}

fn rays(rng: &mut Rng, size: UVec3, count: usize) -> Vec<(Ray,)> {
    let ray = |_| {
        let direction = rng.direction();
        (Ray::new(size.as_vec3() * (rng.point(0.5) + 0.5) - direction * 40.0, direction),)
    };
    (0..count).map(ray).collect()
}

/// A function with a soft ramp, a narrow peak and a step.
fn function(scale: f32) -> TransferFunction {
    let colors =
        [(0.0, vec3(0.1, 0.0, 0.8)), (0.4, vec3(1.0, 0.5, 0.1)), (1.0, vec3(0.3, 0.9, 0.2))];
    let knots = [(0.2, 0.0), (0.5, 0.3), (0.505, 40.0), (0.51, 0.3), (0.8, 0.5), (0.8, 2.0)];
    let colors = colors.map(|(value, color)| (value * scale, color));
    let knots = knots.map(|(value, extinction)| (value * scale, extinction));
    TransferFunction::from_extinction(&colors, &knots).expect("a function")
}

fn integrals<T: Voxel>(name: &str, scale: f32, make: impl Fn(&mut Rng) -> T)
where
    [T]: ToOwned<Owned = Vec<T>>,
{
    let (mut rng, size) = (Rng::of(name), uvec3(9, 7, 8));
    let [a, b] = made(size, || make(&mut rng));
    let grid = |v| Grid::new(v, size, GridConfig::new()).expect("a small grid");
    let (before, after) = (grid(&a[..]), grid(&b[..]));
    let inputs = rays(&mut rng, size, 100);
    for share in SHARES {
        let now = Grid::between(&before, &after, share).expect("steps that match");
        let copy = copied(&a, &b, share, size, GridConfig::new());
        let (now, copy) = (Volume::new(&now, function(scale)), Volume::new(&copy, function(scale)));
        let exact = ExactCell::new().least(0.0);
        for &(ray,) in &inputs {
            let none = VolumeLight::new();
            let (found, expected) =
                (now.integrate(&exact, ray, none), copy.integrate(&exact, ray, none));
            let off = (found.rgba() - expected.rgba()).abs().max_element();
            assert!(off < 3e-5, "{name}: {ray:?}, share {share}: off by {off}");
        }
        let kernel = kernel!(|ray: Ray| now.integrate(&exact, ray, VolumeLight::new()).rgba());
        assert_close(&kernel, &inputs, 2e-4);
    }
}

#[test]
fn integrals_are_those_of_blended_voxels() {
    integrals("integrals u8", 255.0, |rng| rng.below(256) as u8);
    integrals("integrals f16", 1.0, |rng| F16::new(rng.unit()));
}

/// Surfaces, the greatest value and the mean along rays.
#[test]
fn what_is_along_a_ray_is_that_of_blended_voxels() {
    let (mut rng, size) = (Rng::of("along"), uvec3(9, 7, 12));
    let [a, b] = made(size, || rng.unit());
    let grid = |v| Grid::new(v, size, GridConfig::new()).expect("a small grid");
    let (before, after) = (grid(&a[..]), grid(&b[..]));
    for share in SHARES {
        let now = Grid::between(&before, &after, share).expect("steps that match");
        let copy = copied(&a, &b, share, size, GridConfig::new());
        let mut surfaces = 0;
        for (ray,) in rays(&mut rng, size, 100) {
            assert!((now.greatest(ray) - copy.greatest(ray)).abs() < 1e-5, "{ray:?}");
            assert!((now.mean(ray) - copy.mean(ray)).abs() < 1e-5, "{ray:?}");
            match (now.first_surface(ray, 0.55), copy.first_surface(ray, 0.55)) {
                (Some(a), Some(b)) => surfaces += u32::from((a.t - b.t).abs() < 1e-2),
                (a, b) => assert!(a.is_none() && b.is_none(), "{ray:?}: {a:?} and {b:?}"),
            }
        }
        assert!(surfaces > 50, "{surfaces}");
    }
}

/// A voxel that either step lacks.
#[test]
fn missing_voxels_of_either_step_are_missing() {
    let with = |first| {
        let mut voxels = [1.0f32; 36];
        voxels[0] = first;
        voxels
    };
    let [nan, infinite] = [f32::NAN, f32::INFINITY].map(with);
    let whole = [3.0f32; 36];
    let grid = |v| Grid::new(v, uvec3(3, 3, 4), GridConfig::new()).expect("a small grid");
    let [gaps, far, whole] = [&nan, &infinite, &whole].map(|v| grid(&v[..]));
    for share in SHARES {
        for (a, b) in [(&gaps, &whole), (&whole, &gaps), (&far, &whole), (&whole, &far)] {
            let now = Grid::between(a, b, share).expect("steps that match");
            assert!(!now.has_value(vec3(0.5, 0.5, 0.5)) && now.has_value(vec3(1.5, 0.5, 0.5)));
            assert_eq!((now.value(vec3(0.2, 0.5, 0.5)), now.nearest(Vec3::ZERO)), (0.0, 0.0));
            assert!(now.value(vec3(0.2, 0.5, 1.5)) >= 1.0);
        }
    }
}

/// What other integrators see is blended too: voxels of labels, and the length of the gradient.
#[test]
fn variants_agree_in_every_integrator() {
    let (mut rng, size) = (Rng::of("others"), uvec3(6, 7, 5));
    let [a, b] = made(size, || rng.unit());
    let grid = |v| Grid::new(v, size, GridConfig::new()).expect("a small grid");
    let (before, after) = (grid(&a[..]), grid(&b[..]));
    let now = Grid::between(&before, &after, 0.7).expect("steps that match");
    let inputs = rays(&mut rng, size, 60);
    let volume = Volume::new(&now, function(1.0));
    let copy = copied(&a, &b, 0.7, size, GridConfig::new());
    let of_copy = Volume::new(&copy, function(1.0));
    macro_rules! check {
        ($integrator:expr, $bound:expr) => {
            let integrator = $integrator;
            for &(ray,) in &inputs {
                let [found, expected] = [&volume, &of_copy]
                    .map(|v| integrator.integrate(v, ray, VolumeLight::new()).rgba());
                let off = (found - expected).abs().max_element();
                assert!(off <= $bound, "{ray:?}: {found}, not {expected}");
            }
            let kernel =
                kernel!(|ray: Ray| volume.integrate(&integrator, ray, VolumeLight::new()).rgba());
            assert_close(&kernel, &inputs, $bound);
        };
    }
    check!(ExactCell::new(), 1e-4);
    check!(ShadedCell::new(vec3(0.6, 0.0, 0.8), 0.5), 1e-3);
    check!(PreIntegrated::new(0.3), 1e-3);
    check!(Adaptive::new(1e-3), 2e-3);
    check!(Labels::new(0.4), 1e-3);
    // A sample that rounding moves across a step differs by the step.
    check!(Midpoint::new(0.3), 2e-2);

    let (clear, thick) = ((Vec3::ONE, 0.0), (vec3(1.0, 0.5, 0.2), 0.6));
    let ends = (vec2(0.0, 1.0), vec2(0.0, 2.0));
    let borders =
        TransferFunction2d::new(&[clear, clear, thick, thick], uvec2(2, 2), ends.0, ends.1, 1.0);
    let borders = Volume2d::new(&now, borders.expect("a function"));
    let rule = Midpoint::new(0.3);
    let kernel = kernel!(|ray: Ray| borders.integrate(rule, ray, VolumeLight::new()).rgba());
    assert_close(&kernel, &inputs, 2e-3);
}

/// A grid of one step has neither a second fetch nor a share in its text.
#[test]
fn a_grid_of_one_step_is_as_it_was() {
    let voxels = [3u8; 8];
    let grid = Grid::new(&voxels[..], uvec3(2, 2, 2), GridConfig::new()).expect("a small grid");
    let now = Grid::between(&grid, &grid, 0.3).expect("steps that match");
    let text = |grid: &Grid<'_, u8>| kernel!(|p: Vec3| grid.value(p)).wgsl();
    let (plain, blended) = (text(&grid), text(&now));
    assert!(!plain.contains("share") && !plain.contains("other"), "{plain}");
    assert!(blended.contains("share"), "{blended}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    /// No extinction of a macro-cell exceeds its majorant, so what is skipped is empty.
    #[test]
    fn majorants_bound_extinction(
        seed: u64, share in 0.0f32..=1.0, offset in -1000.0f32..1000.0, is_sparse: bool,
    ) {
        let (mut rng, size) = (Rng::new(seed), uvec3(13, 11, 18));
        let config = GridConfig::new().rescale(3.0, offset);
        // Whole macro-cells of one value, which have ranges without slack.
        let [first, second] = made(size, || {
            if is_sparse && rng.below(200) > 0 { 2.0f32 } else { rng.range(-5.0, 5.0) }
        });
        let grid = |v| Grid::new(v, size, config).expect("a small grid");
        let (before, after) = (grid(&first[..]), grid(&second[..]));
        let now = Grid::between(&before, &after, share).expect("steps that match");
        // Steps just below and above values that occur.
        let value = |i: usize| (first[i] + (second[i] - first[i]) * share) * 3.0 + offset;
        let mut knots: Vec<f32> = [7, 500, 900].map(value).into();
        knots.push(2.0 * 3.0 + offset);
        knots.sort_by(f32::total_cmp);
        let steps = |v: f32| [(v, 0.0), (v, 1.0), (v.next_up(), 1.0), (v.next_up(), 0.0)];
        let mut knots: Vec<(f32, f32)> = knots.into_iter().flat_map(steps).collect();
        knots.sort_by(|a, b| a.0.total_cmp(&b.0));
        let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &knots);
        let volume = Volume::new(&now, function.expect("a function"));
        let macros = now.macro_cells();
        for _ in 0..300 {
            let mut at = (size - 1).as_vec3() * (rng.point(0.5) + 0.5);
            if rng.below(3) == 0 {
                at = at.round();
            }
            let cell = at.floor().as_uvec3().min(size - 2) / 8;
            let at_cell = (cell.z * macros.y + cell.y) * macros.x + cell.x;
            let majorant = volume.majorants()[at_cell as usize];
            let found = volume.transfer().at(now.value(at)).extinction;
            prop_assert!(found <= majorant, "{found} above {majorant} at {at}");
        }
    }
}
