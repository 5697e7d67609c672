//! Refitting to moving primitives.

use super::*;
use crate::bvh::{BuildError, RefitError, buffers};
use crate::machine::Data;
use crate::machine::Resource;

#[test]
fn refitted_trees_answer_as_brute_force() {
    for quality in BuildQuality::ALL {
        let mut numbers = Numbers::of(5);
        let mut balls = numbers.balls(500);
        let mut bvh = Bvh::build_with(&balls, &quality.into()).expect("finite bounds");
        assert_eq!(bvh.cost_growth(), 1.0);
        for _ in 0..6 {
            let tree = bvh.detach();
            for ball in &mut balls {
                ball.center = (ball.center + 0.1 * numbers.point()).clamp(-Vec3::ONE, Vec3::ONE);
            }
            bvh = tree.refit(&balls).expect("finite bounds");
            assert!(assert_as_brute_force(&bvh, &balls) > 100);
        }
        let growth = bvh.cost_growth();
        assert!(growth > 1.2, "neighbours drift apart: {growth}");
    }
}

#[test]
fn a_tree_over_primitives_that_did_not_move_is_the_same() {
    for quality in BuildQuality::ALL {
        let balls = Numbers::of(6).balls(300);
        let bvh = Bvh::build_with(&balls, &quality.into()).expect("finite bounds");
        let nodes = bvh.nodes().to_vec();
        let copy = balls.clone();
        let bvh = bvh.refit(&copy).expect("finite bounds");
        assert!(bvh.nodes() == nodes);
        assert_eq!(bvh.cost_growth(), 1.0);
        assert_eq!(bvh.primitives().as_ptr(), copy.as_ptr());
    }
}

#[test]
fn anything_may_become_anything() {
    let mut numbers = Numbers::of(7);
    let balls = numbers.balls(64);
    let collapsed = vec![Ball { center: Vec3::ONE, radius: 0.0 }; 64];
    let huge: Vec<_> = balls.iter().map(|b| Ball { center: b.center * 1e30, ..*b }).collect();
    for is_wide in [false, true] {
        let config = BuildConfig::default();
        let build = |balls| {
            if is_wide { Bvh::build_wide(balls, &[], &config) } else { Bvh::build(balls) }
        };
        let mut bvh = build(&balls[..]).expect("finite bounds");
        assert!(!bvh.is_wide() || is_wide);
        for balls in [&collapsed, &huge, &balls] {
            bvh = bvh.refit(balls).expect("finite bounds");
            crate::bvh::validate(&bvh).expect("the tree is sound");
            assert!(bvh.cost_growth() > 0.0);
        }
        assert_eq!(bvh.cost_growth(), 1.0);
        assert_as_brute_force(&bvh, &balls);
        let bvh = build(&huge[..]).expect("finite bounds");
        assert_as_brute_force(&bvh, &huge);
    }
}

#[test]
fn trees_with_leaves_move_before_their_binary_tree_is_there() {
    let mut numbers = Numbers::of(11);
    let (before, after) = (numbers.balls(500), numbers.balls(500));
    for quality in BuildQuality::ALL {
        let bvh = Bvh::build_wide(&before, &[], &quality.into()).expect("finite bounds");
        let bvh = bvh.refit(&after).expect("finite bounds");
        crate::bvh::validate(&bvh).expect("the tree is sound");
        assert_as_brute_force(&bvh, &after);
    }
}

#[test]
fn meshes_move_by_their_vertices() {
    let mut numbers = Numbers::of(8);
    let mut vertices: Vec<Vec3> = (0..200).map(|_| numbers.point()).collect();
    let mut index = || (100.0 + 100.0 * numbers.next()) as u32;
    let triangles: Vec<_> =
        (0..300).map(|_| IndexedTriangle { vertices: [index(), index(), index()] }).collect();
    let mut bvh =
        Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default()).expect("finite bounds");
    for _ in 0..3 {
        let tree = bvh.detach();
        assert_eq!((tree.len(), tree.is_empty()), (300, false));
        vertices.iter_mut().for_each(|vertex| *vertex *= Vec3::new(1.5, 0.9, -1.0));
        bvh = tree.refit_sharing(&triangles, &vertices).expect("finite bounds");
        let all: Vec<Triangle> =
            triangles.iter().map(|t| t.on(&vertices).expect("few vertices")).collect();
        assert!(assert_as_brute_force(&bvh, &all) > 100);
    }
    // A vertex no longer exists.
    let error = bvh.refit_sharing(&triangles, &vertices[..50]).expect_err("missing vertices");
    assert!(matches!(error, RefitError::Bounds(BuildError::NanBounds { .. })));
}

#[test]
fn what_cannot_be_refitted() {
    let balls = Numbers::of(9).balls(40_000);
    let error = |changes: &[(usize, f32)], count: usize| {
        let bvh = Bvh::build(&balls).expect("finite bounds");
        let mut moved = balls[..count].to_vec();
        changes.iter().for_each(|&(k, x)| moved[k].center.x = x);
        bvh.refit(&moved).expect_err("it cannot be")
    };
    assert_eq!(error(&[], 39_999), RefitError::CountChanged { before: 40_000, now: 39_999 });
    let several = [(31_000, f32::NAN), (17, f32::INFINITY), (18, f32::NAN)];
    let expected = BuildError::InfiniteBounds { index: 17 };
    assert_eq!(error(&several, 40_000), RefitError::Bounds(expected));
    let error = error(&[(3, f32::NAN)], 40_000);
    let text = error.to_string();
    assert!(text.starts_with("the bounds of primitive 3 contain NaN: repair"), "{text}");
    let bvh = Bvh::build(&balls[..0]).expect("nothing");
    let bvh = bvh.refit(&[]).expect("nothing");
    assert_eq!(bvh.cost_growth(), 1.0);
}

#[test]
fn buffers_that_change_have_another_version() {
    let balls = Numbers::of(10).balls(20);
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let keys = |bvh: &Bvh<'_, Ball>| {
        let view = bvh.view();
        assert_eq!(view.key(), view.key_of(buffers::PRIMITIVES));
        assert_eq!(view.shared().key(), view.key_of(buffers::SHARED[0]));
        [buffers::PRIMITIVES, buffers::NODES, buffers::SHARED[0], buffers::INDICES]
            .map(|part| view.key_of(part))
    };
    let before = keys(&bvh);
    let bvh = bvh.refit(&balls).expect("finite bounds").refit(&balls).expect("finite bounds");
    let after = keys(&bvh);
    for (before, after) in before.iter().zip(&after) {
        assert_eq!((before.id, before.part), (after.id, after.part));
        let is_index_list = after.part == buffers::INDICES;
        assert_eq!((before.version, after.version), (0, if is_index_list { 0 } else { 2 }));
        assert!(bvh.view().bytes(*after).is_some());
        assert_eq!(bvh.view().bytes(*before).is_some(), is_index_list, "old data are gone");
    }
}
