//! Depth limit of a tree.
//!
//! A node's *budget* is the number of levels that may follow below it. A root of `n` references has
//! `2 ceil(log2 n) + 8` or [`MAX_DEPTH`], whichever is less. That is well above the needs of any
//! ordinary scene (about `1.6 log2 n`). Where a level takes time proportional to its number of
//! references, as in `subtree`, the budget bounds the time for hostile inputs as well as the depth.
//!
//! Every node of `n` references has `ceil(log2 n) <= budget`:
//!
//! * the root, as `n <= 2^30` and `30 <= 62`;
//! * both children of a split whose larger side `m` has `ceil(log2 m) <= budget - 1`; splits other
//!   than in halves are only made when that holds ([`allows`]). The same goes for splits that cut
//!   primitives: `m` counts the references that the child then has, and both children together may
//!   have more than the node;
//! * otherwise the range is halved, and `ceil(log2 ceil(n / 2)) = ceil(log2 n) - 1 <= budget - 1`
//!   for every `n >= 2`.
//!
//! A node with budget 0 thus has one reference and is a leaf. Hence no leaf is deeper than the
//! root's budget, and neither is the recursion.

use super::MAX_DEPTH;

/// Returns the budget of a root of `count > 0` references.
pub(super) fn budget(count: usize) -> u32 {
    (2 * levels(count) + 8).min(MAX_DEPTH as u32)
}

/// Returns whether a node with this budget may be split into `left` and `right` references; neither
/// is 0.
pub(super) fn allows(budget: u32, left: usize, right: usize) -> bool {
    levels(left.max(right)) < budget
}

/// Returns `ceil(log2 count)`: the levels below a node of `count > 0` references that is halved
/// down to one reference per leaf.
fn levels(count: usize) -> u32 {
    count.next_power_of_two().ilog2()
}
