//! The number of threads changes nothing.

use super::super::Tree;
use super::{Numbers, tree};
use crate::geometry::Aabb;

/// The tree built by a pool of `threads`.
fn tree_by(threads: usize, boxes: &[Aabb]) -> Tree {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads can be started").install(|| tree(boxes))
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
    for boxes in [smooth, snapped] {
        let expected = tree_by(1, &boxes);
        for threads in [2, 7] {
            let tree = tree_by(threads, &boxes);
            assert!(tree.indices == expected.indices, "{threads} threads");
            let bits = |tree: &Tree| bytemuck::cast_slice::<_, u32>(&tree.nodes).to_vec();
            assert!(bits(&tree) == bits(&expected), "{threads} threads");
        }
    }
}
