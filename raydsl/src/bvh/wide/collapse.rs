//! Collapses a binary tree to a wide one.
//!
//! Dynamic programming from the leaves up chooses the binary nodes that become wide nodes, by the
//! surface area heuristic: the least cost of a subtree as a forest of one to seven trees follows
//! from those of its two children. (Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal
//! on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1.)

use super::node::{Child, WIDTH, WideNode};
use crate::bvh::Node;
use crate::bvh::build::tasks;

/// Cost of testing eight primitives, relative to testing eight boxes.
const BLOCK_COST: f32 = 1.0;

/// Nodes per task.
const PIECE: usize = 1 << 12;

/// The range of the index list that becomes a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) first: u32,
    pub(super) count: u32,
}

/// The nodes of a wide tree, root first, and the ranges of its blocks.
#[derive(Debug, Default)]
pub(super) struct Collapsed {
    pub(super) nodes: Vec<WideNode>,
    pub(super) blocks: Vec<Range>,
    /// What a traversal needs at most.
    pub(super) most: Most,
}

/// Upper bounds of a traversal's stack.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Most {
    /// Children that are on the stack at once.
    pub(super) pending: usize,
    /// Nodes of one path from the root.
    pub(super) levels: usize,
}

/// The optimal forests of the subtree below a binary node.
#[derive(Clone, Copy)]
struct Plan {
    /// The least cost as a forest of at most `k + 1` trees.
    costs: [f32; WIDTH],
    /// The number of these trees in the left subtree; 0 if one tree less costs no more. For one
    /// tree: the number of the wide node's children there; 0 for a block.
    left: [u8; WIDTH],
    range: Range,
    /// The area of primitives below that rays may hit.
    solidity: f32,
}

/// What a collapse asks of primitives.
pub(super) struct Primitives<'a> {
    /// Returns the mean projected area of the primitives in a range of the index list.
    pub(super) solidity: &'a (dyn Fn(Range) -> f32 + Sync),
    /// Has the primitives in a range fetched, which are wanted soon.
    pub(super) prefetch: &'a (dyn Fn(Range) + Sync),
}

/// Nodes between one whose primitives are looked at and one whose primitives are fetched: some leaves,
/// as many lines as a core has under way.
const AHEAD: usize = 16;

/// Collapses a binary tree.
pub(super) fn collapse(nodes: &[Node], prims: &Primitives<'_>) -> Collapsed {
    let Some(root) = nodes.first() else { return Collapsed::default() };
    let range = |node: &Node| Range { first: node.first, count: node.count };
    // In parallel and ahead, since primitives may be anywhere in memory.
    let of_piece = |_, nodes: &[Node]| {
        let of_node = |(k, node): (usize, &Node)| {
            if let Some(later) = nodes.get(k + AHEAD).filter(|later| later.is_leaf()) {
                (prims.prefetch)(range(later));
            }
            if node.is_leaf() { (prims.solidity)(range(node)) } else { 0.0 }
        };
        nodes.iter().enumerate().map(of_node).collect::<Vec<f32>>()
    };
    let solidities = tasks::map_pieces(nodes, PIECE, of_piece).concat();
    let plans = plan(nodes, &solidities);
    let mut emission = Emission { nodes, plans: &plans, made: Collapsed::default() };
    if plans[0].left[0] == 0 {
        let mut node = WideNode::EMPTY;
        node.set(0, root.bounds(), emission.block(0));
        emission.made.nodes.push(node);
        emission.made.most = Most { pending: 1, levels: 1 };
    } else {
        emission.made.most = emission.node(0).1;
    }
    emission.made
}

/// Computes the plans of all nodes, whose children come after their parents. `solidities` has the
/// solidity of each leaf.
fn plan(nodes: &[Node], solidities: &[f32]) -> Vec<Plan> {
    // Relative to the surface of the root, since areas in `f32` overflow.
    let whole = nodes.first().map_or(0.0, |root| root.bounds().half_area_f64());
    let share = |node: &Node| {
        if whole > 0.0 { (node.bounds().half_area_f64() / whole) as f32 } else { 0.0 }
    };
    let range = Range { first: 0, count: 0 };
    let none = Plan { costs: [0.0; WIDTH], left: [0; WIDTH], range, solidity: 0.0 };
    let mut plans = vec![none; nodes.len()];
    for (k, node) in nodes.iter().enumerate().rev() {
        let area = share(node);
        plans[k] = if node.is_leaf() {
            let range = Range { first: node.first, count: node.count };
            Plan { costs: [BLOCK_COST * area; WIDTH], range, solidity: solidities[k], ..none }
        } else {
            let first = node.first as usize;
            inner(area, &plans[first], &plans[first + 1])
        };
    }
    plans
}

