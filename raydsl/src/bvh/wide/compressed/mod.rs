//! The wide tree as devices read it: nodes of 80 bytes, with boxes of eight bits a side.
//!
//! A node has a grid of 256 cells along each axis, whose sizes are powers of two, and boxes between
//! planes of the grid, rounded outwards. The children that are nodes lie one behind the other, and so
//! do the primitives of those that are leaves. A child's slot says where it lies: the slot `i ^ o` has
//! the child that a ray whose directions are negative along the axes `o` is likely to enter as number
//! `i`. (Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs", HPG 2017, sections 3.1 and 3.2.)

mod leaf;
#[cfg(test)]
mod tests;
#[cfg(any(test, feature = "counts"))]
mod walk;

use bytemuck::Zeroable;
use glam::{DVec3, Vec3};

use super::Wide;
use super::node::{Child, WIDTH, WideNode};
use crate::bvh::build::tasks;
use crate::geometry::Aabb;
use crate::kernel;
use crate::machine::{Field, Schema, WithoutNan};
use leaf::Leaf;

/// Number of the last plane of a grid.
const LAST_PLANE: f64 = 255.0;

/// A node as devices read it.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(crate) struct CompressedNode {
    /// Lower corner of the grid.
    pub(crate) corner: [f32; 3],
    /// The exponents of the sizes of the grid's cells, as a float has them, a byte for each axis.
    pub(crate) exponents: u32,
    /// The first of the children that are nodes, in the order of their slots.
    pub(crate) first_node: u32,
    /// The first primitive of the children that are leaves, in the order of their slots.
    pub(crate) first_leaf: u32,
    /// The number of primitives in each slot, in four bits.
    pub(crate) counts: u32,
    /// The slots of nodes, a bit each, and eight bits above those of leaves.
    pub(crate) slots: u32,
    /// Along each axis, the numbers of the lower planes of eight boxes, and of the upper ones.
    pub(crate) planes: [[[u8; WIDTH]; 2]; 3],
}

const _: () = assert!(size_of::<CompressedNode>() == 80);

/// The schema of a [`CompressedNode`].
pub(crate) const COMPRESSED_SCHEMA: &Schema = &Schema::Struct {
    name: "CompressedNode",
    fields: &[
        Field { name: "corner", offset: 0, schema: &Schema::Vector(&Schema::F32, 3) },
        Field { name: "exponents", offset: 12, schema: &Schema::U32 },
        Field { name: "first_node", offset: 16, schema: &Schema::U32 },
        Field { name: "first_leaf", offset: 20, schema: &Schema::U32 },
        Field { name: "counts", offset: 24, schema: &Schema::U32 },
        Field { name: "slots", offset: 28, schema: &Schema::U32 },
        Field { name: "x", offset: 32, schema: &Schema::Vector(&Schema::U32, 4) },
        Field { name: "y", offset: 48, schema: &Schema::Vector(&Schema::U32, 4) },
        Field { name: "z", offset: 64, schema: &Schema::Vector(&Schema::U32, 4) },
    ],
    size: 80,
};

/// Returns the sizes of a grid's cells along each axis.
#[kernel(known = WithoutNan)]
pub(crate) fn cell_sizes(exponents: u32) -> Vec3 {
    let size = |exponent: u32| f32::from_bits((exponent & 255) << 23);
    Vec3::new(size(exponents), size(exponents >> 8), size(exponents >> 16))
}

/// The nodes of a wide tree as devices read them, root first, and the ids of the primitives in its
/// leaves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Compressed {
    pub(crate) nodes: Vec<CompressedNode>,
    pub(crate) ids: Vec<u32>,
}

/// Returns the bounds of a primitive.
type Bounds<'a> = &'a (dyn Fn(u32) -> Aabb + Sync);

/// A node whose place is not known yet.
struct Planned {
    node: CompressedNode,
    /// The wide nodes below, in the order of their slots.
    below: Vec<usize>,
    ids: Vec<u32>,
}

