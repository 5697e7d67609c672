use std::io::Write;
use std::path::PathBuf;

use super::*;

fn cloud(positions: Vec<[f64; 3]>) -> PointCloud {
    let colors = vec![[9; 3]; positions.len()];
    PointCloud { positions, colors }
}

/// A square grid in the plane.
fn grid(side: usize, step: f64) -> PointCloud {
    let at = |i: usize| [(i % side) as f64 * step, (i / side) as f64 * step, 0.0];
    cloud((0..side * side).map(at).collect())
}

fn refusal(cloud: &PointCloud, radius: Option<f64>) -> String {
    let text = scale(cloud, radius).expect_err("an error").to_string();
    assert!(!text.contains('\n') && text.contains(';'), "{text}");
    text
}

#[test]
fn a_grid_has_its_step_as_spacing() {
    for (side, step) in [(10, 1.0), (150, 0.02), (60, 1e6)] {
        let scaled = scale(&grid(side, step), None).expect("a scale");
        assert!((scaled.spacing / step - 1.0).abs() < 1e-6, "{}", scaled.spacing);
        let radius = f64::from(scaled.radius_code) / 255.0 / scaled.scale;
        assert!((0.7..0.9).contains(&(radius / step)));
    }
}

#[test]
fn duplicates_and_stray_points_do_not_count() {
    let mut twice = grid(60, 0.5);
    let copy = twice.positions.clone();
    twice.positions.extend(copy);
    twice.positions.extend(vec![[3.0, 3.0, 0.0]; 5000]);
    twice.positions.push([0.0, 0.0, 1000.0]);
    let twice = cloud(twice.positions);
    let spacing = scale(&twice, None).expect("a scale").spacing;
    assert!((spacing - 0.5).abs() < 1e-6, "{spacing}");
}

#[test]
fn few_points_have_a_spacing() {
    let spacing = |p: &[[f64; 3]]| scale(&cloud(p.to_vec()), None).expect("a scale").spacing;
    assert_eq!(spacing(&[[5.0, 6.0, 7.0]]), 1.0);
    assert_eq!(spacing(&[[5.0; 3]; 100]), 1.0);
    assert_eq!(spacing(&[[0.0; 3], [3.0, 4.0, 0.0]]), 5.0);
    let line: Vec<_> = (0..5000).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    assert_eq!(spacing(&line), 2.0);
}

#[test]
fn points_at_one_centre_are_drawn_once() {
    let distinct = |p: Vec<[f64; 3]>| scale(&cloud(p), Some(1.0)).expect("a scale").distinct();
    assert_eq!(distinct(vec![[5.0; 3]; 20_000]), [0]);
    let (a, b, c) = ([0.0, 1.0, 2.0], [-0.0, -1.0, 2.0], [9.0, 1.0, 0.0]);
    assert_eq!(distinct(vec![c, a, b, a, c, b, c, a]), [0, 1, 2]);
    // Both zeros are one place, and so is what f32 cannot tell apart.
    assert_eq!(distinct(vec![[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [1.0 - 1e-12, 0.0, -0.0]]), [0, 1]);
    assert_eq!(distinct(grid(50, 1.0).positions).len(), 2500);
}

/// A view of points that are close together is upright, and so is one of points far apart.
#[test]
fn views_of_any_size_are_upright() {
    for step in [1e-140, 1e-30, 1e-12, 1.0, 1e12, 1e140] {
        let points = [[0.0; 3], [step, 0.0, 0.0], [0.0, step, 0.0]];
        let view = suggested_view(&cloud(points.to_vec()));
        assert!(view.is_upright(), "{step:e}: {view:?}");
        let up = std::array::from_fn(|i| 1e-20 * (view.eye[i] - view.target[i]) / step);
        assert!(!View { up, ..view }.is_upright(), "{step:e}: along the view");
    }
    let view = suggested_view(&cloud(vec![[7.0; 3]; 3]));
    assert!(view.is_upright());
    for up in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
        assert!(!View { up, ..view }.is_upright(), "{up:?}");
    }
    assert!(!View { eye: view.target, ..view }.is_upright());
}

/// Half of the points in a clump that is tiny, and a stray one: the search ends.
#[test]
fn clumps_take_no_longer() {
    let start = std::time::Instant::now();
    for size in [1e-6, 1e-11, 1e-13, 1e-100] {
        let clump = (0..50_000).map(|i| {
            let i = f64::from(i);
            [i.sin() * size, (1.7 * i).cos() * size, 0.0]
        });
        let mut points: Vec<[f64; 3]> = clump.collect();
        points.push([1.0; 3]);
        let cloud = cloud(points);
        let _ = scale(&cloud, Some(0.1)).map(|scaled| scaled.distinct());
    }
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn centers_map_back() {
    // Coordinates as of a national grid, which f32 would round to half a metre.
    let far = |i: usize| [4_400_000.0 + i as f64 * 0.01, 5_300_000.0 + (i % 7) as f64, 500.0];
    let cloud = cloud((0..2000).map(far).collect());
    let scaled = scale(&cloud, Some(0.01)).expect("a scale");
    assert_eq!(scaled.radius_code, 128);
    assert!((f64::from(scaled.radius_code) / 255.0 / scaled.scale - 0.01).abs() < 1e-12);
    for (p, c) in cloud.positions.iter().zip(&scaled.centers) {
        for i in 0..3 {
            let back = f64::from(c[i]) / scaled.scale + scaled.offset[i];
            assert!((back - p[i]).abs() < 0.01 / 16.0);
        }
    }
}

#[test]
fn impossible_radii_are_refused() {
    let cloud = grid(10, 1.0);
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refusal(&cloud, Some(radius));
    }
    assert!(refusal(&cloud, Some(1e-9)).contains("at least"));
    assert!(refusal(&cloud, Some(1e9)).contains("at most"));
    refusal(&grid(1, 1.0), Some(f64::MIN_POSITIVE / 1024.0));
    scale(&cloud, Some(9.0 / f64::from(1 << 21))).expect("just large enough");
    scale(&cloud, Some(9.0 * 1024.0)).expect("just small enough");
}

#[test]
fn impossible_clouds_are_refused() {
    refusal(&cloud(vec![]), None);
    refusal(&cloud(vec![[f64::MAX; 3], [f64::MIN; 3]]), None);
    refusal(&cloud(vec![[0.0; 3], [f64::MIN_POSITIVE; 3]]), None);
    assert!(refusal(&cloud(vec![[0.0; 3], [f64::NAN; 3]]), None).contains("1 of 2"));
    let uneven = PointCloud { positions: vec![[0.0; 3]], colors: vec![] };
    refusal(&uneven, None);
}

#[test]
fn a_real_scan_has_a_spacing() {
    // Written past the test harness, which would swallow what a passing test prints.
    let skip = |why: &str| {
        let mut err = std::io::stderr();
        let _ = writeln!(err, "SKIPPED a_real_scan_has_a_spacing: {why}; no real scan is read");
    };
    let Some(folder) = std::env::var_os("RAYDSL_DATA") else {
        return skip("RAYDSL_DATA is not set");
    };
    let path = PathBuf::from(folder).join("lion_takanawa.copc.laz");
    if !path.exists() {
        return skip("RAYDSL_DATA holds no lion_takanawa.copc.laz");
    }
    let cloud = raydsl_io::cloud::load(&path, &mut |_, _| {}).expect("a cloud");
    let scaled = scale(&cloud, None).expect("a scale");
    assert!((0.005..0.05).contains(&scaled.spacing), "{}", scaled.spacing);
}
