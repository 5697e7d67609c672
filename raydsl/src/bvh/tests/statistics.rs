//! Tree statistics.

use super::*;

#[test]
fn nothing_and_a_single_one() {
    let balls = Numbers::of(11).balls(1);
    let bvh = Bvh::build(&balls[..0]).expect("nothing");
    let none = bvh.statistics();
    assert_eq!((none.sah_cost, none.nodes, none.leaves, none.depth), (0.0, 0, 0, 0));
    assert_eq!((none.mean_leaf_size, none.max_leaf_size, none.bytes), (0.0, 0, 0));
    assert_eq!(none.duplication, 1.0);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let one = bvh.statistics();
    assert_eq!((one.sah_cost, one.nodes, one.leaves, one.depth), (1.0, 1, 1, 0));
    assert_eq!((one.mean_leaf_size, one.max_leaf_size, one.bytes), (1.0, 1, 36));
}

#[test]
fn costs_by_hand() {
    // Unit cubes around 0 and 9 on the axis x: the root has half an area of 1 + 10 + 10.
    let balls = [0.0, 9.0].map(|x| Ball { center: Vec3::X * x, radius: 0.5 });
    let config =
        BuildConfig { traversal_cost: 2.0, intersection_cost: 7.0, ..BuildConfig::default() };
    let bvh = Bvh::build_with(&balls, &config).expect("finite bounds");
    let expected = 2.0 + 2.0 * 7.0 * 3.0 / 21.0;
    assert!((bvh.statistics().sah_cost - expected).abs() < 1e-5);
}

#[test]
fn trees_without_an_area() {
    let point = |x: f32| Triangle { v0: Vec3::X * x, v1: Vec3::X * x, v2: Vec3::X * x };
    for (triangles, cost) in [
        // On a line: half of the rays through it pass each group of four, in a leaf.
        ((0..8).map(|k| point((k % 2) as f32)).collect::<Vec<_>>(), 1.0),
        (vec![point(3.0); 4], 4.0),
    ] {
        for quality in BuildQuality::ALL {
            let bvh = Bvh::build_with(&triangles, &quality.into()).expect("finite bounds");
            assert_eq!(bvh.statistics().sah_cost, cost);
        }
    }
}

#[test]
fn fast_trees_are_not_much_dearer() {
    let balls = Numbers::of(12).balls(5000);
    let [fast, balanced] = [BuildQuality::Fast, BuildQuality::Balanced].map(|quality| {
        let bvh = Bvh::build_with(&balls, &quality.into()).expect("finite bounds");
        let statistics = bvh.statistics();
        assert_eq!(statistics.nodes, 2 * statistics.leaves - 1);
        assert_eq!(statistics.bytes, bvh.bytes());
        assert_eq!(statistics.duplication, 1.0);
        assert!(statistics.depth >= 11 && statistics.depth <= 34);
        assert!(statistics.max_leaf_size <= 4 && statistics.mean_leaf_size >= 1.0);
        statistics.sah_cost
    });
    assert!(fast < 1.3 * balanced, "{fast} against {balanced}");
}
