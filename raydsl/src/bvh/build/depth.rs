//! How deep a tree may be.
//!
//! A node's *budget* is the number of levels that may follow below it. The root of `n` references
//! has `2 ceil(log2 n) + 8` or [`MAX_DEPTH`], whichever is less. That is well above what any
//! ordinary scene needs (about `1.6 log2 n`). Where a level takes time proportional to the number
//! of references in it, as in `subtree`, it bounds the time for hostile inputs as well as the
//! depth.
//!
//! Every node of `n` references has `ceil(log2 n) <= budget`:
//!
//! * the root, as `n <= 2^30` and `30 <= 62`;
//! * both children of a split of which the larger half `m` has `ceil(log2 m) <= budget - 1`; any
//!   other split than in halves is only made when that holds ([`allows`]). That is true of a split
//!   that cuts primitives, too: `m` counts the references that the child then has, of which both
//!   children together may have more than the node;
//! * otherwise the range is halved, and `ceil(log2 ceil(n / 2)) = ceil(log2 n) - 1 <= budget - 1`
//!   for every `n >= 2`.
//!
//! A node with budget 0 thus has one reference and is a leaf. Hence no leaf is deeper than the
//! root's budget, and neither is the recursion.

use super::MAX_DEPTH;

/// The budget of a root of `count > 0` references.
pub(super) fn budget(count: usize) -> u32 {
    (2 * levels(count) + 8).min(MAX_DEPTH as u32)
}

/// Whether a node with this budget may be split so that `left` references go to one side and
/// `right` to the other; neither is 0.
pub(super) fn allows(budget: u32, left: usize, right: usize) -> bool {
    levels(left.max(right)) < budget
}

/// `ceil(log2 count)`: the levels below a node of `count > 0` references that is halved until
/// there is one in each leaf.
fn levels(count: usize) -> u32 {
    count.next_power_of_two().ilog2()
}
