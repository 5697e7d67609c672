//! Partition of a grid into dispatches that fit the device and stay short.

/// Samples of the very first dispatch of a kernel: one per invocation, unless it takes more.
pub(super) const FIRST_GOAL: u64 = 1 << 16;
/// The minimum goal: no dispatch is made smaller because of its time.
const LEAST_GOAL: u64 = 256;
/// The maximum goal: no dispatch is made larger, however fast.
const LARGEST_GOAL: u64 = 1 << 28;
/// The maximum time of a dispatch: far below the 2 s at which watchdogs fire.
const TARGET_MS: f64 = 50.0;

/// A rectangle of pixels, one dispatch.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Tile {
    pub(super) first: [u32; 2],
    pub(super) count: [u32; 2],
}

impl Tile {
    /// Returns the number of pixels.
    pub(super) fn invocations(self) -> u64 {
        u64::from(self.count[0]) * u64::from(self.count[1])
    }

    /// Returns the number of elements from its first pixel to its last in a grid of this width.
    pub(super) fn span(self, width: u32) -> u64 {
        u64::from(self.count[1] - 1) * u64::from(width) + u64::from(self.count[0])
    }

    /// Returns the runs of consecutive elements: (first in the grid, length), all of the same
    /// length.
    ///
    /// A tile of whole rows is one run.
    pub(super) fn runs(self, width: u32) -> impl Iterator<Item = (u64, u64)> {
        let first = u64::from(self.first[1]) * u64::from(width) + u64::from(self.first[0]);
        let whole = self.count[0] == width;
        let runs = if whole { 1 } else { self.count[1] };
        let length = self.invocations() / u64::from(runs);
        (0..u64::from(runs)).map(move |row| (first + row * u64::from(width), length))
    }
}

/// Iterates over a grid in bands of rows, and if a band is still too large, in parts of a band.
pub(super) struct Tiler {
    size: [u32; 2],
    workgroup: [u32; 2],
    /// Elements that fit in the input and output bindings.
    max_elements: u64,
    /// Pixels that the limit on workgroups allows in x and y.
    max_extent: [u64; 2],
    at: [u32; 2],
    /// Rows of the current band.
    band: u32,
}

impl Tiler {
    /// Starts at a grid's first pixel. `workgroup`, `max_elements` and `max_groups` are not 0.
    pub(super) fn new(
        size: [u32; 2],
        workgroup: [u32; 2],
        max_elements: u64,
        max_groups: u32,
    ) -> Self {
        Self {
            size,
            workgroup,
            max_elements,
            max_extent: workgroup.map(|threads| u64::from(threads) * u64::from(max_groups)),
            at: [0, 0],
            band: 0,
        }
    }

    /// Returns the next tile, of about `goal` invocations.
    pub(super) fn next(&mut self, goal: u64) -> Option<Tile> {
        if self.at[1] >= self.size[1] || self.size[0] == 0 {
            return None;
        }
        if self.at[0] == 0 {
            self.band = self.rows(goal);
        }
        let tile = Tile { first: self.at, count: [self.columns(goal), self.band] };
        self.at[0] += tile.count[0];
        if self.at[0] == self.size[0] {
            self.at = [0, self.at[1] + self.band];
        }
        Some(tile)
    }

    /// Returns the rows of the next band.
    ///
    /// It is at least a row of workgroups, since fewer rows leave threads idle and save no time,
    /// unless the bindings hold less.
    fn rows(&self, goal: u64) -> u32 {
        let width = u64::from(self.size[0]);
        let group = u64::from(self.workgroup[1]);
        let left = u64::from(self.size[1] - self.at[1]);
        let fitting = (self.max_elements / width).min(self.max_extent[1]);
        let wanted = (goal / width).max(group).min(fitting);
        // At most `left`, so it fits a u32.
        whole_groups(wanted, group).min(left) as u32
    }

