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
    pub(super) fn of(members: &[u32]) -> Self {
        let mut ids = [0; WIDTH];
        ids[..members.len()].copy_from_slice(members);
        Self { ids, count: members.len() }
    }

    pub(super) fn ids(&self) -> &[u32] {
        &self.ids[..self.count]
    }
}

/// A leaf cut in two, and how many primitives fewer a ray is expected to test, relative to the area of
/// boxes.
struct Cut {
    halves: [ChildBox; 2],
    gain: f64,
}

/// Cuts leaves in two while there are slots, that with the greatest gain first.
pub(super) fn split(children: &mut Vec<ChildBox>, bounds: Bounds<'_>) {
    if children.len() == WIDTH {
        return;
    }
    let mut cuts: Vec<Option<Cut>> = children.iter().map(|child| cut(child, bounds)).collect();
    while children.len() < WIDTH {
        let gain = |k: &usize| cuts[*k].as_ref().map_or(0.0, |cut| cut.gain);
        let best = (0..children.len()).max_by(|a, b| gain(a).total_cmp(&gain(b)));
        let Some((at, cut_up)) = best.and_then(|k| Some((k, cuts[k].take()?))) else { return };
        children[at] = cut_up.halves[0];
        children.push(cut_up.halves[1]);
        cuts[at] = cut(&children[at], bounds);
        cuts.push(cut(&cut_up.halves[1], bounds));
    }
}

/// Cuts a leaf where that gains most; none where nothing is gained.
fn cut((whole, below): &ChildBox, bounds: Bounds<'_>) -> Option<Cut> {
    let Below::Leaf(leaf) = below else { return None };
    let count = leaf.ids().len();
    // Spatial splits leave parts of primitives in the box.
    let mut members: Vec<(u32, Aabb)> =
        leaf.ids().iter().map(|&id| (id, bounds(id).intersection(*whole))).collect();
    let union = |part: &[(u32, Aabb)]| part.iter().fold(Aabb::EMPTY, |all, (_, b)| all.union(*b));
    let mut best: Option<Cut> = None;
    for axis in 0..3 {
        let middle = |b: &Aabb| f64::from(b.min[axis]) + f64::from(b.max[axis]);
        members.sort_by(|a, b| middle(&a.1).total_cmp(&middle(&b.1)).then(a.0.cmp(&b.0)));
        for at in 1..count {
            let parts = [&members[..at], &members[at..]];
            let boxes = parts.map(union);
            let cost = |k: usize| boxes[k].half_area_f64() * parts[k].len() as f64;
            let gain = whole.half_area_f64() * count as f64 - cost(0) - cost(1);
            if gain > best.as_ref().map_or(0.0, |best| best.gain) {
                let half = |k: usize| {
                    let ids: Vec<u32> = parts[k].iter().map(|(id, _)| *id).collect();
                    (boxes[k], Below::Leaf(Leaf::of(&ids)))
                };
                best = Some(Cut { halves: [half(0), half(1)], gain });
            }
        }
    }
    best
}