/// Nodes per task.
const PIECE: usize = 512;

impl Compressed {
    pub(super) fn of(tree: &Wide, bounds: Bounds<'_>) -> Self {
        let plan = |_, nodes: &[WideNode]| {
            nodes.iter().map(|node| Planned::of(tree, node, bounds)).collect::<Vec<_>>()
        };
        let planned: Vec<Planned> =
            tasks::map_pieces(&tree.nodes, PIECE, plan).into_iter().flatten().collect();
        let mut made = Self {
            nodes: vec![Zeroable::zeroed(); planned.len()],
            ids: Vec::with_capacity(tree.entries()),
        };
        let number = |n: usize| u32::try_from(n).expect("a tree has fewer entries than 2^32");
        let (mut next, mut pending) = (1, Vec::new());
        pending.extend((!planned.is_empty()).then_some((0, 0)));
        while let Some((from, place)) = pending.pop() {
            let Planned { node, below, ids } = &planned[from];
            let (first_node, first_leaf) = (number(next), number(made.ids.len()));
            made.nodes[place] = CompressedNode { first_node, first_leaf, ..*node };
            made.ids.extend_from_slice(ids);
            pending.extend(below.iter().zip(next..).map(|(&below, place)| (below, place)));
            next += below.len();
        }
        made
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.ids[..])
    }
}

impl Planned {
    fn of(tree: &Wide, node: &WideNode, bounds: Bounds<'_>) -> Self {
        let mut children = children_of(tree, node);
        leaf::split(&mut children, bounds);
        let slots = slots_of(children);
        let mut planned = Self { node: CompressedNode::of(&slots), below: vec![], ids: vec![] };
        let node = &mut planned.node;
        for (slot, child) in slots.iter().enumerate() {
            match child {
                None => {}
                Some((_, Below::Node(index))) => {
                    node.slots |= 1 << slot;
                    planned.below.push(*index);
                }
                Some((_, Below::Leaf(leaf))) => {
                    node.slots |= 1 << (8 + slot);
                    node.counts |= (leaf.ids().len() as u32) << (4 * slot);
                    planned.ids.extend_from_slice(leaf.ids());
                }
            }
        }
        planned
    }
}

/// What is below a box of a node.
#[derive(Clone, Copy, Debug)]
enum Below {
    /// The wide node with this index.
    Node(usize),
    Leaf(Leaf),
}

/// A child: its box, and what is below.
type ChildBox = (Aabb, Below);

/// The children of a node, each in its slot.
type Slots = [Option<ChildBox>; WIDTH];

fn children_of(tree: &Wide, node: &WideNode) -> Vec<ChildBox> {
    let child = |slot: usize| match Child(node.children[slot]) {
        Child::NONE => None,
        child if child.is_block() => {
            let leaf = Leaf::of(tree.blocks.members(child.index()).iter().copied());
            Some((node.bounds(slot), Below::Leaf(leaf)))
        }
        child => Some((node.bounds(slot), Below::Node(child.index()))),
    };
    (0..WIDTH).filter_map(child).collect()
}

impl CompressedNode {
    /// Returns a node with these boxes.
    fn of(children: &Slots) -> Self {
        let axes = [0, 1, 2].map(|axis| {
            let span = |child: ChildBox| [child.0.min[axis], child.0.max[axis]];
            let spans = children.map(|child| child.map(span));
            Grid::over(spans.iter().flatten()).planes(&spans)
        });
        let [x, y, z] = axes;
        Self {
            corner: axes.map(|axis| axis.0.corner),
            exponents: x.0.exponent | y.0.exponent << 8 | z.0.exponent << 16,
            first_node: 0,
            first_leaf: 0,
            counts: 0,
            slots: 0,
            planes: [x.1, y.1, z.1],
        }
    }
}

