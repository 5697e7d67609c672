//! Faulty trees that `validate` must reject.

use super::*;
use crate::bvh::{MAX_DEPTH, Node, TreeFault, build::Boxes, validate::check};

/// Tree of four leaves over eight balls, to be damaged.
struct Planted {
    nodes: Vec<Node>,
    indices: Vec<u32>,
    balls: Vec<Ball>,
}

impl Planted {
    fn new() -> Self {
        let ball = |k: usize| Ball { center: Vec3::X * (k / 2 * 100 + k % 2) as f32, radius: 1.0 };
        let balls: Vec<_> = (0..8).map(ball).collect();
        let bvh = Bvh::build(&balls).expect("finite bounds");
        let (nodes, indices) = (bvh.nodes().to_vec(), bvh.indices().to_vec());
        Self { nodes, indices, balls }
    }

    fn fault(&self) -> TreeFault {
        let Self { nodes, indices, balls } = self;
        check(nodes, indices, balls.len(), &Boxes(|k: usize| balls[k].get_bounds()))
            .expect_err("a fault")
    }
}

/// Returns the fault after `change`.
fn fault(change: impl FnOnce(&mut Planted)) -> TreeFault {
    let mut planted = Planted::new();
    let Planted { nodes, indices, balls } = &planted;
    assert_eq!(check(nodes, indices, 8, &Boxes(|k: usize| balls[k].get_bounds())), Ok(()));
    // A root, its children at 1 and 2, their children at 3 and 4, 5 and 6.
    let firsts = [0, 1, 2].map(|k| nodes[k].first);
    assert_eq!((nodes.len(), firsts), (7, [1, 3, 5]));
    change(&mut planted);
    planted.fault()
}

#[test]
fn children() {
    let nodes = 7;
    for first in [6, 7, u32::MAX] {
        let expected = TreeFault::ChildOutOfRange { node: 2, first: first as usize, nodes };
        assert_eq!(fault(|p| p.nodes[2].first = first), expected);
    }
    // A node that is its own child, and one whose child is its parent.
    let cycle = TreeFault::ChildBeforeParent { node: 1, child: 1 };
    assert_eq!(fault(|p| p.nodes[1].first = 1), cycle);
    let cycle = TreeFault::ChildBeforeParent { node: 2, child: 0 };
    assert_eq!(fault(|p| p.nodes[2].first = 0), cycle);
    // The root of this one holds all.
    let shared = TreeFault::SharedChild { node: 2, child: 3 };
    let grow =
        |p: &mut Planted| p.nodes[2] = Node { first: 3, ..Node::inner(p.nodes[0].bounds(), 3) };
    assert_eq!(fault(grow), shared);
    let add = |p: &mut Planted| p.nodes.push(p.nodes[6]);
    assert_eq!(fault(add), TreeFault::Unreachable { node: 7 });
}

#[test]
fn boxes() {
    let inverted = |p: &mut Planted| p.nodes[0].min.x = 1e6;
    assert_eq!(fault(inverted), TreeFault::InvalidBox { node: 0 });
    let infinite = |p: &mut Planted| p.nodes[0].max.y = f32::INFINITY;
    assert_eq!(fault(infinite), TreeFault::InvalidBox { node: 0 });
    let nan = |p: &mut Planted| p.nodes[0].max.y = f32::NAN;
    assert_eq!(fault(nan), TreeFault::InvalidBox { node: 0 });
    let outside = |p: &mut Planted| p.nodes[4].max.y = p.nodes[4].max.y.next_up();
    assert_eq!(fault(outside), TreeFault::ChildOutside { node: 1, child: 4 });
    let small = |p: &mut Planted| p.nodes[6].min.x = p.nodes[6].min.x.next_up();
    let primitive = Planted::new().indices[Planted::new().nodes[6].first as usize] as usize;
    assert_eq!(fault(small), TreeFault::PrimitiveOutside { node: 6, primitive });
    let moved = |p: &mut Planted| p.balls[primitive].center.x = 1e6;
    assert_eq!(fault(moved), TreeFault::PrimitiveOutside { node: 6, primitive });
    let nan = |p: &mut Planted| p.balls[primitive].center.x = f32::NAN;
    assert_eq!(fault(nan), TreeFault::PrimitiveOutside { node: 6, primitive });
}

#[test]
fn leaves() {
    let first = Planted::new().nodes[5].first as usize;
    let entries = 8;
    let long = TreeFault::EntryOutOfRange { node: 5, first, count: 9, entries };
    assert_eq!(fault(|p| p.nodes[5].count = 9), long);
    let far = TreeFault::EntryOutOfRange { node: 5, first: u32::MAX as usize, count: 2, entries };
    assert_eq!(fault(|p| p.nodes[5].first = u32::MAX), far);
    let none = TreeFault::NoSuchPrimitive { node: 5, primitive: 8, primitives: 8 };
    assert_eq!(fault(|p| p.indices[first] = 8), none);
    let [lost, kept] = [first, first + 1].map(|k| Planted::new().indices[k] as usize);
    let twice = |p: &mut Planted| p.indices[first] = p.indices[first + 1];
    assert_eq!(fault(twice), TreeFault::Repeated { node: 5, primitive: kept });
    let left_out = |p: &mut Planted| (p.nodes[5].first, p.nodes[5].count) = (first as u32 + 1, 1);
    assert_eq!(fault(left_out), TreeFault::Missing { primitive: lost });
    let nothing = |p: &mut Planted| p.nodes.clear();
    assert_eq!(fault(nothing), TreeFault::Missing { primitive: 0 });
    assert_eq!(fault(nothing).to_string(), "primitive 0 is in no leaf");
}

#[test]
fn depth() {
    // A leaf beside each inner node, all over the same primitive.
    let bounds = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let chain = |depth: usize| {
        let mut nodes = vec![Node::leaf(bounds, 0, 1); 2 * depth + 1];
        let mut inner = 0;
        for first in (1..).step_by(2).take(depth) {
            nodes[inner] = Node::inner(bounds, first);
            inner = first as usize + 1;
        }
        check(&nodes, &[0], 1, &Boxes(|_| bounds))
    };
    assert_eq!(chain(MAX_DEPTH), Ok(()));
    let depth = MAX_DEPTH + 1;
    assert_eq!(chain(depth), Err(TreeFault::TooDeep { node: 2 * depth - 1, depth }));
    assert!(matches!(chain(1000), Err(TreeFault::TooDeep { .. })));
}
