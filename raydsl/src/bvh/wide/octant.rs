//! Rays of some groups that go up or down along each axis together.

use core::ops::Range;

use super::rays::Rays;

/// Groups whose rays go together: with more, boxes are entered that few rays meet.
pub(super) const GROUPS: usize = 4;

/// Some rays of groups that follow each other.
#[derive(Debug, Default)]
pub(super) struct Octant {
    first: usize,
    count: usize,
    /// A bit for each ray.
    members: [u32; GROUPS],
}

impl Octant {
    /// The groups, `GROUPS` of them at a time.
    pub(super) fn ranges(groups: usize) -> impl Iterator<Item = Range<usize>> {
        (0..groups).step_by(GROUPS).map(move |first| first..(first + GROUPS).min(groups))
    }

    /// Takes the rays of one octant from those of some groups that are alive, at most `GROUPS`;
    /// returns how many.
    #[inline(always)]
    pub(super) fn take(&mut self, rays: &mut Rays, groups: Range<usize>) -> u32 {
        debug_assert!(groups.len() <= GROUPS);
        *self = Self { first: groups.start, count: groups.len(), members: [0; GROUPS] };
        let mut octant = None;
        let mut count = 0;
        for (marks, members) in rays.marks[groups].iter_mut().zip(&mut self.members) {
            let alive = marks.alive;
            if alive == 0 {
                continue;
            }
            let [x, y, z] = marks.sides;
            let first = alive.trailing_zeros();
            let whole = |side: u32| (side >> first & 1).wrapping_neg();
            let [ox, oy, oz] = *octant.get_or_insert([whole(x), whole(y), whole(z)]);
            *members = alive & !(x ^ ox) & !(y ^ oy) & !(z ^ oz);
            marks.alive &= !*members;
            count += members.count_ones();
        }
        count
    }

    /// The numbers of the groups, each with its rays.
    #[inline(always)]
    pub(super) fn groups(&self) -> impl Iterator<Item = (usize, u32)> + use<> {
        (self.first..).zip(self.members).take(self.count)
    }

    /// Goes on without some rays of each group; whether any is left.
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