/// Computes the plan of an inner node from those of its children.
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

/// The binary nodes that become the children of a wide node, and the joints between them.
#[derive(Default)]
struct Children {
    nodes: [usize; WIDTH],
    count: usize,
    joints: [[u8; 2]; WIDTH - 1],
    joint_count: usize,
}

impl Children {
    fn add(&mut self, node: usize) -> u8 {
        self.nodes[self.count] = node;
        self.count += 1;
        self.count as u8 - 1
    }

    fn join(&mut self, members: [u8; 2]) -> u8 {
        self.joints[self.joint_count] = members;
        self.joint_count += 1;
        (WIDTH + self.joint_count - 1) as u8
    }

    /// Sorts the children by ascending `worth`.
    fn sort(&mut self, worth: impl Fn(usize) -> f32) {
        let count = self.count;
        let mut order: [u8; WIDTH] = core::array::from_fn(|k| k as u8);
        let mut worths = [0.0; WIDTH];
        for (of_child, &node) in worths.iter_mut().zip(&self.nodes[..count]) {
            *of_child = worth(node);
        }
        order[..count].sort_by(|&a, &b| worths[a as usize].total_cmp(&worths[b as usize]));
        let mut slots = [0; WIDTH];
        for (slot, &child) in order.iter().enumerate() {
            slots[child as usize] = slot as u8;
        }
        self.nodes = order.map(|child| self.nodes[child as usize]);
        for member in self.joints[..self.joint_count].as_flattened_mut() {
            if (*member as usize) < WIDTH {
                *member = slots[*member as usize];
            }
        }
    }
}

impl Emission<'_> {
    fn block(&mut self, node: usize) -> Child {
        self.made.blocks.push(self.plans[node].range);
        Child::block(self.made.blocks.len() as u32 - 1)
    }

    /// Emits a node and its subtree; returns the node and the bounds of traversals below it.
    fn node(&mut self, node: usize) -> (Child, Most) {
        let mut children = Children::default();
        self.split(node, self.plans[node].left[0], WIDTH, &mut children);
        // Subtrees that are likely and cheap to occlude a ray come last.
        children.sort(|child| self.worth(child));
        let index = self.made.nodes.len();
        self.made.nodes.push(WideNode::EMPTY);
        self.made.nodes[index].join(&children.joints[..children.joint_count]);
        let mut deepest = Most::default();
        for (slot, &child) in children.nodes[..children.count].iter().enumerate() {
            let (emitted, below) = match self.plans[child].left[0] {
                0 => (self.block(child), Most::default()),
                _ => self.node(child),
            };
            deepest.pending = deepest.pending.max(below.pending);
            deepest.levels = deepest.levels.max(below.levels);
            self.made.nodes[index].set(slot, self.nodes[child].bounds(), emitted);
        }
        let pending = children.count - 1 + deepest.pending.max(1);
        (Child::node(index as u32), Most { pending, levels: 1 + deepest.levels })
    }

    /// Adds the trees of a forest of at most `count` below a node; returns the joint of them.
    fn collect(&self, node: usize, count: usize, children: &mut Children) -> u8 {
        if count == 1 {
            return children.add(node);
        }
        match self.plans[node].left[count - 1] {
            0 => self.collect(node, count - 1, children),
            left => self.split(node, left, count, children),
        }
    }

    /// As [`Emission::collect`], with `left` of the trees from the left subtree.
    fn split(&self, node: usize, left: u8, count: usize, children: &mut Children) -> u8 {
        let (first, left) = (self.nodes[node].first as usize, left as usize);
        let members = [(first, left), (first + 1, count - left)]
            .map(|(node, count)| self.collect(node, count, children));
        children.join(members)
    }

    /// Estimates the probability that a ray through a node's box is occluded there, per unit of
    /// cost. (After Nah and Manocha, "SATO: Surface Area Traversal Order for Shadow Ray Tracing",
    /// Computer Graphics Forum 33(6), 2014.)
    fn worth(&self, node: usize) -> f32 {
        let (plan, area) = (&self.plans[node], self.nodes[node].bounds().half_area());
        // Few rays enter a box without a surface.
        let stopped = 1.0 - (-plan.solidity / area.max(f32::MIN_POSITIVE)).exp();
        stopped * area / plan.costs[0].max(f32::MIN_POSITIVE)
    }
}
