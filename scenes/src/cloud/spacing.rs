//! How far apart the points of a cloud lie.

use rayon::prelude::*;

/// Points whose surroundings are looked at.
const QUERIES: usize = 2000;
/// The neighbour whose distance counts. On a square grid all four nearest neighbours are
/// one step away, hence the fourth still gives the step. For points strewn at random the
/// first neighbour is often a chance pair much closer than the gaps; the fourth is not.
const NEIGHBOUR: usize = 4;
/// Bits of the filter that rejects points far from all queries.
const FILTER_BITS: usize = 1 << 21;

/// Median distance to the fourth nearest distinct neighbour (to the farthest, if a cloud
/// has fewer), over a sample of the points. Duplicates count once. `None` unless two
/// points differ.
pub(super) fn spacing(positions: &[[f64; 3]]) -> Option<f64> {
    let step = positions.len().div_ceil(QUERIES).max(1);
    let queries: Vec<_> = positions.iter().step_by(step).copied().collect();
    let origin = *positions.first()?;
    let farthest = positions.iter().map(|p| distance(*p, origin)).fold(0.0, f64::max);
    if farthest == 0.0 {
        return None;
    }
    let mut size = guess(&queries, positions.len(), farthest);
    // Too large a cell makes every query look at too many points, too small a one at none.
    let mut shrink = true;
    loop {
        let grid = Neighbours::gather(positions, &queries, size);
        if shrink && grid.entries.len() > 256 * queries.len() && size > farthest * 1e-12 {
            size /= 8.0;
            continue;
        }
        shrink = false;
        let all = size > farthest;
        let mut found: Vec<f64> = queries.par_iter().filter_map(|q| grid.reach(*q, all)).collect();
        // A query without a result has its neighbour further away than all that were
        // found, so half of the results are enough to know the median.
        if found.len() * 2 > queries.len() {
            let middle = (queries.len() - 1) / 2;
            return Some(*found.select_nth_unstable_by(middle, f64::total_cmp).1);
        }
        if all {
            return found.into_iter().min_by(f64::total_cmp);
        }
        size *= 2.0;
    }
}

pub(super) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}

/// A cell somewhat smaller than needed if the bulk of the points lay on a flat surface.
fn guess(queries: &[[f64; 3]], points: usize, farthest: f64) -> f64 {
    let side = |axis: usize| {
        let mut c: Vec<f64> = queries.iter().map(|p| p[axis]).collect();
        c.sort_unstable_by(f64::total_cmp);
        let cut = c.len() / 20;
        c[c.len() - 1 - cut] - c[cut]
    };
    let bulk = side(0).hypot(side(1)).hypot(side(2));
    let bulk = if bulk > 0.0 { bulk } else { farthest };
    bulk / (points as f64).sqrt()
}

/// The points in and around the cells of some queries, by the hash of their cell. Two
/// cells with one hash only add candidates, the distance decides.
struct Neighbours {
    entries: Vec<(u64, [f64; 3])>,
    size: f64,
    origin: [f64; 3],
}

impl Neighbours {
    fn gather(positions: &[[f64; 3]], queries: &[[f64; 3]], size: f64) -> Self {
        let mut grid = Self { entries: Vec::new(), size, origin: queries[0] };
        let mut filter = vec![0u64; FILTER_BITS / 64];
        for q in queries {
            for key in grid.around(*q) {
                let bit = key as usize % FILTER_BITS;
                filter[bit / 64] |= 1 << (bit % 64);
            }
        }
        let wanted = |p: &[f64; 3]| {
            let key = hash(grid.cell(*p));
            let bit = key as usize % FILTER_BITS;
            (filter[bit / 64] >> (bit % 64) & 1 == 1).then_some((key, *p))
        };
        let mut entries: Vec<_> = positions.par_iter().filter_map(wanted).collect();
        let order = |e: &(u64, [f64; 3])| (e.0, e.1.map(f64::to_bits));
        entries.par_sort_unstable_by_key(order);
        entries.dedup_by_key(|e| order(e));
        grid.entries = entries;
        grid
    }

    fn cell(&self, p: [f64; 3]) -> [i64; 3] {
        std::array::from_fn(|i| ((p[i] - self.origin[i]) / self.size).floor() as i64)
    }

    fn around(&self, p: [f64; 3]) -> impl Iterator<Item = u64> {
        let [x, y, z] = self.cell(p);
        (0..27).map(move |i| {
            let by = |c: i64, n: i64| c.saturating_add(n % 3 - 1);
            hash([by(x, i), by(y, i / 3), by(z, i / 9)])
        })
    }

    /// Distance to the counting neighbour, if it is known to be the nearest of its rank:
    /// only within a cell's size all neighbours are seen. With `all`, every point is.
    fn reach(&self, q: [f64; 3], all: bool) -> Option<f64> {
        let mut best = [f64::INFINITY; NEIGHBOUR];
        for key in self.around(q) {
            let start = self.entries.partition_point(|e| e.0 < key);
            for (_, p) in self.entries[start..].iter().take_while(|e| e.0 == key) {
                let d = distance(*p, q);
                let rank = best.partition_point(|b| *b < d);
                if d > 0.0 && rank < NEIGHBOUR {
                    best[rank..].rotate_right(1);
                    best[rank] = d;
                }
            }
        }
        if all {
            return best.into_iter().rfind(|d| d.is_finite());
        }
        (best[NEIGHBOUR - 1] <= self.size).then_some(best[NEIGHBOUR - 1])
    }
}

fn hash([x, y, z]: [i64; 3]) -> u64 {
    let mut h = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    h = (h ^ (h >> 32) ^ y as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 29) ^ z as u64).wrapping_mul(0x94d0_49bb_1331_11eb);
    h ^ (h >> 32)
}