/// The planes of a grid along one axis.
#[derive(Clone, Copy, Debug)]
struct Grid {
    corner: f32,
    /// The exponent of the size of its cells, as a float has it.
    exponent: u32,
}

impl Grid {
    /// Returns the finest grid over these spans whose planes, up to the one behind the last span, are
    /// floats: a device computes them exactly, fused or not. There is a span.
    fn over<'s>(spans: impl Iterator<Item = &'s [f32; 2]>) -> Self {
        let union = |[low, high]: [f32; 2], span: &[f32; 2]| [low.min(span[0]), high.max(span[1])];
        let [low, high] = spans.fold([f32::INFINITY, f32::NEG_INFINITY], union);
        let largest = low.abs().max(high.abs());
        // The finest candidate is the greatest of the largest coordinate's last bit, the power of two
        // up to a 256th of the extent, and the least normal number.
        let last_bit = (largest.to_bits() >> 23).saturating_sub(23);
        let extent = (high / 256.0 - low / 256.0).abs().to_bits() >> 23;
        let finest = last_bit.max(extent).max(1);
        for exponent in finest..255 {
            let cell = f64::from(f32::from_bits(exponent << 23));
            // Multiples of the cell below the greatest float are floats.
            let corner = ((f64::from(low) / cell).floor() * cell) as f32;
            let grid = Self { corner, exponent };
            if grid.plane(LAST_PLANE) >= f64::from(high) {
                return grid;
            }
        }
        unreachable!("256 cells of the greatest power of two hold all floats")
    }

    fn plane(self, number: f64) -> f64 {
        f64::from(self.corner) + number * f64::from(f32::from_bits(self.exponent << 23))
    }

    /// Returns the planes of these spans, the lower and the upper ones, rounded outwards.
    fn planes(self, spans: &[Option<[f32; 2]>; WIDTH]) -> (Self, [[u8; WIDTH]; 2]) {
        let cell = f64::from(f32::from_bits(self.exponent << 23));
        let number = |x: f32| (f64::from(x) - f64::from(self.corner)) / cell;
        let mut planes = [[0; WIDTH]; 2];
        for (slot, [low, high]) in spans.iter().enumerate().filter_map(|(k, s)| Some((k, (*s)?))) {
            let (mut first, mut last) = (number(low).floor(), number(high).ceil());
            // The difference to the corner may be rounded.
            while first > 0.0 && self.plane(first) > f64::from(low) {
                first -= 1.0;
            }
            while last < LAST_PLANE && self.plane(last) < f64::from(high) {
                last += 1.0;
            }
            (planes[0][slot], planes[1][slot]) = (first as u8, last as u8);
        }
        (self, planes)
    }
}

/// Chooses the slot of each child: of all children and slots that are left, the pair whose direction
/// from the node's middle agrees most.
fn slots_of(mut left: Vec<ChildBox>) -> Slots {
    // In f64, where sums and differences of floats are finite.
    let middle = |b: Aabb| (b.min.as_dvec3() + b.max.as_dvec3()) * 0.5;
    let center = middle(left.iter().fold(Aabb::EMPTY, |all, child| all.union(child.0)));
    let mut offsets: Vec<DVec3> = left.iter().map(|child| middle(child.0) - center).collect();
    let mut slots = Slots::default();
    while !left.is_empty() {
        let mut best = (f64::NEG_INFINITY, 0, 0);
        for (at, offset) in offsets.iter().enumerate() {
            for (slot, _) in slots.iter().enumerate().filter(|(_, taken)| taken.is_none()) {
                let side = |axis: usize| if slot >> axis & 1 == 1 { 1.0 } else { -1.0 };
                let agrees = offset.x * side(0) + offset.y * side(1) + offset.z * side(2);
                if agrees > best.0 {
                    best = (agrees, at, slot);
                }
            }
        }
        slots[best.2] = Some(left.swap_remove(best.1));
        offsets.swap_remove(best.1);
    }
    slots
}
