//! Independence of the number of threads.

use super::super::Tree;
use super::{Numbers, trees};
use crate::geometry::Aabb;

/// Builds the trees in a pool of `threads`.
fn trees_by(threads: usize, boxes: &[Aabb]) -> [Tree; 3] {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads can be started").install(|| trees(boxes))
}

#[test]
fn any_number_of_threads_builds_the_same_bits() {
    // Above the sizes at which binning and subtrees are cut into pieces.
    let smooth = Numbers::boxes(150_000, 0.01);
    // Many equal centroids, and zeros of both signs.
    let snap = |b: &Aabb| {
        let min = ((b.min - 0.5) * 8.0).round();
        Aabb::new(min, min + (b.size() * 200.0).round())
    };
    let snapped: Vec<_> = smooth.iter().map(snap).collect();
    let bits = |tree: &Tree| bytemuck::cast_slice::<_, u32>(&tree.nodes).to_vec();
    for boxes in [smooth, snapped] {
        let expected = trees_by(1, &boxes);
        for threads in [2, 7] {
            for (tree, expected) in trees_by(threads, &boxes).iter().zip(&expected) {
                assert!(tree.indices == expected.indices, "{threads} threads");
                assert!(bits(tree) == bits(expected), "{threads} threads");
            }
        }
    }
}
