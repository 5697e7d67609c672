//! Rays of some groups whose directions lie in one octant.

use core::ops::Range;

use super::rays::Rays;

/// Groups per ray packet: larger packets enter more boxes that few of their rays enter.
pub(super) const GROUPS: usize = 4;

/// Rays of one octant in consecutive groups.
#[derive(Debug, Default)]
pub(super) struct Octant {
    first: usize,
    count: usize,
    /// The rays, as a bit mask for each group.
    members: [u32; GROUPS],
}

impl Octant {
    /// Iterates over ranges of `GROUPS` groups.
    pub(super) fn ranges(groups: usize) -> impl Iterator<Item = Range<usize>> {
        (0..groups).step_by(GROUPS).map(move |first| first..(first + GROUPS).min(groups))
    }

    /// Takes the rays of one octant from the active rays of at most `GROUPS` groups; returns their
    /// number.
    #[inline(always)]
    pub(super) fn take(&mut self, rays: &mut Rays, groups: Range<usize>) -> u32 {
        debug_assert!(groups.len() <= GROUPS);
        *self = Self { first: groups.start, count: groups.len(), members: [0; GROUPS] };
        let mut octant = None;
        let mut count = 0;
        for (masks, members) in rays.masks[groups].iter_mut().zip(&mut self.members) {
            let active = masks.active;
            if active == 0 {
                continue;
            }
            let [x, y, z] = masks.sides;
            let first = active.trailing_zeros();
            let whole = |side: u32| (side >> first & 1).wrapping_neg();
            let [ox, oy, oz] = *octant.get_or_insert([whole(x), whole(y), whole(z)]);
            *members = active & !(x ^ ox) & !(y ^ oy) & !(z ^ oz);
            masks.active &= !*members;
            count += members.count_ones();
        }
        count
    }

    /// Iterates over the indices of the groups, each with the mask of its rays.
    #[inline(always)]
    pub(super) fn groups(&self) -> impl Iterator<Item = (usize, u32)> + use<> {
        (self.first..).zip(self.members).take(self.count)
    }

    /// Removes some rays of each group; returns whether any ray is left.
    #[inline(always)]
    pub(super) fn leave(&mut self, rays: [u32; GROUPS]) -> bool {
        let mut left = 0;
        for (members, rays) in self.members.iter_mut().zip(rays) {
            *members &= !rays;
            left |= *members;
        }
        left != 0
    }
}
