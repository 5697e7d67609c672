//! Leaves of compressed nodes: blocks, cut where a node has slots to spare. A device tests primitives
//! one after another, so it gains from small leaves, where registers of eight gain from full ones.

use super::{Below, Bounds, ChildBox, WIDTH};
use crate::geometry::Aabb;

/// The primitives of a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    ids: [u32; WIDTH],
    count: usize,
}

impl Leaf {
    pub(super) fn of(members: impl Iterator<Item = u32>) -> Self {
        let mut leaf = Self { ids: [0; WIDTH], count: 0 };
        for id in members {
            leaf.ids[leaf.count] = id;
            leaf.count += 1;
        }
        leaf
    }

    pub(super) fn ids(&self) -> &[u32] {
        &self.ids[..self.count]
    }
}

/// A leaf cut in two, and by how much that lessens the sum of area times count.
#[derive(Clone, Copy)]
struct Cut {
    halves: [ChildBox; 2],
    gain: f64,
}

/// Cuts leaves in two while there are slots, that with the greatest gain first.
pub(super) fn split(children: &mut Vec<ChildBox>, bounds: Bounds<'_>) {
    if children.len() == WIDTH {
        return;
    }
    let mut cuts = [None; WIDTH];
    for (at, child) in cuts.iter_mut().zip(children.iter()) {
        *at = cut(child, bounds);
    }
    while children.len() < WIDTH {
        let gain = |k: &usize| cuts[*k].map_or(0.0, |cut: Cut| cut.gain);
        let best = (0..children.len()).max_by(|a, b| gain(a).total_cmp(&gain(b)));
        let Some((at, Cut { halves, .. })) = best.and_then(|k| Some((k, cuts[k]?))) else { return };
        children[at] = halves[0];
        children.push(halves[1]);
        if children.len() == WIDTH {
            return;
        }
        cuts[at] = cut(&halves[0], bounds);
        cuts[children.len() - 1] = cut(&halves[1], bounds);
    }
}

/// Cuts a leaf where that gains most; none where nothing is gained.
fn cut((whole, below): &ChildBox, bounds: Bounds<'_>) -> Option<Cut> {
    let Below::Leaf(leaf) = below else { return None };
    let count = leaf.ids().len();
    let mut found = [(0, Aabb::EMPTY); WIDTH];
    for (member, &id) in found.iter_mut().zip(leaf.ids()) {
        // Spatial splits leave parts of primitives in the box.
        *member = (id, bounds(id).intersection(*whole));
    }
    let cost = |bounds: Aabb, count: usize| bounds.half_area_f64() * count as f64;
    let mut best: Option<Cut> = None;
    for axis in 0..3 {
        let members = &mut found[..count];
        let middle = |b: &Aabb| f64::from(b.min[axis]) + f64::from(b.max[axis]);
        members.sort_by(|a, b| middle(&a.1).total_cmp(&middle(&b.1)).then(a.0.cmp(&b.0)));
        // The boxes of the members from each one on.
        let mut after = [Aabb::EMPTY; WIDTH + 1];
        for k in (0..count).rev() {
            after[k] = after[k + 1].union(members[k].1);
        }
        let mut before = Aabb::EMPTY;
        for at in 1..count {
            before = before.union(members[at - 1].1);
            let gain = cost(*whole, count) - cost(before, at) - cost(after[at], count - at);
            if gain > best.map_or(0.0, |best| best.gain) {
                let half = |part: &[(u32, Aabb)]| Leaf::of(part.iter().map(|(id, _)| *id));
                let (first, second) = members.split_at(at);
                let halves =
                    [(before, Below::Leaf(half(first))), (after[at], Below::Leaf(half(second)))];
                best = Some(Cut { halves, gain });
            }
        }
    }
    best
}
