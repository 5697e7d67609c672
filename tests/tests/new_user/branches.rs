//! A path through a table of a branching process: nodes in a list, walked by a stack. (computed
//! index, enum with fields, option, bare integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// A node of a tree of half-spaces.
#[derive(Clone, Copy, Type)]
enum Node {
    Leaf(f32),
    Split { axis: u32, at: f32, below: u32, above: u32 },
}

#[kernel]
fn coordinate(p: Vec3, axis: u32) -> f32 {
    match axis {
        0 => p.x,
        1 => p.y,
        _ => p.z,
    }
}

/// The sum of the leaves that a ball around `p` reaches.
#[kernel]
fn reached(nodes: &[Node], p: Vec3, radius: f32) -> Option<f32> {
    if nodes.is_empty() {
        return None;
    }
    let mut stack = [0; 8];
    let mut top = 1;
    let mut sum = 0.0;
    while top > 0 {
        top -= 1;
        match nodes[stack[top]] {
            Node::Leaf(value) => sum += value,
            Node::Split { axis, at, below, above } => {
                let x = coordinate(p, axis);
                if x - radius < at {
                    stack[top] = below as usize;
                    top += 1;
                }
                if x + radius > at {
                    stack[top] = above as usize;
                    top += 1;
                }
            }
        }
    }
    Some(sum)
}

#[test]
fn balls_reach_leaves() {
    let nodes = vec![
        Node::Split { axis: 0, at: 0.0, below: 1, above: 2 },
        Node::Leaf(1.0),
        Node::Split { axis: 1, at: 0.5, below: 3, above: 4 },
        Node::Leaf(2.0),
        Node::Split { axis: 2, at: -0.5, below: 5, above: 6 },
        Node::Leaf(4.0),
        Node::Leaf(8.0),
    ];
    let kernel = kernel!(|p: Vec3, radius: f32| reached(&nodes, p, radius).unwrap_or(-1.0));
    let inputs: Vec<(Vec3, f32)> = (0..300)
        .map(|i| {
            (
                vec3((i % 7) as f32 - 3.1, (i % 5) as f32 * 0.31 - 0.2, (i % 3) as f32 - 1.2),
                (i % 4) as f32 * 0.3,
            )
        })
        .collect();
    assert_variants_agree!(&kernel, &inputs);
    assert_eq!(kernel.call((Vec3::ZERO, 100.0)), 15.0);
    assert_eq!(kernel.call((vec3(-1.0, 0.0, 0.0), 0.1)), 1.0);
}
