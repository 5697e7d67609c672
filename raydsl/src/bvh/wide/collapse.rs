//! From the binary tree to the wide one.
//!
//! Which of the binary nodes become nodes of the wide tree is decided by the surface area
//! heuristic for all of them at once, from the leaves up: the least cost of what is below a binary
//! node as a forest of one to seven trees follows from those of its two children. (Ylitie, Karras
//! and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017,
//! section 3.1.)

use super::node::{Child, WIDTH, WideNode};
use crate::bvh::Node;

/// What a test of eight primitives costs, where one of eight boxes costs 1.
const BLOCK_COST: f32 = 1.0;

/// Primitives that become a block: a range of the index list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) first: u32,
    pub(super) count: u32,
}

/// The nodes of a wide tree, the root first, and what its blocks hold.
#[derive(Debug, Default)]
pub(super) struct Collapsed {
    pub(super) nodes: Vec<WideNode>,
    pub(super) blocks: Vec<Range>,
    /// How many children may be pending at once on the way to a leaf.
    pub(super) pending: usize,
}

/// What is below a binary node, as a forest.
#[derive(Clone, Copy)]
struct Plan {
    /// The least cost as a forest of at most `k + 1` trees.
    costs: [f32; WIDTH],
    /// How many of these trees are on the left side; 0 if one tree less costs no more. Of one tree:
    /// how many of the node's eight children are; 0 for a block.
    left: [u8; WIDTH],
    range: Range,
    /// The area that rays may meet below.
    solidity: f32,
}

/// Collapses a binary tree. `solidity` says what area the primitives at some places of the index
/// list have, as rays meet it.
pub(super) fn collapse(nodes: &[Node], solidity: impl Fn(Range) -> f32) -> Collapsed {
    let Some(root) = nodes.first() else { return Collapsed::default() };
    let plans = plan(nodes, solidity);
    let mut emission = Emission { nodes, plans: &plans, made: Collapsed::default() };
    if plans[0].left[0] == 0 {
        let mut node = WideNode::EMPTY;
        node.set(0, root.bounds(), emission.block(0));
        emission.made.nodes.push(node);
        emission.made.pending = 1;
    } else {
        emission.made.pending = emission.node(0).1;
    }
    emission.made
}

/// The plans of all nodes: children come after their parents.
fn plan(nodes: &[Node], solidity: impl Fn(Range) -> f32) -> Vec<Plan> {
    let range = Range { first: 0, count: 0 };
    let none = Plan { costs: [0.0; WIDTH], left: [0; WIDTH], range, solidity: 0.0 };
    let mut plans = vec![none; nodes.len()];
    for (k, node) in nodes.iter().enumerate().rev() {
        let area = node.bounds().half_area();
        plans[k] = if node.is_leaf() {
            let range = Range { first: node.first, count: node.count };
            Plan { costs: [BLOCK_COST * area; WIDTH], range, solidity: solidity(range), ..none }
        } else {
            let first = node.first as usize;
            inner(area, &plans[first], &plans[first + 1])
        };
    }
    plans
}

/// The plan of a node from those of its children.
fn inner(area: f32, l: &Plan, r: &Plan) -> Plan {
    let (mut costs, mut left) = ([f32::INFINITY; WIDTH], [0; WIDTH]);
    for i in 0..WIDTH - 1 {
        for j in 0..WIDTH - 1 - i {
            let (k, sum) = (i + j + 1, l.costs[i] + r.costs[j]);
            if sum < costs[k] {
                (costs[k], left[k]) = (sum, i as u8 + 1);
            }
        }
    }
    (costs[0], left[0]) = (costs[WIDTH - 1] + area, left[WIDTH - 1]);
    let range = Range { first: l.range.first, count: l.range.count + r.range.count };
    if range.count as usize <= WIDTH && BLOCK_COST * area <= costs[0] {
        (costs[0], left[0]) = (BLOCK_COST * area, 0);
    }
    for k in 1..WIDTH {
        if costs[k - 1] <= costs[k] {
            (costs[k], left[k]) = (costs[k - 1], 0);
        }
    }
    Plan { costs, left, range, solidity: l.solidity + r.solidity }
}

struct Emission<'a> {
    nodes: &'a [Node],
    plans: &'a [Plan],
    made: Collapsed,
}

/// The binary nodes that become the children of a wide one.
struct Children {
    nodes: [usize; WIDTH],
    count: usize,
}

impl Emission<'_> {
    fn block(&mut self, node: usize) -> Child {
        self.made.blocks.push(self.plans[node].range);
        Child::block(self.made.blocks.len() as u32 - 1)
    }

    /// Emits a node and what is below it; also how many children may be pending there.
    fn node(&mut self, node: usize) -> (Child, usize) {
        let mut children = Children { nodes: [0; WIDTH], count: 0 };
        let (first, left) = (self.nodes[node].first as usize, self.plans[node].left[0] as usize);
        self.collect(first, left - 1, &mut children);
        self.collect(first + 1, WIDTH - 1 - left, &mut children);
        let all = &mut children.nodes[..children.count];
        // What is likely to stop a ray, and costs little to find out, comes last.
        all.sort_by(|a, b| self.worth(*a).total_cmp(&self.worth(*b)));
        let index = self.made.nodes.len();
        self.made.nodes.push(WideNode::EMPTY);
        let mut deepest = 0;
        for (slot, &child) in all.iter().enumerate() {
            let (emitted, pending) = match self.plans[child].left[0] {
                0 => (self.block(child), 0),
                _ => self.node(child),
            };
            deepest = deepest.max(pending);
            self.made.nodes[index].set(slot, self.nodes[child].bounds(), emitted);
        }
        (Child::node(index as u32), children.count - 1 + deepest.max(1))
    }

    /// Adds the trees of a forest of at most `k + 1` below a node.
    fn collect(&self, node: usize, k: usize, children: &mut Children) {
        if k == 0 {
            children.nodes[children.count] = node;
            children.count += 1;
            return;
        }
        let left = self.plans[node].left[k] as usize;
        if left == 0 {
            return self.collect(node, k - 1, children);
        }
        let first = self.nodes[node].first as usize;
        self.collect(first, left - 1, children);
        self.collect(first + 1, k - left, children);
    }

    /// The chance that a ray which enters a node's box is stopped there, for each visit. (After
    /// Nah and Manocha, "SATO: Surface Area Traversal Order for Shadow Ray Tracing", Computer
    /// Graphics Forum 33(6), 2014.)
    fn worth(&self, node: usize) -> f32 {
        let (plan, area) = (&self.plans[node], self.nodes[node].bounds().half_area());
        // A box without a surface is entered by few, and left as soon.
        let stopped = 1.0 - (-plan.solidity / area.max(f32::MIN_POSITIVE)).exp();
        stopped * area / plan.costs[0].max(f32::MIN_POSITIVE)
    }
}