    /// Returns the columns of the next tile of the band.
    fn columns(&self, goal: u64) -> u32 {
        let left = u64::from(self.size[0] - self.at[0]);
        let group = u64::from(self.workgroup[0]);
        // A band has several rows only if whole rows fit in the bindings.
        let fitting = if self.band == 1 { self.max_elements } else { left };
        let wanted = (goal / u64::from(self.band)).max(group);
        let most = wanted.min(fitting).min(self.max_extent[0]);
        if most >= left {
            return left as u32;
        }
        whole_groups(most, group) as u32
    }
}

/// Returns `count` rounded down to whole workgroups if there is at least one; never 0.
fn whole_groups(count: u64, group: u64) -> u64 {
    if count < group {
        return count.max(1);
    }
    count - count % group
}

/// Returns the next goal after a dispatch of `samples` took `ms`.
///
/// Both branches use the measured dispatch and not the current goal, whose effect the dispatches in
/// flight have not shown yet: learning twice from old tiles changes nothing.
pub(super) fn next_goal(goal: u64, samples: u64, ms: f64) -> u64 {
    let next = if ms > TARGET_MS {
        goal.min((samples as f64 * TARGET_MS / ms) as u64)
    } else if ms < TARGET_MS / 2.0 {
        goal.max(samples * 2)
    } else {
        goal
    };
    next.clamp(LEAST_GOAL, LARGEST_GOAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tiles the grid and checks that every pixel is in one tile and all limits hold.
    fn walk(size: [u32; 2], group: [u32; 2], max_elements: u64, groups: u32, goal: u64) -> usize {
        let mut tiler = Tiler::new(size, group, max_elements, groups);
        let mut seen = vec![0u8; (size[0] * size[1]) as usize];
        let mut tiles = 0;
        while let Some(tile) = tiler.next(goal) {
            tiles += 1;
            assert!(tile.span(size[0]) <= max_elements, "{tile:?}");
            for (count, threads) in tile.count.into_iter().zip(group) {
                assert!(count > 0 && count.div_ceil(threads) <= groups, "{tile:?}");
            }
            for (first, length) in tile.runs(size[0]) {
                for pixel in &mut seen[first as usize..(first + length) as usize] {
                    *pixel += 1;
                }
            }
        }
        assert!(seen.iter().all(|&times| times == 1));
        tiles
    }

    #[test]
    fn tiles_cover_the_grid_once() {
        for size in [[1, 1], [64, 48], [1000, 7], [5000, 1], [3, 700], [257, 129]] {
            for group in [[8, 8], [64, 1], [1, 1]] {
                for max_elements in [1, 100, 4096, 1 << 20] {
                    for goal in [1, 256, 5000, 1 << 20] {
                        walk(size, group, max_elements, 65535, goal);
                        walk(size, group, max_elements, 3, goal);
                    }
                }
            }
        }
    }

    #[test]
    fn a_grid_that_fits_is_one_dispatch() {
        assert_eq!(walk([640, 480], [8, 8], 1 << 20, 65535, 640 * 480 * 8 / 8), 1);
        assert_eq!(walk([100_000, 1], [64, 1], 1 << 20, 65535, 1 << 20), 1);
    }

    #[test]
    fn bands_are_whole_workgroups() {
        let mut tiler = Tiler::new([1000, 1000], [8, 8], 1 << 30, 65535);
        let tile = tiler.next(30_000);
        assert_eq!(tile.map(|tile| tile.count), Some([1000, 24]));
    }

    #[test]
    fn the_goal_follows_the_time() {
        assert_eq!(next_goal(1 << 16, 1 << 16, 1.0), 1 << 17);
        assert_eq!(next_goal(1 << 17, 1 << 16, 1.0), 1 << 17, "learnt only once");
        assert_eq!(next_goal(1 << 16, 1 << 16, 100.0), 1 << 15);
        assert_eq!(next_goal(1 << 16, 1 << 16, 40.0), 1 << 16);
        assert_eq!(next_goal(1 << 16, 1 << 16, 1e9), LEAST_GOAL);
    }
}
