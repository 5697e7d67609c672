use super::*;

fn make(points: usize, seed: u64) -> PointCloud {
    procedural(points, seed, &mut |_| {})
}

#[test]
fn counts_are_exact() {
    for points in [0, 1, 2, 1000, 40_001] {
        let cloud = make(points, 3);
        assert_eq!(cloud.positions.len(), points);
        assert_eq!(cloud.colors.len(), points);
    }
}

#[test]
fn the_same_for_any_number_of_threads() {
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(|| make(100_000, 5))
    };
    let one = with(1);
    assert!(one == with(3) && one == make(100_000, 5));
    assert!(one != make(100_000, 6));
}

#[test]
fn parts_have_the_points_of_the_whole() {
    let (whole, landscape) = (make(40_001, 5), Landscape::new(40_001, 5));
    for indices in [0..1, 39_000..40_001, 100..100, 17..35_000, 40_000..50_000, 60_000..70_000] {
        let part = landscape.part(indices.clone());
        let (end, start) = (indices.end.min(40_001), indices.start.min(40_001));
        assert_eq!(part.positions, whole.positions[start..end], "{indices:?}");
        assert_eq!(part.colors, whole.colors[start..end], "{indices:?}");
    }
}

#[test]
fn the_land_is_where_it_is_said_to_be() {
    let cloud = make(50_000, 1);
    for p in &cloud.positions {
        assert!(p.iter().all(|c| c.is_finite()));
        assert!(p[0].abs() < 106.0 && p[1].abs() < 106.0 && (-10.0..90.0).contains(&p[2]), "{p:?}");
    }
}

#[test]
fn progress_is_told() {
    let mut last = 0;
    procedural(1234, 1, &mut |done| last = done);
    assert_eq!(last, 1234);
}

#[test]
fn the_view_fits_and_ignores_stray_points() {
    let mut cloud = make(20_000, 1);
    let view = suggested_view(&cloud);
    cloud.positions[77] = [1e9, -1e9, 1e9];
    let stray = suggested_view(&cloud);
    for i in 0..3 {
        assert!((view.eye[i] - stray.eye[i]).abs() < 5.0, "{view:?} {stray:?}");
    }
    assert!(view.eye[0] < -100.0 && view.eye[1] < -100.0 && view.eye[2] > 60.0, "{view:?}");
}

#[test]
fn any_cloud_has_a_view() {
    for positions in [vec![], vec![[1.0, 2.0, 3.0]], vec![[f64::NAN; 3]]] {
        let colors = vec![[0; 3]; positions.len()];
        let view = suggested_view(&PointCloud { positions, colors });
        assert!(view.eye.iter().chain(&view.target).all(|c| c.is_finite()));
        assert_ne!(view.eye, view.target);
    }
}
